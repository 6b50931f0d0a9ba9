#pragma once
// The linear complementarity problem of rows with bounds, by block pivoting.
//
// Find dl with r = c + A dl such that each unknown is in one of three cases: free with r = 0, at
// its lower bound with r >= 0, or at its upper bound with r <= 0. For a given set of free unknowns
// the problem is a linear system. After its solution, unknowns that violate their conditions change
// sides. All of them change at once as long as their number falls. Otherwise only the last of them
// changes: Murty's rule, which ends for every positive definite A (Judice and Pires, "Block
// pivoting for strictly monotone LCPs", 1994). With the set of the last substep as the start (warm
// start), the first try is usually the solution.
//
// If A is singular, a free unknown j can be redundant (its pivot is dropped) and its row can still
// contradict the others: a cable lifts a weight that the floor's rows still hold down. Along the
// null vector z with z_j = 1 no residual changes, so dl + t z is as good a solution for every t.
// The solver increases |t| in the direction that r_j asks for, until the first unknown meets its
// bound; this unknown is then no longer free. If no unknown meets a bound, nothing can satisfy the
// row: the row contradicts the others. The choice of the dropped row depends on the order of
// elimination alone, so all contradicting rows give way. With the diagonal matrix D of A, e = 1e-6
// and B = A + e D, the solution dl = -B^-1 A B^-1 c leaves the residuals with the least sum of r^2
// / D. Its components along the null vectors, which are forces in balance without bound, are nearly
// 0.

#include <span>
#include <utility>
#include <vector>

#include "engine/solvers/sparse_factor.h"
#include "engine/work_limit.h"

namespace sheave {

/// A, c, and bounds of dl. A is symmetric unless `lower_values` differ from `values`.
struct ComplementarityProblem {
  int size = 0;
  bool symmetric = true;
  std::vector<double> diagonal;
  std::vector<double> values;        ///< A(i, j) of the entries (i, j), i < j, of the pattern
  std::vector<double> lower_values;  ///< A(j, i)
  std::vector<double> constant;      ///< c
  double rounding = 0.0;             ///< absolute error that c may have [unit of c]
  std::vector<double> lower;         ///< bounds of dl; if both are equal, r can be anything
  std::vector<double> upper;
  /// Side of each unknown: 1 if free, 0 at a bound (the lower one if that is finite), or at_upper.
  /// Before solve() the start of the search, afterwards the sides of the solution.
  std::vector<char> free;
  static constexpr char at_upper = 2;
};

class ActiveSetSolver {
 public:
  /// Sets the pattern: the places of the entries of A off its diagonal.
  void analyse(int size, std::span<const std::pair<int, int>> entries);
  /// Returns false if no solution is found: the tries repeat in a cycle, or they take more
  /// factorisations than `work` or a limit that grows with the size allows. `compromise`: rows that
  /// contradict each other all give way; otherwise some of them are left out. `work` may be null:
  /// no limit.
  bool solve(ComplementarityProblem& problem, bool compromise = false, WorkLimit* work = nullptr);

  /// Projected Gauss-Seidel from dl = 0: `sweeps` sweeps over the unknowns in their order, fewer if
  /// `work` stops them.
  void relax(const ComplementarityProblem& problem, int sweeps, WorkLimit* work = nullptr);

  [[nodiscard]] std::span<const double> solution() const { return solution_; }
  [[nodiscard]] int changes() const { return changes_; }  ///< of sides in the last solve()
  [[nodiscard]] int factorisations() const { return factorisations_; }  ///< in the last solve()
  [[nodiscard]] int dropped() const { return dropped_; }  ///< redundant rows in the last solve()
  /// Whether each unknown shares a load with others: whether its component is not 0 in some z with
  /// A z = 0 of the rows that were free in the last solve(). Empty: no row was redundant.
  void find_redundant_parts(const ComplementarityProblem& problem, std::vector<char>& part);
  /// Solves again, with the matrix and the sides of the last solve(), after `problem.constant` has
  /// grown by `change`; bounds may have moved. False if these sides no longer hold; the solution is
  /// then unchanged. Without `last`, another call follows, and unknowns at their bounds are not
  /// examined.
  bool refine(const ComplementarityProblem& problem, std::span<const double> change, bool last);
  /// Subtracts the residuals of the last solve(), which are rounding, from the constants of
  /// redundant rows. If such rows are regularised next, the residuals would cause forces without
  /// bound.
  void forgive_redundant(ComplementarityProblem& problem) const;
  /// Whether in the last solve() some free rows contradicted each other.
  [[nodiscard]] bool contradicts() const { return contradicts_; }
  /// Whether all contradicting rows have given way.
  [[nodiscard]] bool gave_way() const { return gave_way_; }

