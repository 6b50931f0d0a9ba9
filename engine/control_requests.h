#pragma once
// What is asked for when a control is set (World::set_...()).

#include <optional>

#include "engine/controls.h"

namespace sheave {

/// Where a drive, or a feed, is to go.
///
/// A speed, angle or position is reached steadily by the time that the caller can set it anew: at
/// the end of the next step, or of the substep if it is set between two. So what hangs on it feels
/// an acceleration and no blows. A force or torque acts at once.
struct DriveTarget {
  double value = 0.0;  ///< [rad/s, m/s, rad, m, N m or N], as the drive's kind says
  std::optional<double>
      over;  ///< the time that it takes [s], >= 0; above 0 for angles and positions
  /// Of an angle or position: how fast it arrives, and goes on [rad/s or m/s]. It then begins as
  /// fast as the drive asks for now, without a jump of the speed. Default: at the mean speed of the
  /// way, and there it stops.
  std::optional<double> rate;

  DriveTarget() = default;
  // A plain number is what most callers have.
  DriveTarget(double target) : value(target) {}  // NOLINT(google-explicit-constructor)
  DriveTarget(double target, double time) : value(target), over(time) {}
  DriveTarget(double target, double time, double speed) : value(target), over(time), rate(speed) {}
};

/// A force at a point of a body, and a torque. It acts until it is set anew. Name what you set: an
/// empty `{}` in the place of a vector leaves it uninitialised, as Eigen does; write
/// Vector3::Zero().
struct PointForce {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< besides that of the force [N m]
  std::optional<Vector3> point =
      std::nullopt;  ///< body frame, moves with the body [m]; default: centre of mass
  ForceFrame frame = ForceFrame::world;  ///< of `force` and `torque`
};

/// Where a kinematic body is to go.
///
/// It is there when the time is over, as with drives. With a velocity it begins as it moves now,
/// arrives with that velocity, and goes on with it: a smooth way, which what hangs on it feels as
/// such. Without one it goes straight and stops there.
struct MotionTarget {
  Vector3 position = Vector3::Zero();                    ///< of the origin [m]
  std::optional<Quaternion> orientation = std::nullopt;  ///< by the shorter turn; default: as it is
  std::optional<Vector3> velocity = std::nullopt;        ///< [m/s]
  std::optional<Vector3> angular_velocity = std::nullopt;  ///< [rad/s]; default with a velocity: 0
  std::optional<double> over = std::nullopt;               ///< [s], > 0; default: the next step
};

}  // namespace sheave
