#pragma once
// All rows of a substep at once, by Newton's method.
//
// Each round solves engine/solvers/row_system.h with XPBD's compliance and damping. The first round leaves what the
// motion of one substep bends the constraints by, the next one the square of it. Rounds end when no row is violated by
// more than `tolerance` times the scene's size, at the latest after `iterations` of them. If no active set is found the
// substep goes on with Gauss-Seidel, and is counted.

#include "engine/solvers/row_system.h"

namespace sheave {

class DirectSolver {
 public:
  /// Violation at which a round is the last one, relative to the scene's size.
  static constexpr double tolerance = 1e-10;
  /// A round that leaves more than this share of the violation is the last one, too.
  static constexpr double stagnation = 0.9;

  void solve(Substep& substep, Features features);

 private:
  RowSystem system_;
};

}  // namespace sheave
