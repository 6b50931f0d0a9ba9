// Rotation. From `from` to `to` the orientation is exp(r) q0 with the rotation vector r(t), a
// cubic. The angular velocity is J(r) r', with the left Jacobian of the exponential
//   J(r) v = v + (1 - cos a) / a^2 r x v + (a - sin a) / a^3 r x (r x v),   a = |r|.
// If r keeps its direction, the angular velocity is r', and Simpson's rule gives the turn exactly.

#include "engine/controls.h"

#include "engine/body_set.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

Vector3 angular_velocity(const Vector3& turn, const Vector3& rate) {
  const double square = dot(turn, turn);
  const double angle = std::sqrt(square);
  // Series for small angles; the next terms are a^4 / 720 and a^4 / 5040.
  const bool small = angle < 1e-3;
  const double first = small ? 0.5 - square / 24.0 : (1.0 - portable::cos(angle)) / square;
  const double second =
      small ? 1.0 / 6.0 - square / 120.0 : (angle - portable::sin(angle)) / (square * angle);
  const Vector3 across = cross(turn, rate);
  return rate + first * across + second * cross(turn, across);
}

}  // namespace

BodyState MotionControl::state_at(const BodySet& bodies, int body, double time) const {
  const bool past = position.past(time);
  if (past && returns) return bodies.kinematic_state(body, time);
  BodyState state;
  state.position = position.at(time);
  state.velocity = position.rate(time);
  if (past) {
    state.angular_velocity = turn.rate_after;
    state.orientation =
        turned(turned(start_orientation, turn.end), (time - turn.to) * turn.rate_after);
  } else {
    state.angular_velocity = angular_velocity(turn.at(time), turn.rate(time));
    state.orientation = turned(start_orientation, turn.at(time));
  }
  return state;
}

Vector3 MotionControl::turn_between(const BodySet& bodies, int body, double begin,
                                    double finish) const {
  if (begin < turn.to && turn.to < finish && turn.past(finish)) {
    return turn_between(bodies, body, begin, turn.to) + turn_between(bodies, body, turn.to, finish);
  }
  if (begin >= turn.to && turn.past(finish)) {
    const Vector3 rate =
        returns ? bodies.definition(body).angular_velocity : Vector3(turn.rate_after);
    return (finish - begin) * rate;
  }
  const auto spin = [&](double time) { return angular_velocity(turn.at(time), turn.rate(time)); };
  return (finish - begin) / 6.0 * (spin(begin) + 4.0 * spin(0.5 * (begin + finish)) + spin(finish));
}

}  // namespace sheave
