#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/solvers/row_system.h"

namespace sheave {

/// Visits all rows of all features in a fixed order, `iterations` times, and evaluates each row at
/// the current positions (the paper's solver; the update of a row is in engine/row.h). The rows of
/// a stiff feature are visited all at once: one round of Newton's method on these rows alone, which
/// takes the effect of the other features on the bodies as given (block Gauss-Seidel).
class GaussSeidelSolver {
 public:
  void solve(Substep& substep, Features features);

 private:
  /// Solver of a stiff feature among others.
  struct Block {
    RowSystem system;
    bool revised = false;  ///< whether its last visit has changed the bounds of rows
  };
  /// One visit; returns the largest violation that it found [m or rad].
  static double visit(Substep& substep, Features feature, Block& block, bool first);

  std::vector<Block> blocks_;  ///< per feature; used by stiff ones
};

}  // namespace sheave
