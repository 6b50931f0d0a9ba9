// Parts of the descent to the least violation: engine/solvers/least_violation.h.

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {

void RowSystem::leave_geometry_alone() {
  for (Row& row : rows_) {
    const bool yields = std::isfinite(row.lower) && std::isfinite(row.upper);
    if (!yields && row.weight == 1.0) continue;
    row.source = nullptr;  // the changed row is no copy of its source
    row.weight = row.start_weight = 1.0;
    if (!yields) continue;
    row.lower = row.upper = row.friction = 0.0;
    row.shares = row.pressed_by = row.pressed_also = 0;
  }
}

void RowSystem::begin_lessening(Substep& substep, Features features, bool geometry_alone) {
  geometry_alone_ = geometry_alone;
  origin_ = prediction_;
  start_again(substep, features);
  weights_.resize(features.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    weights_[f].assign(features[f]->multipliers().size(), 0.0);
  }
}

double RowSystem::misfit(const Substep& substep) {
  assemble();
  damping_ = 0.0;
  weight_.resize(groups_.size());
  double sum = 0.0;
  for (std::size_t f = 0; f + 1 < feature_rows_.size(); ++f) {
    for (int i = feature_rows_[f]; i < feature_rows_[f + 1]; ++i) {
      const auto g = at(group_of_[at(i)]);
      if (groups_[g].first_row != i) continue;
      double& weight = weights_[f][at(rows_[at(i)].index)];
      double whole = problem_.diagonal[g];
      for (int j = i; j < i + groups_[g].row_count; ++j) {
        for (const RowTerm& term : rows_[at(j)].active_terms()) {
          const MovingBody& body = substep.moving[at(term.body)];
          whole += body.linear_yield * dot(term.linear, term.linear) +
                   body.angular_yield * dot(term.angular, term.angular);
        }
      }
      weight = std::max(weight, whole);
      weight_[g] = weight;
      const double r = problem_.constant[g];
      const double room = r > 0.0 ? -problem_.lower[g] : problem_.upper[g];
      if (!(room > 0.0) || !(weight > 0.0)) continue;
      double off = std::abs(r);
      if (std::isfinite(room)) off = std::min(off, room * problem_.diagonal[g]);
      sum += off * off / weight;
    }
  }
  return sum;
}

bool RowSystem::solve_damped(Substep& substep, double damping) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    problem_.diagonal[g] += (damping - damping_) * weight_[g];
  }
  damping_ = damping;
  const bool solved = solve_assembled(substep, false);
  ++substep.statistics.rounds;
  substep.statistics.row_solves += static_cast<std::int64_t>(rows_.size());
  return solved;
}

double RowSystem::way_out(const Substep& substep) {
  // Forces f along the violated rows, in proportion to their residuals. If these forces cause no
  // motion, f J = 0, then f (r + J dx) = f r > 0 for every dx: no motion satisfies the rows.
  motion_.assign(at(substep.bodies.coordinates().count()), 0.0);
  double norm = 0.0;
  double lengths = 0.0;
  double gap = 0.0;
  const auto force = [&](std::size_t g) {
    const Row& first = rows_[at(groups_[g].first_row)];
    const double r = problem_.constant[g];
    const bool hard = !groups_[g].elastic && (r > 0.0 ? first.lower : first.upper) ==
                                                 (r > 0.0 ? -Row::unbounded : Row::unbounded);
    return hard && weight_[g] > 0.0 ? -r / weight_[g] : 0.0;
  };
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double f = force(g);
    if (f == 0.0) continue;
    gap -= f * problem_.constant[g];
    norm += f * f * weight_[g];
    lengths += f * f / (groups_[g].lever * groups_[g].lever);
    for (int i = 0; i < groups_[g].row_count; ++i) {
      slots_.add_row(groups_[g].first_row + i, f, motion_.data());
    }
  }
  if (!(gap > 0.0)) return 0.0;
  double work = 0.0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double f = force(g);
    if (f != 0.0) work += f * slots_.along(static_cast<int>(g), motion_.data());
  }
  return gap / std::sqrt(std::max(work, 1e-300)) * std::sqrt(norm / lengths);
}

}  // namespace sheave
