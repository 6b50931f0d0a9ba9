#include "engine/contacts/held_rows.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/solvers/direct.h"

namespace sheave {
namespace {

/// Sweeps from row to row converge slowly where a small body turns about a far joint, by 1/1000 per
/// sweep. So bilateral rows are solved all at once, up to this number.
constexpr std::size_t most_factored = 200;
/// A pivot below this share of its row's effective inverse mass is rounding.
constexpr double redundant = 1e-10;

}  // namespace

double velocity_along(const Substep& substep, const Row& row) {
  double velocity = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    if (term.body == substep.bodies.count()) continue;  // the world
    const BodyState& body = substep.next.bodies[at(term.body)];
    velocity += dot(term.linear, body.velocity) + dot(term.angular, body.angular_velocity);
  }
  return velocity;
}

void push(Substep& substep, const Row& row, const RowResponse& response, double impulse) {
  for (std::size_t t = 0; t < at(row.term_count); ++t) {
    const MovingBody& moving = substep.moving[at(row.terms[t].body)];
    if (!moving.translates && !moving.rotates) continue;
    BodyState& body = substep.next.bodies[at(row.terms[t].body)];
    if (moving.translates) body.velocity += impulse * response.linear[t];
    if (moving.rotates) body.angular_velocity += impulse * response.angular[t];
  }
}

std::span<const char> HeldRows::bodies(Substep& substep,
                                       std::span<const std::unique_ptr<ConstraintBatch>> features,
                                       const ConstraintBatch& own) {
  bodies_.assign(at(substep.bodies.count()) + 1, 0);
  rows_.clear();
  for (const auto& feature : features) {
    if (feature.get() != &own) feature->linearise(substep, rows_);
  }
  for (const Row& row : rows_) {
    for (const RowTerm& term : row.active_terms()) {
      const MovingBody& body = substep.moving[at(term.body)];
      if (body.translates || body.rotates) bodies_[at(term.body)] = 1;
    }
  }
  return bodies_;
}

void HeldRows::collect(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features,
                       const ConstraintBatch& own, bool at_instant) {
  rows_.clear();
  groups_.clear();
  at_instant_ = at_instant;
  closed_ = DirectSolver::closed * substep.bodies.scale();
  for (std::size_t f = 0; f < features.size(); ++f) {
    if (features[f].get() == &own) continue;
    std::size_t first = rows_.size();
    features[f]->linearise(substep, rows_);
    const std::span<const double> multipliers = features[f]->multipliers();
    while (first < rows_.size()) {
      std::size_t end = first + 1;
      while (end < rows_.size() && rows_[end].tied) ++end;
      add(f, multipliers, first, end - first);
      first = end;
    }
  }
  responses_.resize(rows_.size());
  for (Group& group : groups_) {
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      respond(rows_[i], substep.moving, responses_[i]);
    }
    find_yield(substep, group);
  }
  std::erase_if(groups_, [](const Group& group) { return !(group.yield > 0.0); });
  factor(substep);
}

void HeldRows::add(std::size_t feature, std::span<const double> multipliers, std::size_t first,
                   std::size_t count) {
  const Row& row = rows_[first];
  if (row.friction > 0.0 || row.lower == row.upper || row.idle) return;
  for (std::size_t i = first; i < first + count; ++i) {
    if (rows_[i].compliance > 0.0) return;
  }
  const double multiplier = multipliers[at(row.index)] / row.weight;
  if (at_instant_) {
    add_at_instant(feature, multiplier, first, count);
    return;
  }
  const bool one_sided = row.lower == 0.0 || row.upper == 0.0;
  if (one_sided && multiplier == 0.0) return;
  groups_.push_back({feature, first, count, 0.0, 0.0, 0.0, multiplier, multiplier});
}

void HeldRows::add_at_instant(std::size_t feature, double multiplier, std::size_t first,
                              std::size_t count) {
  const Row& row = rows_[first];
  if (std::isfinite(row.lower) && std::isfinite(row.upper)) return;
  double value = 0.0;
  for (std::size_t i = first; i < first + count; ++i) value += rows_[i].value;
  const bool one_sided = std::isfinite(row.lower) || std::isfinite(row.upper);
  const double beyond = std::isfinite(row.lower) ? value : -value;
  if (one_sided && multiplier == 0.0 && beyond * row.lever > closed_) return;
  groups_.push_back({feature, first, count});
}

double HeldRows::velocity_of(const Substep& substep, const Group& group) const {
  double velocity = 0.0;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    velocity += velocity_along(substep, rows_[i]);
  }
  return velocity;
}

double HeldRows::rate_of(const Substep& substep, const Group& group) const {
  double rate = velocity_of(substep, group);
  if (rows_[group.first].inertial) {
    return rate - group.start + group.inertia * (group.multiplier - group.before) / substep.h;
  }
  for (std::size_t i = group.first; i < group.first + group.count; ++i) rate += rows_[i].rate;
  return rate;
}

void HeldRows::push_along(Substep& substep, const Group& group, double impulse) const {
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    push(substep, rows_[i], responses_[i], rows_[i].weight * impulse);
  }
}

