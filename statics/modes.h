#pragma once
// Vibrations of a machine about its pose: natural frequencies, damping, shapes, state space.
//
//   auto rest = sheave::find_equilibrium(*simulation);
//   auto modes = sheave::find_modes(*simulation);
//   double first = modes.modes[0].frequency;  // [Hz]
//
// Equations and their limits: docs/how-to/modes.md.

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cable/simulation.h"

namespace sheave {

/// A vector and a matrix of any size. Their memory comes from std::malloc, whatever a program's
/// settings of Eigen are, so a program can free memory of the library, and the library memory of the
/// program.
using ModalVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor | Eigen::DontAlign>;
using ModalMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor | Eigen::DontAlign>;

/// A motion of all bodies with one frequency, of the machine without damping.
struct Mode {
  double eigenvalue = 0.0;  ///< square of the angular frequency [1/s2]; negative: unstable
  /// [Hz]; 0 for a motion without stiffness, and for an unstable one
  double frequency = 0.0;
  /// Fraction of critical damping at the mode's frequency, neglecting the coupling of modes by
  /// damping; 0 if the frequency is 0.
  double damping_ratio = 0.0;
  /// Displacements along the bodies' degrees of freedom [sqrt(kg) m per m, per rad], with modal
  /// mass 1.
  ModalVector shape;
  int body = -1;            ///< the body with the largest part of the kinetic energy
  double body_share = 0.0;  ///< that body's part of the kinetic energy, 0 ... 1
};

/// An input: a force along a world axis through a body's centre of mass, a torque about a world
/// axis, or the command of a drive. For a rotor driven to a speed or an angle, and for a joint's
/// drive to a speed or a position, the command is the speed [rad/s or m/s] (the driven coordinate
/// is a state). For a joint's drive to a force or torque it is that force or torque [N or N m].
struct ModeInput {
  enum class Kind { force, torque, drive, joint_drive };
  Kind kind = Kind::force;
  int body = 0;                     ///< not of a joint's drive
  Vector3 axis = Vector3::UnitX();  ///< unit vector; not of drives
  int joint = 0;                    ///< index in Model::joints; of a joint's drive
  int coordinate = 0;               ///< of that joint, which has a drive
};

/// Whether a drive acts along this coordinate of a joint; indices in Model::joints and
/// JointDef::coordinates().
[[nodiscard]] bool has_joint_drive(const World& world, int joint, int coordinate);

struct Modes {
  std::vector<Mode> modes;  ///< by eigenvalue, ascending
  /// Poles p of the damped machine, with motions exp(p t) [1/s], by magnitude; conjugate pairs are
  /// adjacent. Damped spans that share a tension add real poles.
  std::vector<std::complex<double>> poles;
  ModalMatrix motions;    ///< Z, degrees of freedom x k: displacements q = Z z
  ModalMatrix mass;       ///< Z^T M Z = 1
  ModalMatrix damping;    ///< Z^T D Z of slow motions [1/s]
  ModalMatrix stiffness;  ///< Z^T K Z [1/s2]
  /// x' = A x + B u with x = (z, z', d, e), where d are the coordinates of drives to speeds and
  /// positions. Where damped spans of unequal relaxation times share a tension, as on both sides of a
  /// pinhole, e are stretches of all of them but one [m] (statics/relaxation.h).
  ModalMatrix state_matrix;
  ModalMatrix input_matrix;
  /// Y, degrees of freedom x d: with drives, displacements are q = Z z + Y d.
  ModalMatrix driven_motions;
  /// Change of each row's value C per unit of d [m or rad], in the rows' own order.
  ModalMatrix driven_rows;
  /// Deviation of the pose from equilibrium: unbalanced force along the motions / largest load.
  /// Modes are meaningful only if this is small.
  double imbalance = 0.0;
  double error = 0.0;  ///< error of the stiffness by finite differences / its largest entry
  int redundant = 0;   ///< number of redundant rigid rows
  /// a cable or contact slides with friction; the analysis holds it in place
  bool friction_slides = false;
  /// Forces of the rows at this pose, per feature [N or N m].
  std::vector<std::vector<double>> forces;
};

/// Modes about the pose of the simulation, as if it were at rest. Its state is unchanged.
[[nodiscard]] Modes find_modes(Simulation& simulation, const std::vector<ModeInput>& inputs = {});

/// Names of the degrees of freedom of shapes: "<body>.x", "<body>.turn_z", ...
[[nodiscard]] std::vector<std::string> freedom_names(const Simulation& simulation);

/// Main motion of the body with most of a mode's energy: "x", "y" or "z", the world axis along
/// which its centre of mass moves most. If its centre stays in place (metres and radians are not
/// comparable), it is "turn", for a body in space "turn_x", "turn_y" or "turn_z". Empty without a
/// body.
[[nodiscard]] std::string largest_motion(const Simulation& simulation, const Mode& mode);

/// The state displaced by `amplitude` times a shape and then moved back until its rigid rows are
/// met.
[[nodiscard]] State displaced_state(Simulation& simulation, const Modes& modes,
                                    const ModalVector& shape, double amplitude);

/// The state for linear outputs at x = (z, z', d, e): displacements q = Z z + Y d, velocities Z z',
/// and forces without inputs. Rotors that a drive turns stay in place.
[[nodiscard]] State perturbed_state(Simulation& simulation, const Modes& modes,
                                    const ModalVector& x);

}  // namespace sheave
