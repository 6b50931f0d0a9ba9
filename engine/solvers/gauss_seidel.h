#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/solvers/row_system.h"

namespace sheave {

/// Visits all rows of all features in a fixed order, `iterations` times, each re-evaluated at the
/// current positions (the paper's solver; row update in engine/row.h). The rows of a stiff feature
/// are visited all at once: one round of Newton's method on them alone, with what the others have
/// done to the bodies taken as given (block Gauss-Seidel).
class GaussSeidelSolver {
 public:
  void solve(Substep& substep, Features features);

 private:
  /// A stiff feature among the others.
  struct Block {
    RowSystem system;
    bool revised = false;  ///< whether its last visit has changed the bounds of rows
  };
  /// One visit; returns the largest violation that it found [m or rad].
  static double visit(Substep& substep, Features feature, Block& block, bool first);

  std::vector<Block> blocks_;  ///< per feature; used by stiff ones
};

}  // namespace sheave
