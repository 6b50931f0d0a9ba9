#include "engine/solvers/velocity_system.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/solvers/direct.h"
#include "engine/stages.h"

namespace sheave {

double VelocitySystem::rate_of(const Substep& substep, const Row& row) const {
  double rate = row.rate;
  for (const RowTerm& term : row.active_terms()) {
    if (term.body == substep.bodies.count()) continue;
    const BodyState& body = substep.next.bodies[at(term.body)];
    rate += dot(term.linear, body.velocity) + dot(term.angular, body.angular_velocity);
  }
  return rate;
}

void VelocitySystem::linearise(Substep& substep, RowSystem& positions) {
  take_rows(positions);
  for (Row& row : rows_) std::swap(row.weight, row.start_weight);
  problem_.rounding = rounding_ / substep.h;
  symmetric_rows_ = true;
  fill_slots(substep);
  slots_.join(rows_);
  make_groups();
  act_springs(substep);
  pose(substep, positions);
  if (!shared_.empty()) begin_shared_friction();
}

double VelocitySystem::pressed_share(std::size_t row) const {
  if (bounds_friction(groups_[at(group_of_[row])])) return 1.0;
  const double sign = rows_[row].lower == 0.0 ? 1.0 : -1.0;
  const double start = sign * starts_[row].value;
  const double end = sign * rows_[row].value;
  return start > 0.0 && end < 0.0 ? end / (end - start) : 1.0;
}

double VelocitySystem::yield_of_rate(std::size_t row) const {
  const double whole = rows_[row].settling;
  const double settling = whole > 0.0 ? pressed_share(row) * whole : 0.0;
  const double own = slots_.yield(static_cast<int>(row));
  return rows_[row].softness + (settling > 0.0 ? (1.0 / settling - 1.0) * own : 0.0);
}

void VelocitySystem::pose(const Substep& substep, const RowSystem& positions) {
  const double closed = DirectSolver::closed * substep.bodies.scale();
  const double share =
      0.5 / substep.h;  // share of the bounds for an impulse in the second half of the substep
  // Velocities do not determine forces in balance (a state of self-stress). Such forces keep their
  // values of the first half, for which bounds and links have been decided.
  take_redundant_parts(positions);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    const Row& first = rows_[at(group.first_row)];
    double value = 0.0;
    double rate = 0.0;
    for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
      value += rows_[at(i)].value;
      rate += rate_of(substep, rows_[at(i)]);
      problem_.diagonal[g] += rows_[at(i)].weight * yield_of_rate(at(i));
    }
    // A damper beside a compressed spring. Over the whole substep the two together do not pull.
    if (first.settling > 0.0 && group.multiplier > 0.0) {
      problem_.constant[g] = rate;
      problem_.lower[g] = -2.0 * group.multiplier / substep.h;
      problem_.upper[g] = Row::unbounded;
      problem_.free[g] = 1;
      group.multiplier = 0.0;
      continue;
    }
    const bool acts = !group.elastic && !(rate < -first.rebound_speed) &&
                      (group.multiplier != 0.0 || std::abs(value) * first.lever <= closed ||
                       (std::isfinite(first.lower) && value < 0.0) ||
                       (std::isfinite(first.upper) && value > 0.0));
    const bool bilateral = !std::isfinite(first.lower) && !std::isfinite(first.upper);
    const double lower = acts ? share * first.lower : 0.0;
    const double upper = acts ? share * first.upper : 0.0;
    problem_.free[g] =
        acts && first.lower != first.upper && (bilateral || group.multiplier != 0.0) ? 1 : 0;
    const bool redundant = !redundant_part_.empty() && redundant_part_[g] != 0;
    group.multiplier =
        redundant ? std::clamp(group.multiplier / substep.h, lower, upper) : 0.0;  // in the impulse
    problem_.constant[g] = rate;
    problem_.lower[g] = lower - group.multiplier;
    problem_.upper[g] = upper - group.multiplier;
  }
  if (redundant_part_.empty()) return;
  start_from_impulses();
  // At the end of the substep the rows may be independent by rounding alone, and their solution
  // would follow from rounding. The regularisation prevents this.
  share_load();
}

