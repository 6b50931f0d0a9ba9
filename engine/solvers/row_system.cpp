#include "engine/solvers/row_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/index.h"

namespace sheave {

void RowSystem::collect_rows(Substep& substep, Features features) {
  rows_.clear();
  feature_rows_.clear();
  has_all_rows_ = true;
  for (const auto& feature : features) {
    has_all_rows_ = has_all_rows_ && feature->has_all_rows();
    feature_rows_.push_back(static_cast<int>(rows_.size()));
    feature->linearise(substep, rows_);
  }
  if (!(rounding_ > 0.0)) find_rounding(substep, features);
  if (geometry_alone_) leave_geometry_alone();
  feature_rows_.push_back(static_cast<int>(rows_.size()));
  previous_.resize(rows_.size());
  std::size_t shared = 0;
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<const double> multipliers = features[f]->multipliers();
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      previous_[at(i)] = multipliers[at(rows_[at(i)].index)];
      if (rows_[at(i)].shares > 1) note_shared(f, i, shared++);
    }
  }
  shared_.resize(shared);
  if (shared > 0) follow_slip(substep);
}

void RowSystem::find_rounding(const Substep& substep, Features features) {
  double longest = substep.bodies.scale();
  for (const auto& feature : features) longest = std::max(longest, feature->longest());
  rounding_ = value_rounding * longest;
}

bool RowSystem::linearise(Substep& substep, Features features, Rule rule, bool from_here) {
  bound_share_ = rule == Rule::backward ? 1.0 : 0.5;
  collect_rows(substep, features);
  problem_.rounding = rounding_;
  symmetric_rows_ = forces_turn_ = rule == Rule::backward;
  if (rule == Rule::midpoint && !match_values()) return false;
  fill_slots(substep);
  if (rule == Rule::midpoint && !match_gradients()) return false;
  slots_.join(rows_);
  pose_values(substep, rule);
  from_here_ = from_here;
  if (from_here) {
    remember_origin(substep);
  } else {
    settle(substep);
  }
  bent_ = false;
  return true;
}

bool RowSystem::look(Substep& substep, Features features) {
  if (!shared_.empty() || turns_contacts_) return false;
  collect_rows(substep, features);
  if (!shared_.empty() || static_cast<int>(rows_.size()) != slots_.row_count()) return false;
  if (!match_values()) return false;
  pose_values(substep, Rule::midpoint);
  return true;
}

bool RowSystem::look_closer(const Substep& substep) {
  fill_slots(substep);
  if (!match_gradients()) return false;
  slots_.join(rows_);
  settle(substep);
  bent_ = false;
  return true;
}

void RowSystem::pose_values(const Substep& substep, Rule rule) {
  make_groups();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].row_count == 1 && !groups_[g].elastic) {
      set_rigid(g);
    } else if (rule == Rule::backward) {
      set_backward(substep, g);
    } else {
      set_midpoint(substep, g);
    }
  }
  recall_sides();
  if (!shared_.empty()) set_slipping_sides();
}

bool RowSystem::is_pushed(const Row& row, double value) const {
  // A cable that is just taut counts. Otherwise the spans of a long cable at rest would become taut
  // one by one, each in a round of its own.
  return (std::isfinite(row.lower) ? value : -value) * row.lever <= problem_.rounding;
}

void RowSystem::set_bounds(std::size_t g, bool pushed, bool active) {
  const Group& group = groups_[g];
  const Row& first = rows_[at(group.first_row)];
  if (first.lower == 0.0 && first.upper == Row::unbounded) {  // most rows of cables
    problem_.lower[g] = -group.multiplier;
    problem_.upper[g] = Row::unbounded;
    problem_.free[g] = active || pushed || group.multiplier != 0.0 ? 1 : 0;
    return;
  }
  problem_.lower[g] = bound_share_ * first.lower - group.multiplier;
  problem_.upper[g] = bound_share_ * first.upper - group.multiplier;
  const bool bilateral = !std::isfinite(first.lower) && !std::isfinite(first.upper);
  // A prescribed multiplier (a force) is never an unknown.
  const bool given = first.lower == first.upper;
  problem_.free[g] = !given && (bilateral || active || pushed || group.multiplier != 0.0) ? 1 : 0;
}

