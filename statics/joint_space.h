#pragma once
// A machine in the coordinates of its joints: the questions of robotics.
//
//   auto space = sheave::JointSpace::create(*simulation);
//   if (!space) report(space.errors());
//   const auto mass = space->mass_matrix();                       // M u' + h = torques
//   const auto torques = space->inverse_dynamics(accelerations);
//
// The n coordinates q are those of joints, in the order of the model, as far as they are independent.
// In a closed loop only the first joints have coordinates; distance joints, gears, racks and
// couplings have none. Bodies that joints leave free to move in other ways have coordinates of their
// own, in the order of the bodies: a floating base, wheels on
// axles, weights on rails, and the rotations of a body on a ball joint.
//
// The rates u are q' but for one exception: of a body that turns about all axes, u has the components
// of the angular velocity in the world frame, and q those of the rotation vector since time 0.
//
// With the velocities v of all bodies along their degrees of freedom, rigid joints leave
// v = Z u + v0, where v0 is the part that prescribed bodies cause (kinematic ones and driven rotors).
// The power of all forces gives
//
//   Z^T M Z u' + Z^T (M (Z' u + v0') + gyroscopic torques - loads) = forces along the coordinates
//
// Z' u + v0' is a difference along the motion, in which prescribed bodies keep their velocities.
// Cables, contacts, stops, dry friction and drives of joints are no part of these matrices. A cable
// with the tensions T adds -R^T T to the forces, where R are the moment arms.

#include <memory>
#include <string>
#include <vector>

#include "cable/simulation.h"
#include "statics/modes.h"

namespace sheave {

/// One coordinate: that of a joint, or of a body.
struct MachineCoordinate {
  std::string name;     ///< "elbow.angle", "base.x", "wheel.turn"
  int joint = -1;       ///< index in Model::joints; -1: a body's coordinate
  int coordinate = -1;  ///< index in JointDef::coordinates()
  int body = -1;        ///< index in Model::bodies; -1: a joint's coordinate
  int part = -1;        ///< number of the degree of freedom of the body
  bool angle = false;   ///< the units have rad in place of m
  /// Whether the rate is a component of an angular velocity, and the value of a rotation vector.
  bool turns_freely = false;
};

/// How each coordinate moves a point.
struct PointJacobian {
  ModalMatrix linear;   ///< 3 x n: velocity of the point per rate, world frame [m/s per unit of u]
  ModalMatrix angular;  ///< 3 x n: angular velocity of the body per rate [rad/s per unit of u]
};

/// Lengths of cables and how the coordinates change them.
struct CableArms {
  /// Per cable: unstretched length plus (length - rest length) of all spans [m]. A rigid cable that
  /// is taut has its own length, a slack one is shorter.
  ModalVector lengths;
  ModalVector rates;  ///< per cable: rate of the length [m/s]
  ModalMatrix arms;   ///< cables x n: d length / d coordinate [m/m or m/rad]
  /// Spans x n: d (length - rest length) of each span / d coordinate, in the order of
  /// CableReport::spans and then of the places for wraps, cable by cable. 0 without a span.
  ModalMatrix span_arms;
};

/// u' linearised about a pose at rest: x' = A x + B f with x = (q - q0, u) and forces f along the
/// coordinates.
struct LinearMotion {
  ModalMatrix state_matrix;  ///< A, 2n x 2n
  ModalMatrix input_matrix;  ///< B, 2n x n
};

/// The answers for one state of a simulation: that of the time of create(). The simulation must
/// outlive this object, and its features are used as scratch; its state is unchanged.
class JointSpace {
 public:
  /// Largest number of degrees of freedom of all bodies; the cost of a question grows with its cube.
  static constexpr int most_freedoms = 1200;

  /// An error if the machine has more than `most_freedoms` degrees of freedom, a rope with
  /// `axial_inertia`, or a knot without mass.
  static Result<JointSpace> create(Simulation& simulation);
  ~JointSpace();
  JointSpace(JointSpace&&) noexcept;
  JointSpace& operator=(JointSpace&&) noexcept;

  [[nodiscard]] const std::vector<MachineCoordinate>& coordinates() const;
  [[nodiscard]] ModalVector positions() const;  ///< q [m or rad], n
  [[nodiscard]] ModalVector rates() const;      ///< u [m/s or rad/s], n

  /// Z^T M Z, n x n [kg, kg m or kg m2].
  [[nodiscard]] ModalMatrix mass_matrix() const;
  /// Forces along the coordinates that gravity and the velocities demand, n [N or N m]: the forces
  /// for u' = 0 in a machine without springs and dampers. Weights count as positive where they have
  /// to be held.
  [[nodiscard]] ModalVector bias_forces();
  /// Forces of springs, dampers and elastic stops of joints, of drag, and of forces set on bodies,
  /// n [N or N m].
  [[nodiscard]] ModalVector passive_forces();
  /// The forces along the coordinates that cause these accelerations u', n [N or N m]:
  /// mass_matrix() u' + bias_forces() - passive_forces(). An error if there are not n accelerations
  /// or if one is not finite.
  [[nodiscard]] Result<ModalVector> inverse_dynamics(const ModalVector& accelerations);
  /// u' under forces along the coordinates: the inverse of inverse_dynamics(), with the same errors,
  /// and one if a coordinate has no inertia.
  [[nodiscard]] Result<ModalVector> forward_dynamics(const ModalVector& forces);
  /// The Jacobian of the body-frame point `local` [m]; of the world it is 0. `body` must exist.
  [[nodiscard]] PointJacobian jacobian(BodyId body, const Vector3& local) const;
  /// The changes of the coordinates, n x k, by displacements along the degrees of freedom of the
  /// bodies, as find_modes() has them: one per column, freedom_names() per row.
  [[nodiscard]] ModalMatrix along_coordinates(const ModalMatrix& displacements) const;
  /// The cables at the present pose, at most as precise as the tangent points.
  [[nodiscard]] CableArms cable_arms();
  /// The motion near this pose, by the tangent of find_modes() (statics/modes.h): with elastic cables
  /// and springs, as if the machine were at rest. An error if a force is not balanced here, or if a
  /// rigid cable, a contact or a drive to a speed or position takes away a coordinate.
  [[nodiscard]] Result<LinearMotion> linearise();

 private:
  struct Content;
  explicit JointSpace(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace sheave
