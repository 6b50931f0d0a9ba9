// Geometric stiffness within a round: engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {

double RowSystem::astray() const { return longest(motion_); }

double RowSystem::longest(std::span<const double> motion) const {
  double most = 0.0;
  for (std::size_t d = 0; d < motion.size(); ++d) {
    most = std::max(most, std::abs(motion[d]) * levers_[d]);
  }
  return most;
}

void RowSystem::find_motion() {
  const std::span<const double> change = active_set_.solution();
  for (const int r : curvature_.rows()) {
    const auto g = at(group_of_[at(r)]);
    row_multipliers_[at(r)] =
        forces_turn_ ? rows_[at(r)].weight * (groups_[g].multiplier + change[g]) : 0.0;
  }
  for (std::size_t d = 0; d < trial_.size(); ++d) trial_[d] = residual_[d] + bend_[d];
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (change[g] != 0.0) slots_.add_unknown(static_cast<int>(g), change[g], trial_.data());
  }
}

double RowSystem::remainder(const Substep& substep) {
  if (from_here_ || !told_) return std::numeric_limits<double>::infinity();
  if (!curvature_.collect(rows_, substep.bodies.coordinates(), substep.moving)) return 0.0;
  begin_bending();
  find_motion();
  std::vector<double>& turned = bend_;
  if (!curvature_.turn(substep.bodies.coordinates(), substep.moving, row_multipliers_, trial_,
                       turned, second_order_)) {
    return std::numeric_limits<double>::infinity();
  }
  return std::max(curvature_.largest(second_order_), longest(turned));
}

void RowSystem::begin_bending() {
  residual_ = motion_;
  bend_.assign(motion_.size(), 0.0);
  trial_.resize(motion_.size());
  row_multipliers_.resize(rows_.size());
  second_order_.assign(rows_.size(), 0.0);
}

void RowSystem::find_rubbing_rows() {
  rubbing_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    if (row.friction > 0.0) rubbing_.push_back({static_cast<int>(i), bound_share_ * row.upper});
  }
}

double RowSystem::follow_pressure(bool first) {
  const std::span<const double> change = active_set_.solution();
  const auto unknown = [&](std::size_t g) { return groups_[g].multiplier + change[g]; };
  const auto pressure = [&](std::size_t row) {
    return rows_[row].weight * std::max(unknown(at(group_of_[row])), 0.0);
  };
  // The bounds b of friction follow pressures that depend on the bounds: a linear fixed point b =
  // f(b). The last two steps predict the next one (Anderson's method).
  double product = 0.0;
  double square = 0.0;
  for (Rubbing& rubbing : rubbing_) {
    const auto i = at(rubbing.row);
    double pressed = pressure(i - at(rows_[i].pressed_by));
    if (rows_[i].pressed_also > 0) pressed += pressure(i - at(rows_[i].pressed_also));
    rubbing.wanted = rows_[i].friction * pressed;
    const double off = rubbing.wanted - rubbing.bound;
    product += off * (off - rubbing.off);
    square += (off - rubbing.off) * (off - rubbing.off);
  }
  const double back = first || !(square > 0.0) ? 0.0 : product / square;
  double moved = 0.0;
  for (Rubbing& rubbing : rubbing_) {
    const auto i = at(rubbing.row);
    const std::size_t g = at(group_of_[i]);
    const double off = rubbing.wanted - rubbing.bound;
    const double next =
        std::max(rubbing.wanted - back * (rubbing.wanted - rubbing.last_wanted), 0.0);
    const double used = std::abs(unknown(g));
    // A bound that friction does not reach may change without effect.
    if (used >= (1.0 - 1e-9) * rubbing.bound || used > next) {
      moved = std::max(moved,
                       std::abs(next - rubbing.bound) * slots_.yield(rubbing.row) * rows_[i].lever);
    }
    rubbing.off = off;
    rubbing.last_wanted = rubbing.wanted;
    rubbing.last_bound = rubbing.bound;
    rubbing.bound = next;
    set_friction(rubbing, g);
  }
  return moved;
}

void RowSystem::set_friction(const Rubbing& rubbing, std::size_t group) {
  problem_.lower[group] = -rubbing.bound - groups_[group].multiplier;
  problem_.upper[group] = rubbing.bound - groups_[group].multiplier;
}

double RowSystem::turn_forces(const Substep& substep, bool& straight) {
  std::fill(motion_.begin(), motion_.end(), 0.0);
  straight = curvature_.rows().empty() ||
             !curvature_.turn(substep.bodies.coordinates(), substep.moving, row_multipliers_,
                              trial_, motion_, second_order_);
  if (straight) {
    motion_ = bend_;
    return 0.0;
  }
  double change = 0.0;
  for (std::size_t d = 0; d < motion_.size(); ++d) {
    change = std::max(change, std::abs(motion_[d] - bend_[d]) * levers_[d]);
  }
  return change;
}

bool RowSystem::refine() {
  change_.swap(problem_.constant);
  problem_.constant = constant_;
  count_motion();
  for (const int r : curvature_.rows()) {
    const auto g = at(group_of_[at(r)]);
    problem_.constant[g] += groups_[g].scale * second_order_[at(r)];
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    change_[g] = problem_.constant[g] - change_[g];
  }
  return active_set_.refine(problem_, change_);
}

void RowSystem::bend(const Substep& substep, double negligible) {
  constexpr int most_turns = 12;
  constexpr double settled_share = 1e-2;  // a round leaves an error of about this share anyway
  // Rows that depend on each other need not have the same second-order terms. A load that they
  // share would follow from the difference of these terms, and stay.
  if (from_here_ || (shares_load_ && shares_judged_)) return;
  find_rubbing_rows();
  const bool curved = curvature_.collect(rows_, substep.bodies.coordinates(), substep.moving);
  if (!curved && rubbing_.empty()) return;
  begin_bending();
  constant_ = problem_.constant;
  double before = 0.0;
  double whole = 0.0;
  for (int i = 0; i < most_turns; ++i) {
    find_motion();
    bool straight = false;
    double change = turn_forces(substep, straight);
    if (straight && rubbing_.empty()) return;
    change = std::max(change, follow_pressure(i < 2));
    if (i == 0 && change <= negligible && curvature_.largest(second_order_) <= negligible) break;
    // If other rows would have to act, the next round finds them.
    if (!refine()) break;
    bend_ = motion_;
    bent_ = true;
    for (const Rubbing& rubbing : rubbing_) {
      Row& row = rows_[at(rubbing.row)];
      row.upper = rubbing.bound / bound_share_;
      row.lower = -row.upper;
    }
    whole = std::max(whole, change);
    // One or two more turns cost less than a round, and are done if the change becomes negligible
    // with them.
    const bool near = before > 0.0 && change * std::sqrt(change / before) <= negligible;
    if (change <= negligible || (change <= settled_share * whole && !near)) return;
    before = change;
  }
  for (Rubbing& rubbing : rubbing_) {
    rubbing.bound = rubbing.last_bound;
    set_friction(rubbing, at(group_of_[at(rubbing.row)]));
  }
}

}  // namespace sheave
