#pragma once
// How a machine vibrates about where it is: natural frequencies, damping, shapes, state space.
//
//   auto rest = sheave::find_equilibrium(*simulation);
//   auto modes = sheave::find_modes(*simulation);
//   double first = modes.modes[0].frequency;  // [Hz]
//
// The equations and their limits: docs/modes.md.

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cable/simulation.h"

namespace sheave {

/// A motion in which all moves with one frequency, of the machine without damping.
struct Mode {
  double eigenvalue = 0.0;  ///< square of the angular frequency [1/s2]; negative: it runs away
  /// [Hz]; 0 of a motion without stiffness, and of one that runs away
  double frequency = 0.0;
  /// Of critical damping, as far as damping does not couple modes; 0 where frequency is.
  double damping_ratio = 0.0;
  /// Displacements along the bodies' degrees of freedom [sqrt(kg) m per m, per rad]: of unit
  /// modal mass.
  Eigen::VectorXd shape;
  int body = -1;            ///< that has the largest part of its kinetic energy
  double body_share = 0.0;  ///< that part, 0 ... 1
};

/// A force along a world axis through a body's centre of mass, a torque about one, or what a drive
/// is told: of a rotor driven to a speed or an angle, and of a joint's drive to a speed or a
/// position, the speed [rad/s or m/s] (what has been driven is a state); of a joint's drive to a
/// force or torque that force or torque [N or N m].
struct ModeInput {
  enum class Kind { force, torque, drive, joint_drive };
  Kind kind = Kind::force;
  int body = 0;                     ///< not of a joint's drive
  Vector3 axis = Vector3::UnitX();  ///< unit vector; not of drives
  int joint = 0;                    ///< index in Model::joints; of a joint's drive
  int coordinate = 0;               ///< of that joint, which has a drive
};

/// Whether a drive acts along this coordinate of a joint, by their indices in Model::joints and
/// JointDef::coordinates().
[[nodiscard]] bool has_joint_drive(const World& world, int joint, int coordinate);

struct Modes {
  std::vector<Mode> modes;  ///< by eigenvalue, ascending
  /// Of the damped machine: p of motions exp(p t) [1/s], by magnitude, those of a pair after each
  /// other.
  std::vector<std::complex<double>> poles;
  Eigen::MatrixXd motions;    ///< Z, degrees of freedom x k: displacements q = Z z
  Eigen::MatrixXd mass;       ///< Z^T M Z = 1
  Eigen::MatrixXd damping;    ///< Z^T D Z [1/s]
  Eigen::MatrixXd stiffness;  ///< Z^T K Z [1/s2]
  /// x' = A x + B u with x = (z, z', d): d is what drives to speeds and places have driven.
  Eigen::MatrixXd state_matrix;
  Eigen::MatrixXd input_matrix;
  /// Y, degrees of freedom x d: with drives, displacements are q = Z z + Y d.
  Eigen::MatrixXd driven_motions;
  /// Change of what each row asks for per unit of d [m or rad], in the rows' own order.
  Eigen::MatrixXd driven_rows;
  /// By how much the poses are off a rest: forces without balance along the motions, as a share of
  /// the largest load. Modes mean what they say only where this is small.
  double imbalance = 0.0;
  double error = 0.0;  ///< of the stiffness, from differences, as a share of its largest part
  int redundant = 0;   ///< rigid rows more than needed
  bool friction_slides = false;  ///< some cable or contact slides with friction: it is held there
  /// Forces of the rows at this pose, per feature [N or N m].
  std::vector<std::vector<double>> forces;
};

/// Of the pose that the simulation has, as if it were at rest; its state stays as it is.
[[nodiscard]] Modes find_modes(Simulation& simulation, const std::vector<ModeInput>& inputs = {});

/// Names of the degrees of freedom that shapes are along: "<body>.x", "<body>.turn_z", ...
[[nodiscard]] std::vector<std::string> freedom_names(const Simulation& simulation);

/// What the body with most of a mode's energy does: "x", "y" or "z", the world axis along which its
/// centre of mass moves most. Where that stays in place, for metres and radians do not compare, it
/// is "turn", of a body in space "turn_x", "turn_y" or "turn_z"; of no body "".
[[nodiscard]] std::string largest_motion(const Simulation& simulation, const Mode& mode);

/// The state in which the machine is displaced by `amplitude` times a shape, moved back to where
/// its rigid rows are met.
[[nodiscard]] State displaced_state(Simulation& simulation, const Modes& modes,
                                    const Eigen::VectorXd& shape, double amplitude);

/// What linear outputs are made of: the state with x = (z, z', d): displacements q = Z z + Y d,
/// velocities Z z', and forces as they are then without inputs. Rotors that a drive turns stay
/// where they are.
[[nodiscard]] State perturbed_state(Simulation& simulation, const Modes& modes,
                                    const Eigen::VectorXd& x);

}  // namespace sheave
