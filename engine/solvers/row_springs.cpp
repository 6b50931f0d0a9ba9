// Springs and dampers in the equations of positions: engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {

bool RowSystem::damps_apart(const Group& group) const {
  if (group.row_count == 1 || !group.elastic) return false;
  const auto first = rows_.begin() + group.first_row;
  return std::any_of(first, first + group.row_count,
                     [](const Row& row) { return row.compliance > 0.0 && row.damping > 0.0; });
}

void RowSystem::set_backward(const Substep& substep, std::size_t g) {
  Group& group = groups_[g];
  const Row& first = rows_[at(group.first_row)];
  const bool apart = damps_apart(group);
  const double gamma = group.row_count == 1 ? first.compliance * first.damping / substep.h : 0.0;
  double value = 0.0;
  double compliance = 0.0;
  bool active = false;
  for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
    const Row& row = rows_[at(i)];
    double soft = row.compliance / (substep.h * substep.h);
    value += row.value;
    if (gamma > 0.0) value += gamma * damped_change(row, substep.moving);
    if (apart) {
      const double own = row.compliance * row.damping / substep.h;
      value -= own / (1.0 + own) * row.past;
      soft /= 1.0 + own;
    }
    compliance += row.weight * (soft + row.softness);
    active = active || row.active;
  }
  group.scale = 1.0 / (1.0 + gamma);
  problem_.diagonal[g] = group.scale * compliance;
  problem_.constant[g] = group.scale * (value + compliance * group.multiplier);
  set_bounds(g, is_pushed(first, value), active);
}

double RowSystem::start_of(int index) const {
  const Row& row = rows_[at(index)];
  const auto& [value, compliance] = starts_[at(index)];
  // If the compliance has changed in the substep, the scaled value gives the mean of the forces,
  // F = (F0 + F1) / 2. A gap has no force.
  const bool gap = (row.lower == 0.0 && value > 0.0) || (row.upper == 0.0 && value < 0.0);
  if (gap || row.compliance == compliance || !(compliance > 0.0)) return value;
  return value * (row.compliance / compliance);
}

void RowSystem::set_midpoint(const Substep& substep, std::size_t g) {
  Group& group = groups_[g];
  const Row& first = rows_[at(group.first_row)];
  if (const auto spring = crossing_of(substep, group)) return set_crossing(substep, g, *spring);
  const bool apart = damps_apart(group);
  const double gamma =
      group.row_count == 1 ? 2.0 * (first.compliance * first.damping) / substep.h : 0.0;
  double value = 0.0;
  double start = 0.0;
  double compliance = 0.0;
  double softness = 0.0;
  bool active = false;
  for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
    const Row& row = rows_[at(i)];
    double share = row.weight * row.compliance * 4.0 / (substep.h * substep.h);
    value += row.value;
    if (apart) {
      const double own = 2.0 * row.compliance * row.damping / substep.h;
      start += (1.0 - own) / (1.0 + own) * row.past;
      share /= 1.0 + own;
    } else {
      start += start_of(i);
    }
    compliance += share;
    softness += row.weight * row.softness;
    active = active || row.active;
  }
  if (!apart && first.lower == 0.0) start = std::min(start, 0.0);
  if (!apart && first.upper == 0.0) start = std::max(start, 0.0);
  if (compliance > 0.0) value = (1.0 + gamma) * value + (1.0 - gamma) * start;
  group.scale = 1.0 / (1.0 + gamma);
  compliance += softness;
  problem_.diagonal[g] = group.scale * compliance;
  problem_.constant[g] = group.scale * (value + compliance * group.multiplier);
  set_bounds(g, is_pushed(first, value), active);
}

bool RowProblem::bounds_friction(const Group& group) const {
  const auto next = at(group.first_row + group.row_count);
  return next < rows_.size() && rows_[next].pressed_by == 1;
}

std::optional<RowSystem::Crossing> RowSystem::crossing_of(const Substep& substep,
                                                          const Group& group) const {
  const Row& first = rows_[at(group.first_row)];
  const bool pulls = first.lower == 0.0;
  if (!group.elastic || pulls == (first.upper == 0.0) || bounds_friction(group)) return {};
  const double damping = 2.0 * (first.compliance * first.damping) / substep.h;
  if (group.row_count > 1 ? damping > 0.0 : first.judged) return {};
  const double sign = pulls ? 1.0 : -1.0;
  Crossing sum;
  sum.damping = damping;
  double first_compliance = 0.0;
  for (int i = group.first_row; i < group.first_row + group.row_count; ++i) {
    const Row& row = rows_[at(i)];
    sum.start += sign * starts_[at(i)].value;
    sum.end += sign * row.value;
    sum.compliance += row.weight * row.compliance;
    first_compliance += row.weight * starts_[at(i)].compliance;
    sum.softness += row.weight * row.softness;
    sum.active = sum.active || row.active;
  }
  if ((sum.start < 0.0) == (sum.end < 0.0)) return {};
  if (sum.start < 0.0 && first_compliance > 0.0) sum.compliance = first_compliance;
  return sum;
}

void RowSystem::set_crossing(const Substep& substep, std::size_t g, const Crossing& spring) {
  const double apart = std::abs(spring.end - spring.start);
  double force = 0.0;  // times 2 a
  double slope = 0.0;  // its decrease per value
  if (spring.start < 0.0) {
    force = spring.start * (spring.start / apart) + spring.damping * spring.start;
    slope = (spring.start / apart) * (spring.start / apart);
  } else {
    force = spring.end * (spring.end / apart) - spring.damping * spring.end;
    slope = -(spring.end / apart) * ((spring.start + apart) / apart) + spring.damping;
  }
  constexpr double least_slope = 1e-9;  // of a spring that barely presses; a smaller step is safe
  const double stretch = 1.0 / std::max(slope, least_slope);
  const Row& first = rows_[at(groups_[g].first_row)];
  const double value = (first.lower == 0.0 ? -stretch : stretch) * force;
  groups_[g].scale = 1.0;
  problem_.diagonal[g] =
      stretch * spring.compliance * 4.0 / (substep.h * substep.h) + spring.softness;
  problem_.constant[g] = value + problem_.diagonal[g] * groups_[g].multiplier;
  told_ = false;
  set_bounds(g, is_pushed(first, value), spring.active);
}

}  // namespace sheave
