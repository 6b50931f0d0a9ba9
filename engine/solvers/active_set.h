#pragma once
// The linear complementarity problem of rows with bounds, by block pivoting.
//
// Find dl with  r = c + A dl  so that each unknown is free with r = 0, or at its lower bound with r >= 0, or at its
// upper bound with r <= 0. Given which ones are free, that is a linear system. Afterwards those
// that break their conditions change sides, all at once as long as their number falls, otherwise
// only the last of them: Murty's rule, which ends for every positive definite A (Judice and Pires,
// "Block pivoting for strictly monotone LCPs", 1994). Started from the set of the last substep it
// mostly ends at the first try.
//
// Where A is singular, a free unknown can be redundant (its pivot is dropped) and yet contradict
// the others: a cable lifts a weight that the floor's rows still hold down. Along the null vector z
// with z_j = 1 of the redundant unknown j no residual changes, so dl + t z is as good a solution
// for every t; t goes the way that r_j wants until the first unknown meets its bound, and that one
// is no longer free. If none does, nothing can satisfy the row: it contradicts the others. Which of
// them was left out is then an accident of the order, so all of them give way: with the diagonal
// matrix D of A, e = 1e-6 and B = A + e D, the solution dl = -B^-1 A B^-1 c leaves the residuals
// with the least sum of r^2 / D, and what it has along the null vectors, forces that hold each
// other in balance without end, is nearly 0.

#include <span>
#include <utility>
#include <vector>

#include "engine/solvers/sparse_factor.h"
#include "engine/work_limit.h"

namespace sheave {

/// A, c, and bounds of dl. A is symmetric unless `upper_values` differ from `values`.
struct ComplementarityProblem {
  int size = 0;
  bool symmetric = true;
  std::vector<double> diagonal;
  std::vector<double> values;        ///< A(i, j) of the entries (i, j), i < j, of the pattern
  std::vector<double> lower_values;  ///< A(j, i)
  std::vector<double> constant;      ///< c
  double rounding = 0.0;             ///< what c may be off by, whatever its size [unit of c]
  std::vector<double> lower;         ///< bounds of dl; where they are equal, r can be anything
  std::vector<double> upper;
  /// Per unknown whether to begin with it free, 1, or at a bound, 0 (the lower one if that is
  /// finite) or at_upper; that of the solution afterwards.
  std::vector<char> free;
  static constexpr char at_upper = 2;
};

class ActiveSetSolver {
 public:
  /// Where A has entries off its diagonal.
  void analyse(int size, std::span<const std::pair<int, int>> entries);
  /// Returns false if there is none: where the tries go round in a circle, and where they take more
  /// factorisations than `work` allows, or a number that grows with the size. `compromise`: rows
  /// that contradict each other all give way; otherwise some of them are left out. `work` may be
  /// null: no limit.
  bool solve(ComplementarityProblem& problem, bool compromise = false, WorkLimit* work = nullptr);

  /// Projected Gauss-Seidel from dl = 0 instead: sweeps over the unknowns in their order, as many
  /// unless `work` stops them.
  void relax(const ComplementarityProblem& problem, int sweeps, WorkLimit* work = nullptr);

  [[nodiscard]] std::span<const double> solution() const { return solution_; }
  [[nodiscard]] int changes() const { return changes_; }  ///< of sides in the last solve()
  [[nodiscard]] int factorisations() const { return factorisations_; }  ///< in the last solve()
  [[nodiscard]] int dropped() const { return dropped_; }  ///< redundant rows in the last solve()
  /// Per unknown whether it shares a load with others: whether it is not 0 in some z with A z = 0
  /// of the rows that were free in the last solve(). Empty: no row was redundant.
  void find_redundant_parts(const ComplementarityProblem& problem, std::vector<char>& part);
  /// Solves again, with the matrix and the sets of the last solve(), after `problem.constant` has
  /// grown by `change`, and bounds may have moved. False if
  /// these are not the right sets now; the solution is then still the last one.
  bool refine(const ComplementarityProblem& problem, std::span<const double> change);
  /// Takes from the constants of redundant rows what the last solve() has left of them, which is
  /// rounding. Where such rows are to find forces of their own next, these would be without measure.
  void forgive_redundant(ComplementarityProblem& problem) const;
  /// Whether in the last solve() some free rows contradicted each other.
  [[nodiscard]] bool contradicts() const { return contradicts_; }
  /// Whether these have given way.
  [[nodiscard]] bool gave_way() const { return gave_way_; }

 private:
  /// What decides how the tries go on, with the set that is tried.
  struct Course {
    int fewest = 0;       ///< violations of any set since the last change of the rules
    int left = 0;         ///< block changes without progress that may still be; -1: single ones
    bool yields = false;  ///< rows that contradict each other give way
    [[nodiscard]] bool operator==(const Course&) const = default;
  };
  /// One try; whether it has found the solution.
  bool attempt(ComplementarityProblem& problem, bool compromise, Course& course);
  /// Lets those that break their conditions change sides.
  void change_sides(ComplementarityProblem& problem, Course& course);
  /// Whether the tries go round in a circle, which is seen after at most three rounds of it.
  [[nodiscard]] bool repeats(const ComplementarityProblem& problem, int tries, const Course& now);
  void solve_free(const ComplementarityProblem& problem);
  /// Brings the equations of the free rows up to date with unknown i, which is not, having moved.
  void spread(const ComplementarityProblem& problem, std::size_t i, double moved,
              std::span<double> rhs) const;
  /// r of unknown i with the solution.
  [[nodiscard]] double residual_of(const ComplementarityProblem& problem, std::size_t i) const;
  /// The residuals of the solution, but for rows that the factors have satisfied.
  void find_residuals(const ComplementarityProblem& problem);
  /// Solves for the free unknowns again so that all rows that contradict each other give way.
  void find_compromise(const ComplementarityProblem& problem);
  void mark_violations(const ComplementarityProblem& problem);
  /// What rounding leaves of row i's equation [unit of c].
  [[nodiscard]] double noise(const ComplementarityProblem& problem, std::size_t i) const;
  /// The free unknown that has to go to its bound so that a redundant one is satisfied; -1: there
  /// is none. `going_round`: violations do.
  [[nodiscard]] int blocking_unknown(const ComplementarityProblem& problem, bool going_round);
  /// z with A z = 0 of a redundant unknown, into null_vector_.
  void find_null_vector(const ComplementarityProblem& problem, int redundant);
  /// What rows that depend on each other by it may be off by and still agree. `largest`: of the
  /// constants.
  [[nodiscard]] double agreement(const ComplementarityProblem& problem, double largest) const;
  /// Whether unknowns with two bounds have a part in it.
  [[nodiscard]] bool shares_with_friction(const ComplementarityProblem& problem) const;
  /// Where violations go round and redundant rows agree with the others: takes from unknowns beyond
  /// their bounds what redundant ones, left out, have left to them. Whether that is a solution.
  [[nodiscard]] bool takes_back_share(const ComplementarityProblem& problem);
  [[nodiscard]] int first_blocked(const ComplementarityProblem& problem, int redundant,
                                  double direction);

  /// An entry of a row off the diagonal.
  struct Neighbour {
    int other = 0;
    int entry = 0;
    bool transposed = false;  ///< its value is the transposed one
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
  bool blocked_above_ = false;  ///< by which of its bounds
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
