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

double RowSystem::most_second_order() {
  trial_ = motion_;
  const std::span<const double> change = active_set_.solution();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (change[g] != 0.0) slots_.add_unknown(static_cast<int>(g), change[g], trial_.data());
  }
  double way = 0.0;
  double turn = 0.0;
  for (std::size_t d = 0; d < trial_.size(); ++d) {
    double& most = turns_[d] != 0 ? turn : way;
    most = std::max(most, std::abs(trial_[d]));
  }
  double largest = 0.0;
  for (const Row& row : rows_) {
    if (!row.curved || row.source != nullptr) continue;
    double moved = 0.0;
    double about = 0.0;
    for (const RowTerm& term : row.active_terms()) {
      const double arm = std::abs(term.reach) + term.angular.lpNorm<1>();
      moved += 2.0 * way + arm * turn;
      about += arm * turn * turn;
    }
    largest = std::max(largest, row.turning * moved * moved + about);
  }
  return largest;
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

bool RowSystem::refine(bool last) {
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
  return active_set_.refine(problem_, change_, last);
}

double RowSystem::left_out(const Substep& substep) const {
  // Derivatives tell nothing of a motion out of all measure. The comparison also refuses NaN.
  double whole = 0.0;
  for (std::size_t d = 0; d < trial_.size(); ++d) whole += std::abs(trial_[d]) * levers_[d];
  if (!(whole <= substep.bodies.scale())) return std::numeric_limits<double>::infinity();
  // The second turn of the values and of the forces.
  double most = std::max(curvature_.largest_part(), longest(motion_)) * curvature_.largest_turn();
  // Rotations in space do not commute: a correction that follows another one turns a body by half
  // of their product less, or more, than their sum (MovingBody::rotate()).
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    if (freedom.kind != Freedom::space) continue;
    const MovingBody& body = substep.moving[at(freedom.body)];
    const double* const own = &trial_[at(freedom.first)];
    const Vector3 turn = angular_motion(freedom, body, own);
    const double product = 0.5 * (body.turn - body.free_turn).norm() * turn.norm();
    most = std::max(most, product * levers_[at(freedom.first) + 3]);
  }
  return most;
}

bool RowSystem::bend(const Substep& substep, double negligible) {
  constexpr int most_turns = 12;
  constexpr double settled_share = 1e-2;  // a round leaves an error of about this share anyway
  // Rows that depend on each other need not have the same second-order terms. A load that they
  // share would follow from the difference of these terms, and stay.
  if (from_here_ || (shares_load_ && shares_judged_)) return false;
  find_rubbing_rows();
  if (!forces_turn_ && rubbing_.empty() && most_second_order() <= 0.1 * negligible) return false;
  const bool curved = curvature_.collect(rows_, substep.bodies.coordinates(), substep.moving);
  const bool tells =
      may_end_first(substep) && rubbing_.empty() && !shares_load_ && !active_set_.contradicts();
  if (!curved && rubbing_.empty()) return tells;
  begin_bending();
  // No further round follows on a good guess, so rows are to be satisfied more exactly.
  const double residual = (may_end_first(substep) ? 0.1 : 1.0) * negligible;
  constant_ = problem_.constant;
  double before = 0.0;
  double whole = 0.0;
  for (int i = 0; i < most_turns; ++i) {
    find_motion();
    if (i == 0 && rubbing_.empty()) before = longest(trial_);
    bool straight = false;
    double change = turn_forces(substep, straight);
    if (straight && rubbing_.empty()) return false;
    change = std::max(change, follow_pressure(i < 2));
    const bool tells_all = tells && left_out(substep) <= negligible;
    if (i == 0 && change <= negligible && curvature_.largest(second_order_) <= residual) {
      if (rubbing_.empty()) return tells_all;
      break;
    }
    whole = std::max(whole, change);
    // One or two more turns cost less than a round, and are done if the change becomes negligible
    // with them.
    const bool near = before > 0.0 && change * std::sqrt(change / before) <= negligible;
    // Turns contract, and the last two tell the factor. The next change is thus known to be
    // negligible without computing it. Bounds of friction contract otherwise.
    const double factor = before > 0.0 && rubbing_.empty() ? change / before : 1.0;
    const bool enough = change <= negligible || change * factor <= negligible;
    const bool last = enough || (!tells && change <= settled_share * whole && !near);
    // If other rows would have to act, the next round finds them.
    if (!refine(last)) break;
    bend_ = motion_;
    bent_ = true;
    for (const Rubbing& rubbing : rubbing_) {
      Row& row = rows_[at(rubbing.row)];
      row.upper = rubbing.bound / bound_share_;
      row.lower = -row.upper;
    }
    if (enough) return tells_all;
    if (last) return false;
    before = change;
  }
  for (Rubbing& rubbing : rubbing_) {
    rubbing.bound = rubbing.last_bound;
    set_friction(rubbing, at(group_of_[at(rubbing.row)]));
  }
  return false;
}

}  // namespace sheave