void HeldRows::find_yield(Substep& substep, Group& group) {
  if (group.count == 1) {
    group.yield = rows_[group.first].weight * responses_[group.first].inverse_mass;
    if (rows_[group.first].inertial) {
      group.inertia = rows_[group.first].softness;
      group.yield += group.inertia;
      group.start = velocity_of(substep, group);
    }
    return;
  }
  // The rows of a group may touch the same bodies, so their gradients are not apart.
  kept_ = substep.next.bodies;
  for (BodyState& body : substep.next.bodies) {
    body.velocity = body.angular_velocity = Vector3::Zero();
  }
  push_along(substep, group, 1.0);
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    group.yield += velocity_along(substep, rows_[i]);
  }
  std::swap(kept_, substep.next.bodies);
}

bool HeldRows::is_bilateral(const Group& group) const {
  return !std::isfinite(rows_[group.first].lower) && !std::isfinite(rows_[group.first].upper);
}

void HeldRows::factor(Substep& substep) {
  bilateral_.clear();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (is_bilateral(groups_[g])) bilateral_.push_back(g);
  }
  if (bilateral_.size() > most_factored) bilateral_.clear();
  const std::size_t count = bilateral_.size();
  factor_.assign(count * count, 0.0);
  solution_.assign(count, 0.0);
  kept_ = substep.next.bodies;
  for (std::size_t j = 0; j < count; ++j) {
    for (BodyState& body : substep.next.bodies) {
      body.velocity = body.angular_velocity = Vector3::Zero();
    }
    push_along(substep, groups_[bilateral_[j]], 1.0);
    for (std::size_t i = j; i < count; ++i) {
      factor_[i * count + j] = velocity_of(substep, groups_[bilateral_[i]]);
    }
  }
  std::swap(kept_, substep.next.bodies);
  for (std::size_t j = 0; j < count; ++j) {
    factor_[j * count + j] += groups_[bilateral_[j]].inertia;
  }
  // L D L^T, with D on the diagonal. Without square roots the bits are the same in units of powers of two. A pivot of rounding
  // belongs to a redundant row, which takes no impulse.
  const auto pivot_of = [&](std::size_t k) { return factor_[k * count + k]; };
  for (std::size_t j = 0; j < count; ++j) {
    double pivot = pivot_of(j);
    const double least = redundant * pivot;
    for (std::size_t k = 0; k < j; ++k) {
      pivot -= factor_[j * count + k] * factor_[j * count + k] * pivot_of(k);
    }
    if (!(pivot > least)) pivot = 0.0;
    factor_[j * count + j] = pivot;
    for (std::size_t i = j + 1; i < count; ++i) {
      double& entry = factor_[i * count + j];
      for (std::size_t k = 0; k < j; ++k) {
        entry -= factor_[i * count + k] * factor_[j * count + k] * pivot_of(k);
      }
      entry = pivot > 0.0 ? entry / pivot : 0.0;
    }
  }
}

double HeldRows::stop_bilateral(Substep& substep) {
  const std::size_t count = bilateral_.size();
  for (std::size_t i = 0; i < count; ++i) {
    double value = -rate_of(substep, groups_[bilateral_[i]]);
    for (std::size_t k = 0; k < i; ++k) value -= factor_[i * count + k] * solution_[k];
    solution_[i] = value;
  }
  double change = 0.0;
  for (std::size_t i = count; i-- > 0;) {
    const double pivot = factor_[i * count + i];
    double value = pivot > 0.0 ? solution_[i] / pivot : 0.0;
    for (std::size_t k = i + 1; k < count; ++k) value -= factor_[k * count + i] * solution_[k];
    solution_[i] = pivot > 0.0 ? value : 0.0;
    Group& group = groups_[bilateral_[i]];
    group.multiplier += substep.h * solution_[i];
    push_along(substep, group, solution_[i]);
    change = std::max(change, std::abs(solution_[i]) * group.yield * rows_[group.first].lever);
  }
  return change;
}

double HeldRows::sweep(Substep& substep) {
  double change = stop_bilateral(substep);
  for (Group& group : groups_) {
    if (!bilateral_.empty() && is_bilateral(group)) continue;
    const Row& first = rows_[group.first];
    const double wanted = group.multiplier - substep.h * rate_of(substep, group) / group.yield;
    const double next = std::clamp(wanted, first.lower, first.upper);
    const double impulse = (next - group.multiplier) / substep.h;
    group.multiplier = next;
    push_along(substep, group, impulse);
    change = std::max(change, std::abs(impulse) * group.yield * first.lever);
  }
  return change;
}

void HeldRows::restore() {
  for (Group& group : groups_) group.multiplier = group.before;
}

void HeldRows::keep_late(Substep& substep) const {
  const double square = substep.h * substep.h;
  for (const Group& group : groups_) {
    std::vector<double>& late = substep.late_forces[group.feature];
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      late[at(rows_[i].index)] += rows_[i].weight * (group.multiplier - group.before) / square;
    }
  }
}

void HeldRows::keep(std::span<const std::unique_ptr<ConstraintBatch>> features) const {
  for (const Group& group : groups_) {
    const std::span<double> multipliers = features[group.feature]->multipliers();
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      multipliers[at(rows_[i].index)] += rows_[i].weight * (group.multiplier - group.before);
    }
  }
}

}  // namespace sheave
