#pragma once
// The bodies of a machine near the pose of a state, with the rows of its joints only; internal to
// statics.
//
// Displacements q and velocities v are along the degrees of freedom of the bodies
// (engine/dynamics/coordinates.h). Rigid joints demand
//
//   C = 0        and        J v + c = 0
//
// where c is the rate of C by the motion of prescribed bodies: kinematic bodies and driven rotors on
// fixed axles. Drives of joints, springs, stops and friction are no part of C.

#include <string>
#include <vector>

#include "engine/control_check.h"
#include "engine/row_list.h"
#include "statics/configuration.h"

namespace sheave {

/// A quantity that depends on the pose, in one pose.
struct PoseMeasure {
  double value = 0.0;  ///< [m or rad]
  VectorX gradient;    ///< by the degrees of freedom
  double drift = 0.0;  ///< rate by the motion of prescribed bodies [m/s or rad/s]
};

/// The rigid rows of all joints in one pose.
struct JointLocks {
  VectorX values;     ///< C [m or rad]
  MatrixX gradients;  ///< J, rows x degrees of freedom
  VectorX drift;      ///< c [m/s or rad/s]
};

/// Uses the joints of `simulation` as scratch; simulation and state must outlive this object.
class MachinePose {
 public:
  MachinePose(Simulation& simulation, const State& state);

  [[nodiscard]] int freedoms() const { return freedoms_; }
  [[nodiscard]] const Substep& substep() const { return substep_; }
  /// Displaces the bodies from the pose of the state. Prescribed bodies move with their velocities of
  /// the state during `seconds`.
  void place(const VectorX& displacement, double seconds);
  /// The rigid rows of joints in the present pose.
  [[nodiscard]] JointLocks locks();
  /// A coordinate of a joint: indices in Model::joints and JointDef::coordinates().
  [[nodiscard]] PoseMeasure joint_coordinate(int joint, int coordinate) const;
  /// Number `part` of the degrees of freedom of a body that has any. Values: of a translation the
  /// position of the centre of mass along it [m], of a rotation about one axis the angle since time 0
  /// (of a mounted rotor relative to its carrier), of rotations about all axes the components of the
  /// rotation vector since time 0 [rad].
  [[nodiscard]] PoseMeasure body_coordinate(int body, int part) const;
  /// Rotation vector from the present orientation of a body to another one [rad], world frame.
  [[nodiscard]] Vector3 turn_to(int body, const Quaternion& orientation) const;
  [[nodiscard]] bool is_broken(int joint) const;
  /// Whether a multiplier of a feature is the force of a joint's drive.
  [[nodiscard]] bool is_drive(std::size_t feature, int multiplier) const {
    const std::vector<char>& drives = drives_[feature];
    return static_cast<std::size_t>(multiplier) < drives.size() &&
           drives[static_cast<std::size_t>(multiplier)] != 0;
  }
  /// The velocities of a state along the degrees of freedom.
  [[nodiscard]] VectorX velocities_of(const State& state) const;
  /// Sets the velocities of the bodies in `state`, whose poses are those of this object's state.
  void set_velocities(const VectorX& velocities, State& state) const;
  /// The present pose as a state: bodies have no velocity, joints keep their forces, and cables are
  /// those of this object's state.
  [[nodiscard]] State state_here();

 private:
  /// Lets mounted rotors without inertia turn with their carriers.
  void keep_massless_rotors();
  [[nodiscard]] double drift_of(const Row& row) const;
  [[nodiscard]] VectorX gradient_of(const Row& row) const;

  Simulation& simulation_;
  const State& state_;
  int freedoms_;
  Substep substep_;
  std::vector<JointPlace> joints_;
  std::vector<std::vector<char>> drives_;  ///< per feature and multiplier; empty: no joints
  RowList rows_;
};

/// The rotation vector of the shorter rotation [rad].
[[nodiscard]] Vector3 rotation_vector(const Quaternion& rotation);

}  // namespace sheave
