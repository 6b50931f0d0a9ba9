// Starting points of Newton's rounds: engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {
namespace {

void clear_multipliers(Features features) {
  for (const auto& feature : features) {
    std::fill(feature->multipliers().begin(), feature->multipliers().end(), 0.0);
  }
}

}  // namespace

void RowSystem::move_on(Substep& substep) {
  double square = 0.0;
  begin_rounds();
  remember_origin(substep);
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const BodyState& start = substep.start.bodies[at(i)];
    MovingBody& body = substep.moving[at(i)];
    if (body.translates) body.position = sum(body.start_position, substep.h, start.velocity);
    if (!body.rotates) continue;
    const Vector3 turn = substep.h * start.angular_velocity;
    if (body.translates) square = std::max(square, dot(turn, turn));
    body.rotate(turn - body.turn);
  }
  swing_ = std::sqrt(square);
}

void RowSystem::start_again(Substep& substep, Features features) {
  begin_rounds();
  clear_multipliers(features);
  for (std::size_t b = 0; b < origin_.size(); ++b) {
    MovingBody& body = substep.moving[b];
    if (body.translates) body.position = origin_[b].position;
    if (body.rotates) body.rotate(origin_[b].turn - body.turn);
  }
}

double RowSystem::begin_at_start(Substep& substep, Features features, Rule rule) {
  begin_rounds();
  clear_multipliers(features);
  for (MovingBody& body : substep.moving) {
    if (body.translates) body.position = body.start_position;
    if (body.rotates) body.rotate(-body.turn);
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  return linearise(substep, features, rule, false) ? violation() : none;
}

}  // namespace sheave
