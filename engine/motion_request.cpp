#include "engine/motion_request.h"

#include "engine/math/portable.h"

namespace sheave {
namespace {

/// A turn about a fixed axis, with the factor for rates of its rotation vector.
struct Turn {
  Vector3 vector = Vector3::Zero();  ///< [rad]
  double share = 1.0 / 12.0;         ///< (1 - x cot x) / (2 x)^2, with x half the angle
};

/// The shorter turn from one orientation to another.
Turn turn_to(const Quaternion& from, const Quaternion& to) {
  Quaternion change = to * from.conjugate();
  if (change.w() < 0.0) change.coeffs() = -change.coeffs();
  const double sine = change.vec().norm();
  Turn turn;
  if (!(sine > 0.0)) return turn;
  const double half = portable::atan2(sine, change.w());
  turn.vector = change.vec() * (2.0 * half / sine);
  const double square = 4.0 * half * half;
  // Below this angle the next term of the series is less than rounding.
  turn.share =
      square < 1e-6 ? 1.0 / 12.0 + square / 720.0 : (1.0 - half * change.w() / sine) / square;
  return turn;
}

/// The rate of the rotation vector w at the end of a turn, for an angular velocity a [rad/s]: a - w
/// x a / 2 + share w x (w x a).
Vector3 rate_at_end(const Turn& turn, const Vector3& angular_velocity) {
  if (is_zero(turn.vector)) return angular_velocity;
  const Vector3 across = cross(turn.vector, angular_velocity);
  return angular_velocity - 0.5 * across + turn.share * cross(turn.vector, across);
}

/// Sets all but the rates of a motion from `from` to the position `end` [m], turned by `turned_by`,
/// within `over` seconds from `time` on.
void set_way(const BodyState& from, const Vector3& end, const Turn& turned_by, double time,
             double over, MotionControl& motion) {
  motion.moves = true;
  motion.returns = false;
  motion.start_orientation = from.orientation;
  RampOf<Vector3>& way = motion.position;
  RampOf<Vector3>& turn = motion.turn;
  way.from = turn.from = time;
  way.to = turn.to = time + over;
  way.start = from.position;
  way.end = end;
  turn.start.setZero();
  turn.end = turned_by.vector;
}

/// Sets the rates of a motion that starts with the velocities of `from` and arrives with the given
/// ones.
void set_smooth_rates(const BodyState& from, const Turn& turned_by, const Vector3& velocity,
                      const Vector3& angular_velocity, MotionControl& motion) {
  RampOf<Vector3>& way = motion.position;
  RampOf<Vector3>& turn = motion.turn;
  way.start_rate = from.velocity;
  way.end_rate = way.rate_after = velocity;
  turn.start_rate = from.angular_velocity;
  turn.end_rate = rate_at_end(turned_by, angular_velocity);
  turn.rate_after = angular_velocity;
}

/// Sets the rates of a uniform motion that stops at the end.
void set_straight_rates(const Vector3& velocity, const Vector3& angular_velocity,
                        MotionControl& motion) {
  motion.position.start_rate = motion.position.end_rate = velocity;
  motion.position.rate_after.setZero();
  motion.turn.start_rate = motion.turn.end_rate = angular_velocity;
  motion.turn.rate_after.setZero();
}

Vector3 over_time(const Vector3& way, double time) {
  return {way[0] / time, way[1] / time, way[2] / time};
}

}  // namespace

MotionControl motion_to(const BodyState& from, const MotionTarget& target, double time,
                        double over) {
  Turn turn;
  if (target.orientation) turn = turn_to(from.orientation, target.orientation->normalized());
  MotionControl motion;
  set_way(from, target.position, turn, time, over, motion);
  if (target.velocity) {
    const Vector3 none = Vector3::Zero();
    const Vector3& spin = target.angular_velocity ? *target.angular_velocity : none;
    set_smooth_rates(from, turn, *target.velocity, spin, motion);
  } else {
    const Vector3 speed = over_time(target.position - from.position, over);
    set_straight_rates(speed, over_time(turn.vector, over), motion);
  }
  return motion;
}

}  // namespace sheave
