#pragma once
// All rows of a substep at once.
//
// With the rows linearised at the current positions, C(x + dx) = C + J dx, motion dx = W K^T dl for a change dl of the
// unknowns, and XPBD's compliance and damping (engine/row.h), the unknowns l + dl satisfy
//
//   r = C' + A dl = 0,   A = S J W K^T + a',   C' = S (C + g C') + a' l,   a' = S a~,   S = 1 / (1 + g)
//
// where a row is free, and l + dl at its bound with r >= 0 (lower bound) or r <= 0 (upper) where it is not: a linear
// complementarity problem (engine/solvers/active_set.h). J and K differ only for rows that share an unknown l with
// weights k: J = sum of their gradients, K = sum of k times them, which are the same without friction.
// A couples rows that touch a common body, so the spans of a cable over wheels make it tridiagonal.
//
// C is not linear, so this is one round of Newton's method, which squares the error: the first round leaves what the
// motion of one substep bends the constraints by, the next one some 1e-10 of the scene. Rounds end when no row is
// violated by more than `tolerance` times the scene's size, at the latest after `iterations` of them.

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/solvers/active_set.h"
#include "engine/substep.h"

namespace sheave {

/// The solver and its scratch; what it keeps between substeps is only the factorisation's pattern.
class DirectSolver {
 public:
  /// Violation at which a round is the last one, relative to the scene's size.
  static constexpr double tolerance = 1e-10;

  void solve(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);

 private:
  /// Rows that share an unknown.
  struct Group {
    int first_row = 0;
    int row_count = 0;
    double multiplier = 0.0;  ///< l
    double scale = 1.0;       ///< S
  };
  /// A term of a row that touches a body which can move.
  struct Touch {
    int row = 0;
    int term = 0;
  };
  /// What two touches of one body add to A.
  struct Coupling {
    int entry = 0;  ///< off the diagonal; < 0: on it, of the group -1 - entry
    Touch first;    ///< of the group with the lower number
    Touch second;
  };

  void linearise(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);
  void make_groups(const Substep& substep);
  void settle_weights(const Substep& substep);
  /// Finds the pattern of A anew if the rows touch other bodies than before.
  void find_pattern(const Substep& substep);
  void assemble(const Substep& substep);
  [[nodiscard]] double coupling(const Substep& substep, Touch of_gradient, Touch of_motion) const;
  /// The largest violation [m or rad] of what the problem asks for, before it is solved.
  [[nodiscard]] double violation() const;
  void apply(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);

  std::vector<Row> rows_;
  std::vector<RowResponse> responses_;
  std::vector<int> feature_rows_;  ///< first row of each feature, and their number
  std::vector<double> previous_;   ///< per row its multiplier [as it says]
  std::vector<Group> groups_;
  std::vector<int> group_of_;
  std::vector<double> mismatch_;  ///< per row: weight times the unknown, less its multiplier
  std::vector<RowTerm> motion_;   ///< per body: displacement and turn; `body` is not used
  std::vector<int> signature_;    ///< of the pattern: per row its bodies and whether it is tied
  std::vector<int> new_signature_;
  std::vector<std::pair<int, int>> entries_;
  std::vector<Coupling> couplings_;
  ComplementarityProblem problem_;
  ActiveSetSolver active_set_;
};

}  // namespace sheave
