#include "engine/state_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/body_set.h"
#include "engine/constraint_batch.h"
#include "engine/index.h"
#include "engine/state.h"

namespace sheave {
namespace {

bool has_angle(const BodyProperties& body) {
  return body.mobility == Mobility::planar || body.mobility == Mobility::rotor;
}

/// The turn of a planar body or a rotor since time 0, as a quaternion about its axis.
Quaternion turn_since_start(const BodySet& bodies, const State& state, int index) {
  const BodyProperties& body = bodies[index];
  const Quaternion& now = state.bodies[at(index)].orientation;
  Quaternion carrier = Quaternion::Identity();
  if (body.mount >= 0) carrier = state.bodies[at(body.mount)].orientation;
  return carrier.conjugate() * now * body.start_orientation.conjugate();
}

const char* body_fault(const BodySet& bodies, const State& state, int index) {
  // Six printed decimals leave less than this of a length or a direction.
  constexpr double slop = 1e-6;
  const BodyState& body = state.bodies[at(index)];
  if (!body.position.allFinite()) return "position is not finite";
  if (!body.orientation.coeffs().allFinite()) return "orientation is not finite";
  if (!body.velocity.allFinite()) return "velocity is not finite";
  if (!body.angular_velocity.allFinite()) return "angular velocity is not finite";
  if (!std::isfinite(body.angle)) return "angle is not finite";
  if (std::abs(body.orientation.norm() - 1.0) > slop) return "orientation is no unit quaternion";
  if (has_angle(bodies[index])) {
    const Quaternion turn = turn_since_start(bodies, state, index);
    if (turn.vec().cross(bodies[index].axis).norm() > slop) {
      return "orientation is not reached from that at time 0 by a turn about its axis";
    }
  }
  return nullptr;
}

}  // namespace

std::string state_fault(const State& state, const BodySet& bodies,
                        std::span<const std::unique_ptr<ConstraintBatch>> features) {
  if (!std::isfinite(state.time)) return "its time is not finite";
  if (state.time < 0.0) return "its time is below 0 s";
  // The largest count of steps that a double holds exactly
  constexpr std::int64_t most_steps = std::int64_t{1} << 53;
  if (state.steps < 0 || state.steps > most_steps) {
    return "its number of steps is not between 0 and 2^53";
  }
  for (int i = 0; i < bodies.count(); ++i) {
    const char* fault = body_fault(bodies, state, i);
    if (fault != nullptr) return "body \"" + bodies.name(i) + "\": its " + fault;
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::vector<double>& reals = state.features[i].reals;
    const auto bad =
        std::find_if(reals.begin(), reals.end(), [](double x) { return !std::isfinite(x); });
    if (bad == reals.end()) continue;
    return std::string(features[i]->name()) + ": number " + std::to_string(bad - reals.begin()) +
           " of their state is not finite";
  }
  return {};
}

void fit_angles(const BodySet& bodies, State& state) {
  for (int i = 0; i < bodies.count(); ++i) {
    if (!has_angle(bodies[i])) continue;
    const Quaternion turn = turn_since_start(bodies, state, i);
    double& angle = state.bodies[at(i)].angle;
    const double within = 2.0 * std::atan2(turn.vec().dot(bodies[i].axis), turn.w());
    const double off = std::remainder(within - angle, 2.0 * std::numbers::pi);
    // Rounding of a product of quaternions, and of an angle of many turns.
    if (std::abs(off) > 1e-9 + 1e-14 * std::abs(angle)) angle += off;
  }
}

}  // namespace sheave