 private:
  /// The rules of the next try. Together with the set they determine all later tries.
  struct Course {
    int fewest = 0;  ///< least number of violations since the last change of rules
    int left =
        0;  ///< block changes without progress that are still allowed; -1: one unknown per try
    bool yields = false;  ///< rows that contradict each other all give way
    [[nodiscard]] bool operator==(const Course&) const = default;
  };
  /// One try; whether it has found the solution.
  bool attempt(ComplementarityProblem& problem, bool compromise, Course& course);
  /// Lets unknowns that violate their conditions change sides.
  void change_sides(ComplementarityProblem& problem, Course& course);
  /// Whether the tries repeat in a cycle. The answer comes after at most three cycles.
  [[nodiscard]] bool repeats(const ComplementarityProblem& problem, int tries, const Course& now);
  void solve_free(const ComplementarityProblem& problem);
  /// Updates the equations of the free rows after unknown i, which is not free, has changed by
  /// `moved`.
  void spread(const ComplementarityProblem& problem, std::size_t i, double moved,
              std::span<double> rhs) const;
  /// Residual r of row i for the solution.
  [[nodiscard]] double residual_of(const ComplementarityProblem& problem, std::size_t i) const;
  /// Computes the residuals of the solution, except for rows that the factors have satisfied.
  void find_residuals(const ComplementarityProblem& problem);
  /// Solves for the free unknowns again so that all rows that contradict each other give way.
  void find_compromise(const ComplementarityProblem& problem);
  void mark_violations(const ComplementarityProblem& problem);
  /// Rounding error of row i's equation [unit of c].
  [[nodiscard]] double noise(const ComplementarityProblem& problem, std::size_t i) const;
  /// The free unknown that has to go to its bound so that a redundant row is satisfied; -1: there
  /// is none. `going_round`: the same violations return in every try.
  [[nodiscard]] int blocking_unknown(const ComplementarityProblem& problem, bool going_round);
  /// Computes z with A z = 0 for a redundant unknown, into null_vector_.
  void find_null_vector(const ComplementarityProblem& problem, int redundant);
  /// Largest residual of a redundant row that still agrees with the rows of its null vector.
  /// `largest`: largest constant of the problem.
  [[nodiscard]] double agreement(const ComplementarityProblem& problem, double largest) const;
  /// Whether unknowns with two bounds, friction, take part in the null vector.
  [[nodiscard]] bool shares_with_friction(const ComplementarityProblem& problem) const;
  /// For violations that return in every try although redundant rows agree with the others: the
  /// dropped rows take the excess of the unknowns beyond their bounds. Returns whether the result
  /// is a solution.
  [[nodiscard]] bool takes_back_share(const ComplementarityProblem& problem);
  [[nodiscard]] int first_blocked(const ComplementarityProblem& problem, int redundant,
                                  double direction);

  /// An entry of a row off the diagonal.
  struct Neighbour {
    int other = 0;
    int entry = 0;
    bool transposed = false;  ///< the value is the one of the mirrored entry
  };

  std::vector<std::pair<int, int>> entries_;
  std::vector<int> neighbour_start_;
  std::vector<Neighbour> neighbours_;
  SparseFactor factor_;
  std::vector<double> solution_;
  std::vector<double> refined_;
  std::vector<double> residual_;
  std::vector<int> violated_;
  std::vector<double> null_vector_;
  bool blocked_above_ = false;  ///< whether first_blocked() has found an upper bound
  std::vector<double> softened_;
  std::vector<char> kept_set_;
  Course kept_course_;
  int changes_ = 0;
  int factorisations_ = 0;
  int dropped_ = 0;
  bool contradicts_ = false;
  bool gave_way_ = false;
};

}  // namespace sheave
