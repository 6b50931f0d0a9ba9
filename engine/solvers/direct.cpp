#include "engine/solvers/direct.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sheave {

double DirectSolver::left_at_most(const Substep& substep, double first) {
  // The scene's size limits the residual, because a prediction far outside of the scene must not
  // excuse it.
  return nearly * std::min(first, substep.bodies.scale());
}

double DirectSolver::residual_before(int round, const RowSystem& system, const Substep& substep) {
  const double enough = tolerance * substep.bodies.scale();
  if (round > 1 || !substep.guessed) return enough;
  const double share = system.may_end_first(substep) ? first_share : looked_share;
  return share * enough + system.rounding();
}

void DirectSolver::give_up(Substep& substep, Features features, bool adding_up) {
  if (substep.resort != Resort::anything || substep.work.stopped()) {
    substep.failed = true;
    return;
  }
  if (make_do(substep, features, adding_up)) return;
  substep.statistics.rows = system_.row_count();
  ++substep.statistics.solver_fallbacks;
  system_.begin_lessening(substep, features);
  sweeps_.solve(substep, features);
}

bool DirectSolver::make_do(Substep& substep, Features features, bool adding_up) {
  if (!adding_up) system_.begin_adding_up();
  const LeastViolation::Outcome outcome = least_.find(substep, features, system_);
  if (outcome == LeastViolation::Outcome::failed) return false;
  StepStatistics& statistics = substep.statistics;
  Course course;
  double& violated = course.violated = system_.violation();
  double imbalance = 0.0;
  if (outcome == LeastViolation::Outcome::met) confirm(substep, features, course, imbalance);
  statistics.rows = system_.row_count();
  statistics.last_correction = std::max(statistics.last_correction, violated);
  system_.count_impossible(substep);
  if (outcome == LeastViolation::Outcome::dead_end) {
    ++statistics.dead_ends;
    statistics.most_impossible = std::max(statistics.most_impossible, violated);
  }
  return true;
}

bool DirectSolver::is_there(const Substep& substep, double astray, double& before) {
  // A distance that no longer falls is rounding; for light bodies rounding is large.
  const bool falls = !(astray > slow * std::exchange(before, astray));
  return !falls || astray <= across * substep.bodies.scale();
}

bool DirectSolver::arrives(Substep& substep, double& astray) const {
  if (!is_there(substep, system_.astray(), astray)) return false;
  system_.follow_gradients(substep);
  return true;
}

bool DirectSolver::leaves_nothing(const Substep& substep) {
  const double left = system_.remainder(substep);
  // Bodies that have run away have no rounding error that would mean anything.
  return !system_.contradicts() && std::isfinite(left) && left <= system_.rounding();
}

bool DirectSolver::needs_no_look(const Substep& substep, int round, bool yields, bool near) {
  const bool swings = system_.swing() > least_swing;
  if (!swings && !yields && leaves_nothing(substep)) return true;
  if (round + 1 == substep.iterations || (round == 0 && !swings)) return false;
  const double share = system_.may_end_first(substep) ? first_share : 0.1;
  return system_.bend(substep, share * tolerance * substep.bodies.scale()) && !yields && near;
}

void DirectSolver::add_up(Substep& substep, Features features, bool lost) {
  system_.begin_adding_up();
  // Newton's method cannot start from places to which the rounds have diverged.
  if (lost) system_.start_again(substep, features);
  system_.linearise(substep, features, RowSystem::Rule::backward, true);
}

