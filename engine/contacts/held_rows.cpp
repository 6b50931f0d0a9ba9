#include "engine/contacts/held_rows.h"

#include <algorithm>
#include <cmath>

#include "engine/index.h"

namespace sheave {

double velocity_along(const Substep& substep, const Row& row) {
  double velocity = 0.0;
  for (const RowTerm& term : row.active_terms()) {
    const BodyState& body = substep.next.bodies[at(term.body)];
    velocity += dot(term.linear, body.velocity) + dot(term.angular, body.angular_velocity);
  }
  return velocity;
}

void push(Substep& substep, const Row& row, const RowResponse& response, double impulse) {
  for (std::size_t t = 0; t < at(row.term_count); ++t) {
    const MovingBody& moving = substep.moving[at(row.terms[t].body)];
    BodyState& body = substep.next.bodies[at(row.terms[t].body)];
    if (moving.translates) body.velocity += impulse * response.linear[t];
    if (moving.rotates) body.angular_velocity += impulse * response.angular[t];
  }
}

void HeldRows::collect(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features,
                       const ConstraintBatch& own) {
  rows_.clear();
  groups_.clear();
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
}

void HeldRows::add(std::size_t feature, std::span<const double> multipliers, std::size_t first,
                   std::size_t count) {
  const Row& row = rows_[first];
  if (row.friction > 0.0 || row.lower == row.upper || row.idle) return;
  for (std::size_t i = first; i < first + count; ++i) {
    if (rows_[i].compliance > 0.0) return;
  }
  const double multiplier = multipliers[at(row.index)] / row.weight;
  const bool one_sided = row.lower == 0.0 || row.upper == 0.0;
  if (one_sided && multiplier == 0.0) return;
  groups_.push_back({feature, first, count, 0.0, multiplier, multiplier});
}

double HeldRows::rate_of(const Substep& substep, const Group& group) const {
  double rate = 0.0;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    rate += velocity_along(substep, rows_[i]) + rows_[i].rate;
  }
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

double HeldRows::sweep(Substep& substep) {
  double change = 0.0;
  for (Group& group : groups_) {
    const Row& first = rows_[group.first];
    const double wanted = group.multiplier - substep.h * rate_of(substep, group) / group.yield;
    const double next = std::clamp(wanted, first.lower, first.upper);
    const double impulse = (next - group.multiplier) / substep.h;
    group.multiplier = next;
    push_along(substep, group, impulse);
    change = std::max(change, std::abs(impulse) * group.yield);
  }
  return change;
}

void HeldRows::restore() {
  for (Group& group : groups_) group.multiplier = group.before;
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