double VelocitySystem::impulse_of(std::size_t g) const {
  const double change = active_set_.solution()[g];
  // Rounding may put a free unknown beyond its bound.
  return groups_[g].multiplier + std::clamp(change, problem_.lower[g], problem_.upper[g]);
}

double VelocitySystem::whole_multiplier(double h, int row) const {
  const auto i = at(row);
  const Group& group = groups_[at(group_of_[i])];
  if (group.elastic) {
    return 2.0 * previous_[i] + h * rows_[i].weight * impulse_of(at(group_of_[i]));
  }
  return previous_[i] + h * rows_[i].weight * impulse_of(at(group_of_[i]));
}

bool VelocitySystem::revise(Substep& substep, Features features, const RowSystem& positions) {
  bool changed = false;
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<double> multipliers = features[f]->multipliers();
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      multipliers[at(rows_[at(i)].index)] = whole_multiplier(substep.h, i);
    }
    bool revised = features[f]->revise_impulses(substep);
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      multipliers[at(rows_[at(i)].index)] = previous_[at(i)];
    }
    if (!revised) continue;
    revised_rows_.clear();
    features[f]->linearise(substep, revised_rows_);
    const auto first = at(feature_rows_[f]);
    if (revised_rows_.size() != at(feature_rows_[f + 1]) - first) continue;
    for (std::size_t i = 0; i < revised_rows_.size(); ++i) {
      rows_[first + i] = revised_rows_[i];
      previous_[first + i] = multipliers[at(revised_rows_[i].index)];
    }
    changed = true;
  }
  if (!changed) return false;
  turn_as_in(positions);
  fill_slots(substep);
  slots_.join(rows_);
  make_groups();
  pose(substep, positions);
  if (!shared_.empty()) begin_shared_friction();
  return true;
}

double VelocitySystem::taken_friction(std::size_t row, double bound, double h) const {
  const std::size_t pressing = row - at(rows_[row].pressed_by);
  double pressed = previous_[pressing];
  if (rows_[row].pressed_also > 0) pressed += previous_[row - at(rows_[row].pressed_also)];
  const double whole = std::max(rows_[row].friction * pressed + h * bound, 0.0);
  double square = 0.0;
  for (std::size_t i = pressing + 1; i < rows_.size(); ++i) {
    if (i - at(rows_[i].pressed_by) != pressing || rows_[i].pressed_by == 0) break;
    square += previous_[i] * previous_[i];
  }
  const double used = std::sqrt(square);
  return used > whole ? (whole / used - 1.0) * previous_[row] / h : 0.0;
}

bool VelocitySystem::bound_friction(double h) {
  constexpr double settled_share = 1e-7;  // the same as between the rounds of the positions
  const std::span<const double> change = active_set_.solution();
  const auto impulse = [&](std::size_t g) { return groups_[g].multiplier + change[g]; };
  const auto pressure = [&](std::size_t row) {
    const double late = whole_multiplier(h, static_cast<int>(row)) - previous_[row];
    // The damper of a contact may take back force of the first half.
    return rows_[row].settling > 0.0 ? late / h : std::max(late / h, 0.0);
  };
  bool changed = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!(rows_[i].friction > 0.0)) continue;
    const std::size_t g = at(group_of_[i]);
    const std::size_t pressing = i - at(rows_[i].pressed_by);
    const bool elastic = groups_[at(group_of_[pressing])].elastic != 0;
    if (elastic && !(rows_[pressing].settling > 0.0)) continue;
    double pressed = pressure(pressing);
    if (rows_[i].pressed_also > 0) pressed += pressure(i - at(rows_[i].pressed_also));
    const double bound = rows_[i].friction * pressed;
    const double before = friction_bounds_[i];
    // A bound that friction does not reach may change without effect.
    const double used = std::abs(impulse(g));
    const bool matters = used > bound || used >= (1.0 - 1e-9) * before;
    if (matters &&
        std::abs(bound - before) > settled_share * std::max(std::abs(bound), std::abs(before))) {
      changed = true;
    }
    const double next = pressures_[i].next(before, bound);
    friction_bounds_[i] = next;
    const double center = next < 0.0 ? taken_friction(i, next, h) : 0.0;
    problem_.lower[g] = center - std::max(next, 0.0) - groups_[g].multiplier;
    problem_.upper[g] = center + std::max(next, 0.0) - groups_[g].multiplier;
    // An unknown without room between its bounds is not free, because no residual would show that
    // it leaves its bounds.
    if (!(next > 0.0)) problem_.free[g] = 0;
  }
  return changed;
}