void DirectSolver::solve(Substep& substep, Features features) {
  const double enough = tolerance * substep.bodies.scale();
  Course course;
  auto& [violated, before, first, off, first_off, adding_up] = course;
  double astray = std::numeric_limits<double>::infinity();
  bool revised = false;
  bool renewed = false;  // the last round was the first one with the revised rows
  bool compromise = false;
  bool at_start = false;
  bool yields = false;  // rows that share a load, in the last round
  system_.move_on(substep);
  for (int round = 0; round < substep.iterations; ++round) {
    before = violated;
    system_.linearise(substep, features, RowSystem::Rule::backward, adding_up);
    violated = system_.violation();
    off = system_.displacement(violated);
    const bool small = violated <= residual_before(round, system_, substep);
    const bool closes = round > 0 && !revised && small && !yields;
    if (closes && (adding_up || arrives(substep, astray))) break;
    // Rows between driven bodies that nothing can satisfy stay violated in every round.
    const bool settled = adding_up || compromise;
    const bool stays = !revised && !renewed;
    if (round > 2 && settled && stays && violated > stagnation * before) break;
    if (round == 0) first = violated, first_off = off;
    if (!at_start && !adding_up && runs_away(substep, violated, first)) {
      at_start = true;
      before = std::numeric_limits<double>::infinity();
      violated = first = system_.begin_at_start(substep, features, RowSystem::Rule::backward);
      off = first_off = system_.displacement(violated);
    }
    const bool lost = !(violated <= growth * first);
    const bool finite = std::isfinite(violated);
    // Added-up corrections from the prediction may recover from a value that is not finite; one
    // attempt is made.
    if (!finite && (round == 0 || adding_up)) break;
    // In the first rounds the turning of gradients may look like a contradiction.
    compromise = compromise || (round > 1 && system_.contradicts());
    const bool stuck = !compromise && !revised && violated > slow * before && violated > enough;
    if ((round > 1 || !finite) && !adding_up && (lost || stuck)) {
      adding_up = true;
      add_up(substep, features, lost);
    }
    if (!system_.solve(substep, compromise)) return give_up(substep, features, adding_up);
    if (system_.take_back_guess(substep, features)) return solve(substep, features);
    yields = system_.yielded() > 1e-3 * enough;
    // A round that returns from places far away may find another solution.
    const bool near = finite && !lost;
    const bool done = !compromise && needs_no_look(substep, round, yields, near);
    system_.ask_for_guess(substep, round);
    system_.apply(substep, features);
    renewed = std::exchange(revised, false);
    // A revision after the last round would have no round to act in. Features make it in the next
    // substep.
    if (round + 1 == substep.iterations) break;
    for (const auto& feature : features) revised = feature->revise(substep) || revised;
    if (!done || revised) continue;
    violated = 0.0;
    break;
  }
  end_rounds(substep, features, course);
}

bool DirectSolver::confirm(Substep& substep, Features features, Course& course, double& imbalance) {
  double& violated = course.violated;
  if (system_.contradicts() || !std::isfinite(violated)) return false;
  constexpr int most_rounds = 10;
  const double enough = tolerance * substep.bodies.scale();
  added_up_.keep(substep, features);
  system_.end_adding_up();
  bool revised = false;
  for (int round = 0; round < most_rounds; ++round) {
    const double before = violated;
    system_.linearise(substep, features, RowSystem::Rule::backward, false);
    violated = system_.violation();
    if (round == 0) imbalance = system_.imbalance(substep);
    const bool met = round > 0 && violated <= enough;
    if (met && !revised && system_.astray() <= across * substep.bodies.scale()) {
      system_.follow_gradients(substep);
      return true;
    }
    const bool converges = round < 2 || met || violated <= slow * before;
    if (!converges || !std::isfinite(violated)) break;
    if (!system_.solve(substep, false) || system_.contradicts()) break;
    system_.bend(substep, 0.1 * enough);
    system_.apply(substep, features);
    revised = false;
    for (const auto& feature : features) revised = feature->revise(substep) || revised;
  }
  added_up_.go_back(substep, features);
  system_.linearise(substep, features, RowSystem::Rule::backward, true);
  violated = system_.violation();
  course.off = system_.displacement(violated);
  return false;
}

bool DirectSolver::runs_away(const Substep& substep, double violated, double first) {
  // A body that whips past a light one may go several sizes of the scene too far in a round and
  // still return.
  constexpr double away = 1e3;
  return !(violated <= std::max(growth * first, away * substep.bodies.scale()));
}

void DirectSolver::end_rounds(Substep& substep, Features features, Course course) {
  auto& [violated, before, first, off, first_off, adding_up] = course;
  double imbalance = 0.0;
  if (adding_up) adding_up = !confirm(substep, features, course, imbalance);
  const double enough = tolerance * substep.bodies.scale();
  // Two rounds do not show whether more of them would converge, and the user has asked for no more.
  const bool tried = adding_up || substep.iterations > 2;
  // Rounds on their way back from a large violation do not show it, either.
  const bool near = violated <= enough || (violated <= slow * before && violated <= first);
  const bool lost = (tried && !near && off > left_at_most(substep, first_off)) ||
                    !std::isfinite(violated) ||
                    (adding_up && violated <= enough &&
                     (imbalance > unbalanced || system_.energy_gain(substep) > unresolved));
  substep.failed = lost && substep.resort != Resort::anything;
  if (substep.failed) return;
  if (lost && make_do(substep, features, adding_up)) return;
  substep.statistics.rows = system_.row_count();
  substep.statistics.last_correction = std::max(substep.statistics.last_correction, violated);
  system_.count_impossible(substep);
}

}  // namespace sheave
