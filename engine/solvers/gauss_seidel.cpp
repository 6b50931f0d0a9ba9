#include "engine/solvers/gauss_seidel.h"

#include <algorithm>

namespace sheave {

void solve_gauss_seidel(Substep& substep,
                        std::span<const std::unique_ptr<ConstraintBatch>> features) {
  int rows = 0;
  for (const auto& feature : features) rows += feature->row_count();
  double correction = 0.0;
  for (int iteration = 0; iteration < substep.iterations; ++iteration) {
    correction = 0.0;
    for (const auto& feature : features) {
      correction = std::max(correction, feature->sweep(substep));
    }
  }
  StepStatistics& statistics = substep.statistics;
  statistics.rows = rows;
  statistics.row_solves += static_cast<std::int64_t>(rows) * substep.iterations;
  statistics.last_correction = std::max(statistics.last_correction, correction);
}

}  // namespace sheave
