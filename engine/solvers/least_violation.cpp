#include "engine/solvers/least_violation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/index.h"
#include "engine/integrators/loads.h"
#include "engine/solvers/direct.h"

namespace sheave {
namespace {

constexpr int most_rounds = 200;
constexpr double first_damping = 1e-3;
constexpr double least_damping = 1e-9;
constexpr double most_damping = 1e12;
// Near a dead end the least damping that reduces the misfit stays near that of the rows' curvature
// for many rounds. A damping above it makes rounds shorter in the same ratio, and a damping below
// it costs a failed attempt.
constexpr double more = 3.0;
constexpr double less_of_it = 0.5;
/// Smallest violation that counts as a gap, relative to the scene's size: above the residual of
/// rounds.
constexpr double gap = 1e-9;
/// A way out longer than this many sizes of the scene is none, and the descent ends.
constexpr double far = 1e3;

/// Longest way of a round, relative to the scene's size, and in rad: longer rounds do not find a
/// near solution.
constexpr double longest_way = 0.1;

enum class Start { of_substep, to_one_side, to_the_other };

/// A pseudo-random number from -1 to 1, independent of the machine.
double anything(std::uint32_t& seed) {
  seed = seed * 1664525U + 1013904223U;
  return static_cast<double>(seed) / 2147483648.0 - 1.0;
}

/// Largest motion of any body from its old place: distance relative to the scene's size, or turn
/// [rad].
double way_from(const std::vector<MovingBody>& bodies, const Substep& substep) {
  double most = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const MovingBody& now = substep.moving[i];
    most = std::max({most, (now.position - bodies[i].position).norm() / substep.bodies.scale(),
                     (now.turn - bodies[i].turn).norm()});
  }
  return most;
}

void begin_at(Start start, Substep& substep, Features features) {
  constexpr double aside = 1e-3;  // relative to the scene's size, and [rad]
  const double side = start == Start::to_one_side ? aside : -aside;
  std::uint32_t seed = 1;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    MovingBody& body = substep.moving[at(i)];
    const auto any = [&] { return Vector3(anything(seed), anything(seed), anything(seed)); };
    if (start == Start::of_substep) {
      if (body.translates) body.position = body.start_position;
      if (body.rotates) body.rotate(-body.turn);
      continue;
    }
    if (body.translates) {
      body.position += allowed_velocity(substep.bodies[i], side * substep.bodies.scale() * any());
    }
    if (!body.rotates) continue;
    const bool axial = !is_zero(body.axis);
    body.rotate(axial ? Vector3(side * anything(seed) * body.axis) : Vector3(side * any()));
  }
  for (const auto& feature : features) {
    std::fill(feature->multipliers().begin(), feature->multipliers().end(), 0.0);
  }
}

}  // namespace

bool LeastViolation::revise(Substep& substep, Features features) {
  bool revised = false;
  for (const auto& feature : features) revised = feature->revise(substep) || revised;
  return revised;
}

LeastViolation::Place LeastViolation::descend(Substep& substep, Features features,
                                              RowSystem& system) {
  const double scale = substep.bodies.scale();
  const auto look = [&] {
    system.linearise(substep, features, RowSystem::Rule::backward, true);
    return system.misfit(substep);
  };
  Place place;
  place.misfit = look();
  double damping = first_damping;
  for (int round = 0; round < most_rounds; ++round) {
    place.violation = system.violation();
    place.way_out = system.way_out(substep);
    place.met = place.violation <= DirectSolver::tolerance * scale;
    if (place.met || place.way_out > far * scale) break;
    round_.keep(substep, features);
    bool less = false;
    bool solved = false;
    for (; !less && damping < most_damping; damping *= more) {
      if (substep.work.stopped()) return place;
      if (!system.solve_damped(substep, damping)) continue;
      solved = true;
      system.apply(substep, features);
      const double now = look();
      less = now < place.misfit && way_from(round_.bodies(), substep) < longest_way;
      if (less) {
        place.misfit = now;
        break;
      }
      round_.go_back(substep, features);
      place.misfit = look();
    }
    place.failed = round == 0 && !solved;
    if (!less) break;
    damping = std::max(less_of_it * damping, least_damping);
  }
  return place;
}

int LeastViolation::descend_and_revise(Substep& substep, Features features, RowSystem& system,
                                       Place& place) {
  constexpr int most_revisions = 8;
  std::array<double, most_revisions> misfits{};
  for (int i = 0; i < most_revisions; ++i) {
    // Forces that nearly balance each other are large at the least misfit. With other rows they
    // would no longer do so, so each descent starts without forces.
    system.begin_lessening(substep, features);
    place = descend(substep, features, system);
    if (place.failed || substep.work.stopped()) return 0;
    if (!revise(substep, features)) return 1;
    // A misfit that is equal to the last bit belongs to the same set of rows.
    const auto end = misfits.begin() + i;
    const auto before = std::find(misfits.begin(), end, place.misfit);
    if (before != end) return static_cast<int>(end - before);
    *end = place.misfit;
  }
  return 0;
}

bool LeastViolation::is_stationary(const Substep& substep, const Place& place) {
  const double scale = substep.bodies.scale();
  return place.way_out > scale && place.violation > gap * scale;
}

bool LeastViolation::escapes(Substep& substep, Features features, RowSystem& system) {
  for (const Start start : {Start::of_substep, Start::to_one_side, Start::to_the_other}) {
    if (start != Start::of_substep) least_.go_back(substep, features);
    begin_at(start, substep, features);
    const Place other = descend(substep, features, system);
    if (other.met || !is_stationary(substep, other)) return true;
    // A search that the limit of work has cut short proves nothing.
    if (substep.work.exhausted() || substep.work.stopped()) return true;
  }
  return false;
}

bool LeastViolation::nothing_is_near(Substep& substep, Features features, RowSystem& system) {
  result_.keep(substep, features);
  system.begin_lessening(substep, features, true);
  const Place place = descend(substep, features, system);
  bool nothing = !place.met && is_stationary(substep, place);
  if (nothing) {
    least_.keep(substep, features);
    nothing = !escapes(substep, features, system);
  }
  system.end_lessening();
  result_.go_back(substep, features);
  return nothing;
}

LeastViolation::Outcome LeastViolation::find(Substep& substep, Features features,
                                             RowSystem& system) {
  Place found;
  const int choices = descend_and_revise(substep, features, system, found);
  if (found.failed) return Outcome::failed;
  if (found.met && choices == 1) return Outcome::met;
  bool nothing = choices > 0 && found.misfit > 0.0 && std::isfinite(found.misfit);
  for (int i = 0; i < choices && nothing; ++i) {
    if (choices > 1) {
      system.begin_lessening(substep, features);
      nothing = !descend(substep, features, system).failed;
    }
    nothing = nothing && nothing_is_near(substep, features, system);
    if (choices > 1) revise(substep, features);
  }
  if (choices == 1 || nothing) system.linearise(substep, features, RowSystem::Rule::backward, true);
  return nothing ? Outcome::dead_end : Outcome::unresolved;
}

}  // namespace sheave
