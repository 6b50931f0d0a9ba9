#pragma once
// The arguments of World::set_...().

#include <optional>

#include "engine/controls.h"

namespace sheave {

/// The target of a drive or a feed.
///
/// The drive reaches a speed, an angle or a position by a ramp. By default the ramp ends when the
/// caller can next set the control: at the end of the next step, or at the end of the substep if
/// the control is set before a substep. The ramp gives bodies on the drive a finite acceleration in
/// place of an impact. A force or torque acts at once.
///
/// Every call begins a new ramp at the present value, also with the same target. A ramp that is set
/// again in each step never ends, so set it once, when the target changes.
struct DriveTarget {
  double value = 0.0;          ///< [rad/s, m/s, rad, m, N m or N], as the drive's kind says
  std::optional<double> over;  ///< duration of the ramp [s], >= 0; above 0 for angles and positions
  /// Rate with which an angle or position reaches the target and continues [rad/s or m/s]. The ramp
  /// then starts with the drive's present rate, so the speed does not jump. Default: the mean rate
  /// of the ramp throughout, and rest at the target.
  std::optional<double> rate;

  DriveTarget() = default;
  // Implicit, because most callers have a plain number.
  DriveTarget(double target) : value(target) {}  // NOLINT(google-explicit-constructor)
  DriveTarget(double target, double time) : value(target), over(time) {}
  DriveTarget(double target, double time, double speed) : value(target), over(time), rate(speed) {}
};

/// A force at a point of a body, and a torque. Both act until they are set anew. Name the members
/// that you set. An empty `{}` in place of a vector leaves the vector uninitialised, as Eigen does;
/// write Vector3::Zero().
struct PointForce {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< in addition to the moment of the force [N m]
  std::optional<Vector3> point =
      std::nullopt;  ///< body frame, moves with the body [m]; default: centre of mass
  ForceFrame frame = ForceFrame::world;  ///< of `force` and `torque`
};

/// The target of a kinematic body.
///
/// The body reaches the target at the end of `over`. With a velocity, the body starts with its
/// present velocity, arrives with the given velocity and continues with it, so the velocity is
/// continuous. Without a velocity, the body moves uniformly and stops at the target.
struct MotionTarget {
  Vector3 position = Vector3::Zero();  ///< of the origin [m]
  /// Reached by the shorter turn; default: unchanged
  std::optional<Quaternion> orientation = std::nullopt;
  std::optional<Vector3> velocity = std::nullopt;          ///< [m/s]
  std::optional<Vector3> angular_velocity = std::nullopt;  ///< [rad/s]; default with a velocity: 0
  std::optional<double> over = std::nullopt;               ///< [s], > 0; default: the next step
};

}  // namespace sheave
