#include "engine/solvers/gauss_seidel.h"

#include <algorithm>

#include "engine/solvers/direct.h"

namespace sheave {
namespace {

bool has_finite_poses(const Substep& substep) {
  return std::all_of(substep.moving.begin(), substep.moving.end(), [](const MovingBody& body) {
    return body.position.allFinite() && body.turn.allFinite();
  });
}

}  // namespace

double GaussSeidelSolver::visit(Substep& substep, Features feature, Block& block, bool first) {
  RowSystem& system = block.system;
  system.linearise_among_others(substep, feature, first);
  const double violated = system.violation();
  const bool enough = violated <= DirectSolver::tolerance * substep.bodies.scale();
  if (!first && !block.revised && enough) return violated;
  if (system.solve(substep)) {
    system.apply(substep, feature);
  } else {
    feature.front()->sweep(substep);
  }
  block.revised = feature.front()->revise(substep);
  system.remember_places(substep);
  return violated;
}

void GaussSeidelSolver::solve(Substep& substep, Features features) {
  int rows = 0;
  for (const auto& feature : features) rows += feature->row_count();
  blocks_.resize(features.size());
  double correction = 0.0;
  constexpr int look = 16;  // sweeps from one look to the next
  for (int iteration = 0; iteration < substep.iterations; ++iteration) {
    if (substep.work.stops()) break;
    // Sweeps cannot repair a value that is not finite. The caller checks the whole substep and
    // reports it.
    if (iteration % look == look - 1 && !has_finite_poses(substep)) break;
    correction = 0.0;
    substep.tentative = features.size() > 1 && 2 * iteration < substep.iterations;
    for (std::size_t i = 0; i < features.size(); ++i) {
      const bool stiff = features[i]->is_stiff() && features[i]->row_count() > 0;
      correction = std::max(
          correction, stiff ? visit(substep, features.subspan(i, 1), blocks_[i], iteration == 0)
                            : features[i]->sweep(substep));
    }
  }
  substep.tentative = false;
  StepStatistics& statistics = substep.statistics;
  statistics.rows = rows;
  statistics.row_solves += static_cast<std::int64_t>(rows) * substep.iterations;
  statistics.last_correction = std::max(statistics.last_correction, correction);
}

}  // namespace sheave