bool VelocitySystem::find_impulses(Substep& substep, bool direct, int sweeps) {
  pressures_.assign(rows_.size(), {});
  friction_bounds_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto g = at(group_of_[i]);
    friction_bounds_[i] = problem_.upper[g] + groups_[g].multiplier;
  }
  for (int round = 0; round < std::max(sweeps, 1); ++round) {
    if (round > 0) {
      // The matrix of the first round still holds.
      if (!direct) {
        active_set_.relax(problem_, sweeps, &substep.work);
      } else if (!active_set_.solve(problem_, true, &substep.work)) {
        return false;
      }
    } else if (!direct) {
      relax(substep, sweeps);
    } else if (!solve(substep, true)) {
      return false;
    }
    const bool bounds = bound_friction(substep.h);
    const bool directions = !shared_.empty() && turn_friction();
    if (!bounds && !directions) break;
  }
  return true;
}

void VelocitySystem::start_from_impulses() {
  std::fill(motion_.begin(), motion_.end(), 0.0);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].multiplier == 0.0) continue;
    slots_.add_unknown(static_cast<int>(g), groups_[g].multiplier, motion_.data());
  }
  count_motion();
}

void VelocitySystem::act_springs(Substep& substep) {
  // F = 2 l / h^2 acts along the gradient of the end.
  motion_.assign(at(substep.bodies.coordinates().count()), 0.0);
  bool any = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!groups_[at(group_of_[i])].elastic || previous_[i] == 0.0) continue;
    slots_.add_row(static_cast<int>(i), previous_[i] / substep.h, motion_.data());
    any = true;
  }
  if (any) move(substep);
}

void VelocitySystem::move(Substep& substep) {
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    const MovingBody& body = substep.moving[at(freedom.body)];
    BodyState& next = substep.next.bodies[at(freedom.body)];
    const double* motion = &motion_[at(freedom.first)];
    next.velocity += linear_motion(freedom, motion);
    // A mounted rotor gets its spin here; follow_carriers() adds the carrier's motion.
    next.angular_velocity += angular_motion(freedom, body, motion);
  }
  follow_carriers(substep);
}

void VelocitySystem::apply(Substep& substep, Features features) {
  motion_.assign(at(substep.bodies.coordinates().count()), 0.0);
  substep.late_forces.resize(features.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<double> multipliers = features[f]->multipliers();
    std::vector<double>& late = substep.late_forces[f];
    late.assign(multipliers.size(), 0.0);
    for (int r = feature_rows_[f]; r < feature_rows_[f + 1]; ++r) {
      const auto i = at(r);
      const Group& group = groups_[at(group_of_[i])];
      const double found = rows_[i].weight * impulse_of(at(group_of_[i]));
      const double impulse = group.elastic ? previous_[i] / substep.h + found : found;
      multipliers[at(rows_[i].index)] = previous_[i] + substep.h * impulse;
      late[at(rows_[i].index)] = impulse / substep.h;
      if (found != 0.0) slots_.add_row(r, found, motion_.data());
    }
    for (const SharedFriction& friction : shared_) {
      if (friction.feature != f || !friction.turned) continue;
      turn_back(friction, multipliers);
      turn_back(friction, late);
    }
  }
  move(substep);
}

}  // namespace sheave