void RowSystem::set_rigid(std::size_t g) {
  const Group& group = groups_[g];
  const Row& row = rows_[at(group.first_row)];
  problem_.diagonal[g] = row.softness;
  problem_.constant[g] = row.value + row.softness * group.multiplier;
  set_bounds(g, is_pushed(row, row.value), row.active);
}

void RowSystem::remember_origin(const Substep& substep) {
  origin_.resize(substep.moving.size());
  for (std::size_t b = 0; b < origin_.size(); ++b) {
    const MovingBody& body = substep.moving[b];
    origin_[b] = {body.position, body.turn};
  }
}

void RowSystem::linearise_among_others(Substep& substep, Features features, bool first_round) {
  if (first_round) begin_rounds();
  if (!first_round) {
    for (std::size_t b = 0; b < placed_.size(); ++b) {
      const MovingBody& body = substep.moving[b];
      origin_[b].position += body.position - placed_[b].position;
      origin_[b].turn += body.turn - placed_[b].turn;
    }
  }
  linearise(substep, features, Rule::backward, first_round);
  remember_places(substep);
}

void RowSystem::remember_places(const Substep& substep) {
  placed_.resize(substep.moving.size());
  for (std::size_t b = 0; b < placed_.size(); ++b) {
    const MovingBody& body = substep.moving[b];
    placed_[b] = {body.position, body.turn};
  }
}

void RowSystem::settle(const Substep& substep) {
  // Motion from the present places to those that follow from the present multipliers and gradients.
  const Coordinates& coordinates = substep.bodies.coordinates();
  motion_.assign(at(coordinates.count()), 0.0);
  for (const BodyFreedom& freedom : coordinates.movable()) {
    const MovingBody& body = substep.moving[at(freedom.body)];
    const Pose& from = origin_[at(freedom.body)];
    project(freedom, body, from.position - body.position, from.turn - body.turn,
            &motion_[at(freedom.first)]);
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double multiplier = groups_[g].multiplier;
    if (multiplier != 0.0) slots_.add_unknown(static_cast<int>(g), multiplier, motion_.data());
  }
  count_motion();
}

void RowSystem::follow_gradients(Substep& substep) const {
  constexpr double negligible_turn = 1e-12;  // a hundredth of the residual of rounds
  for (const BodyFreedom& freedom : substep.bodies.coordinates().movable()) {
    MovingBody& body = substep.moving[at(freedom.body)];
    const double* motion = &motion_[at(freedom.first)];
    body.position += linear_motion(freedom, motion);
    const Vector3 turn = angular_motion(freedom, body, motion);
    if (turn.cwiseAbs().maxCoeff() > negligible_turn) body.rotate(turn);
  }
}

double RowSystem::violation() const {
  double worst = 0.0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double r = problem_.constant[g];
    // The check comes before the bounds, because no round repairs a value that is not finite.
    if (!std::isfinite(r)) return std::numeric_limits<double>::infinity();
    // A residual counts only as far as the bounds leave room for a correction. Friction that slips
    // and a force that has just ended are no violation, although bounds that follow other forces
    // have moved a little.
    const double room = r > 0.0 ? -problem_.lower[g] : problem_.upper[g];
    // An unknown beyond its bounds, which have moved since its solution, causes motion that the
    // bounds forbid.
    const double excess = std::max(problem_.lower[g], -problem_.upper[g]);
    if (excess > 0.0) {
      worst = std::max(worst, excess * yield(g) * groups_[g].lever / groups_[g].scale);
    }
    if (!(room > 0.0)) continue;
    const double lever = groups_[g].lever;
    double off = std::abs(r) * lever;
    if (!(off > worst * groups_[g].scale)) continue;
    if (std::isfinite(room)) off = std::min(off, room * yield(g) * lever);
    // No further round and no shorter substep repairs a row to which no body yields.
    if (off > worst * groups_[g].scale && yield(g) > 0.0) worst = off / groups_[g].scale;
  }
  if (!shared_.empty()) worst = std::max(worst, excess_friction());
  return worst;
}

