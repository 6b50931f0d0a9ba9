// Rows that prescribed motion alone decides: engine/solvers/row_system.h.

#include <algorithm>
#include <cmath>

#include "engine/index.h"
#include "engine/solvers/row_system.h"

namespace sheave {

double RowSystem::unyielding(double least) const {
  double worst = 0.0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const double r = problem_.constant[g];
    const double off = std::abs(r) * groups_[g].lever / groups_[g].scale;
    if (!(off > std::max(worst, least))) continue;
    // An idle row may not push and does not pull because that would be in vain.
    const bool wanted = rows_[at(groups_[g].first_row)].idle
                            ? r < 0.0
                            : (r > 0.0 ? -problem_.lower[g] : problem_.upper[g]) > 0.0;
    if (!wanted) continue;
    const double gives = assembled_ ? problem_.diagonal[g] : yield(g);
    if (gives == 0.0) worst = off;
  }
  return worst;
}

void RowSystem::count_impossible(Substep& substep) const {
  // Far above what rounding and the rounds of features leave, far below what matters.
  constexpr double share = 1e-6;
  const double off = unyielding(share * substep.bodies.scale());
  if (off == 0.0) return;
  ++substep.statistics.impossible;
  substep.statistics.most_impossible = std::max(substep.statistics.most_impossible, off);
}

}  // namespace sheave
