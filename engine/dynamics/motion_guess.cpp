#include "engine/dynamics/motion_guess.h"

#include <algorithm>
#include <vector>

#include "engine/index.h"
#include "engine/stages.h"

namespace sheave {
namespace {

/// Displacement of a row's unit acceleration [s2]. The forces of `rattle` act in half a substep.
double displacement_of_unit(const Substep& substep) {
  return substep.load_share * substep.h * substep.h;
}

/// Place of a degree of freedom among the differences of order k.
std::ptrdiff_t at_dof(std::size_t k, const Coordinates& coordinates, int dof) {
  return static_cast<std::ptrdiff_t>(k * at(coordinates.count())) + dof;
}

}  // namespace

bool guess_motion(Substep& substep) {
  const Coordinates& coordinates = substep.bodies.coordinates();
  const MotionHistory& history = substep.start.history;
  substep.guessed = substep.may_guess && history.tells(substep.h, at(coordinates.count()));
  if (!substep.guessed) return false;
  std::vector<double>& motion = substep.guess;
  motion.resize(at(coordinates.count()));
  history.guess(motion);
  const double unit = displacement_of_unit(substep);
  for (double& part : motion) part *= unit;
  for (const BodyFreedom& freedom : coordinates.movable()) {
    MovingBody& body = substep.moving[at(freedom.body)];
    const double* own = &motion[at(freedom.first)];
    if (body.translates) body.position = body.free_position + linear_motion(freedom, own);
    if (body.rotates) body.rotate_to(body.free_turn + angular_motion(freedom, body, own));
  }
  return true;
}

void remember_motion(Substep& substep) {
  const Coordinates& coordinates = substep.bodies.coordinates();
  const std::size_t count = at(coordinates.count());
  MotionHistory& history = substep.next.history;
  if (!substep.asks_for_guess) {
    if (history.known > 0) history = {};
    return;
  }
  substep.guess.assign(2 * count, 0.0);
  double* const found = substep.guess.data();
  double* const by_start = found + count;
  const double rate = 1.0 / displacement_of_unit(substep);
  for (const BodyFreedom& freedom : coordinates.movable()) {
    const MovingBody& body = substep.moving[at(freedom.body)];
    const BodyState& start = substep.start.bodies[at(freedom.body)];
    const Vector3 free_way = body.free_position - body.start_position;
    project(freedom, body, rate * (body.position - body.free_position),
            rate * (body.turn - body.free_turn), found + freedom.first);
    project(freedom, body, rate * (substep.h * start.velocity - free_way),
            rate * (substep.h * start.angular_velocity - body.free_turn), by_start + freedom.first);
  }
  history.add(substep.h, {found, count}, {by_start, count}, coordinates.levers());
}

MotionHistory adopted_history(const MotionHistory& history, const Coordinates& before,
                              const Coordinates& now, std::span<const int> origins) {
  MotionHistory adopted = history;
  if (history.differences.empty()) return adopted;
  const std::size_t kept = static_cast<std::size_t>(MotionHistory::most_known);
  adopted.differences.assign(kept * at(now.count()), 0.0);
  for (const BodyFreedom& freedom : now.movable()) {
    const int origin = origins[at(freedom.body)];
    if (origin < 0 || before[origin].kind != freedom.kind) continue;
    for (std::size_t k = 0; k < kept; ++k) {
      std::copy_n(history.differences.begin() + at_dof(k, before, before[origin].first),
                  size_of(freedom.kind),
                  adopted.differences.begin() + at_dof(k, now, freedom.first));
    }
  }
  return adopted;
}

}  // namespace sheave
