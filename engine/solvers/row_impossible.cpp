// Rows that only prescribed motion could satisfy: engine/solvers/row_system.h.

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
    // An idle row cannot push, and does not pull because no body would yield.
    const bool wanted = rows_[at(groups_[g].first_row)].idle
                            ? r < 0.0
                            : (r > 0.0 ? -problem_.lower[g] : problem_.upper[g]) > 0.0;
    if (!wanted) continue;
    if (gives_nothing(g)) worst = off;
  }
  return worst;
}

bool RowSystem::gives_nothing(std::size_t g) const {
  if (assembled_) return problem_.diagonal[g] == 0.0;
  const double whole = yield(g);
  if (groups_[g].row_count == 1 || whole == 0.0) return whole == 0.0;
  // Rows that share an unknown may move a body to and fro by the same amount: cable from a driven
  // drum over a wheel, which passes it on, to a fixed end.
  constexpr double rounding = 1e-13;
  std::vector<double> motion(motion_.size(), 0.0);
  slots_.add_unknown(static_cast<int>(g), 1.0, motion.data());
  const double together = problem_.diagonal[g] + slots_.along(static_cast<int>(g), motion.data());
  return std::abs(together) <= rounding * whole;
}

void RowSystem::count_impossible(Substep& substep) const {
  // Far above rounding and the residual of rounds, far below a visible error.
  constexpr double share = 1e-6;
  const double off = unyielding(share * substep.bodies.scale());
  if (off == 0.0) return;
  ++substep.statistics.impossible;
  substep.statistics.most_impossible = std::max(substep.statistics.most_impossible, off);
}

}  // namespace sheave