double RowSystem::displacement(double violation) const {
  const auto is_elastic = [](const Group& group) { return group.elastic; };
  if (std::none_of(groups_.begin(), groups_.end(), is_elastic)) return violation;
  double worst = shared_.empty() ? 0.0 : excess_friction();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double r = problem_.constant[g];
    if (!std::isfinite(r)) return std::numeric_limits<double>::infinity();
    const double excess = std::max(problem_.lower[g], -problem_.upper[g]);
    const double room = r > 0.0 ? -problem_.lower[g] : problem_.upper[g];
    const double off = room > 0.0 ? std::abs(r) : 0.0;
    if (!(off * groups_[g].lever > worst) && !(excess > 0.0)) continue;
    const double whole = yield(g);
    if (!(whole > 0.0)) continue;
    const double unknown = std::max(std::min(off / whole, room), excess);
    worst = std::max(worst, unknown * (whole - problem_.diagonal[g]) * groups_[g].lever);
  }
  return worst;
}

void RowSystem::remember_sides(Features features) {
  knows_sides_ = true;
  sides_.resize(features.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    sides_[f].assign(features[f]->multipliers().size(), -1);
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      sides_[f][at(rows_[at(i)].index)] = problem_.free[at(group_of_[at(i)])];
    }
  }
}

void RowSystem::recall_sides() {
  if (!knows_sides_) return;
  for (std::size_t f = 0; f < sides_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const char side = sides_[f][at(rows_[at(i)].index)];
      const std::size_t g = at(group_of_[at(i)]);
      // A prescribed multiplier (friction without pressure) has no side.
      if (side >= 0 && problem_.lower[g] != problem_.upper[g]) problem_.free[g] = side;
    }
  }
}

void RowSystem::apply(Substep& substep, Features features) {
  remember_sides(features);
  const Coordinates& coordinates = substep.bodies.coordinates();
  motion_.assign(at(coordinates.count()), 0.0);
  const std::span<const double> change = active_set_.solution();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const std::span<double> multipliers = features[f]->multipliers();
    for (int r = feature_rows_[f]; r < feature_rows_[f + 1]; ++r) {
      const auto i = at(r);
      const auto g = at(group_of_[i]);
      const Row& first = rows_[at(groups_[g].first_row)];
      const double unknown = std::clamp(groups_[g].multiplier + change[g],
                                        bound_share_ * first.lower, bound_share_ * first.upper);
      const double multiplier = rows_[i].weight * unknown;
      multipliers[at(rows_[i].index)] = multiplier;
      const double gain = from_here_ ? multiplier - previous_[i] : multiplier;
      if (gain != 0.0) slots_.add_row(r, gain, motion_.data());
    }
  }
  note_new_pressure(substep);
  for (const SharedFriction& friction : shared_) {
    if (friction.turned) turn_back(friction, features[friction.feature]->multipliers());
  }
  if (bent_) {
    for (std::size_t d = 0; d < motion_.size(); ++d) motion_[d] += bend_[d];
  }
  for (const BodyFreedom& freedom : coordinates.movable()) {
    MovingBody& body = substep.moving[at(freedom.body)];
    const Pose& from = origin_[at(freedom.body)];
    const double* motion = &motion_[at(freedom.first)];
    if (body.translates) body.position = from.position + linear_motion(freedom, motion);
    if (body.rotates) {
      body.rotate_to(from.turn + angular_motion(freedom, body, motion));
    }
  }
}

}  // namespace sheave
