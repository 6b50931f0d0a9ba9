// Springs and dampers in the equations of positions: engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>

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

void RowSystem::set_midpoint(const Substep& substep, std::size_t g) {
  Group& group = groups_[g];
  const Row& first = rows_[at(group.first_row)];
  if (group.row_count == 1 && crosses(at(group.first_row))) return set_crossing(substep, g);
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
      start += start_values_[at(i)];
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

bool RowSystem::crosses(std::size_t index) const {
  const Row& row = rows_[index];
  const double start = start_values_[index];
  const bool rubs = index + 1 < rows_.size() && rows_[index + 1].pressed_by == 1;
  if (!(row.compliance > 0.0) || row.judged || rubs) return false;
  if (row.lower == 0.0) return (start < 0.0) != (row.value < 0.0);
  return row.upper == 0.0 && (start > 0.0) != (row.value > 0.0);
}

void RowSystem::set_crossing(const Substep& substep, std::size_t g) {
  const auto index = at(groups_[g].first_row);
  const Row& row = rows_[index];
  const double sign = row.lower == 0.0 ? 1.0 : -1.0;
  const double start = sign * start_values_[index];
  const double end = sign * row.value;
  const double apart = std::abs(end - start);
  const double gamma = 2.0 * (row.compliance * row.damping) / substep.h;
  double force = 0.0;  // times 2 a
  double slope = 0.0;  // its decrease per value
  if (start < 0.0) {
    force = start * (start / apart) + gamma * start;
    slope = (start / apart) * (start / apart);
  } else {
    force = end * (end / apart) - gamma * end;
    slope = -(end / apart) * ((start + apart) / apart) + gamma;
  }
  constexpr double least_slope = 1e-9;  // of a spring that barely presses; a smaller step is safe
  const double stretch = 1.0 / std::max(slope, least_slope);
  const double value = -sign * stretch * force;
  groups_[g].scale = 1.0;
  problem_.diagonal[g] = stretch * row.compliance * 4.0 / (substep.h * substep.h) + row.softness;
  problem_.constant[g] = value + problem_.diagonal[g] * groups_[g].multiplier;
  told_ = false;
  set_bounds(g, is_pushed(row, value), row.active);
}

}  // namespace sheave
