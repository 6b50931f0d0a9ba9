#pragma once
// The active set and the multipliers >= 0 of rows C >= 0 with a constant matrix.
//
// Usually the active set is the same as before, and its factors are kept. Otherwise block pivoting
// finds the new set (engine/solvers/active_set.h), as in the stages of engine/step.cpp. Both begin
// with the same set and find the same forces if there is more than one solution.

#include <span>
#include <utility>
#include <vector>

#include "engine/solvers/active_set.h"
#include "engine/solvers/sparse_factor.h"

namespace sheave {

class AffineProblem {
 public:
  /// Factorisations after which a search is given up; a search usually takes two or three.
  static constexpr int most_factorisations = 32;

  /// Sets the pattern: the entries (i, j), i < j, of the matrix off its diagonal.
  void analyse(int size, std::span<const std::pair<int, int>> entries);
  /// Sets the matrix: its diagonal, and the values of the entries in their order. `excluded` is not
  /// 0 for rows that never act; empty: there are none.
  void set_matrix(std::span<const double> diagonal, std::span<const double> couplings,
                  std::span<const char> excluded);
  /// Factors the matrix of the rows that act, unless its factors are known; false if some of these
  /// rows are redundant.
  [[nodiscard]] bool factor(std::span<const char> acts);
  /// Whether the last factor() was for all rows, and none of them is redundant.
  [[nodiscard]] bool factored_for_all() const { return regular_ && all_; }
  /// Solves A x = b in place for the rows of the last factor(); b must be 0 in all other rows.
  void solve(std::span<double> x) { factor_.solve(x); }

  /// The problem for search(), with matrix and bounds 0 and infinity. The caller sets constants,
  /// rounding and the set to begin with.
  [[nodiscard]] ComplementarityProblem& posed();
  /// False if there is no solution, or if most_factorisations are not enough.
  [[nodiscard]] bool search();
  /// The result of the last search.
  [[nodiscard]] const ActiveSetSolver& found() const { return search_; }

 private:
  [[nodiscard]] bool takes_part(std::span<const char> acts, int row) const {
    const auto i = static_cast<std::size_t>(row);
    return acts[i] != 0 && (excluded_.empty() || excluded_[i] == 0);
  }

  std::vector<std::pair<int, int>> entries_;
  std::vector<double> diagonal_, couplings_;
  std::vector<char> excluded_;
  SparseFactor factor_;
  std::vector<char> factored_for_;
  bool regular_ = false;
  bool all_ = false;                                        ///< all rows are in factored_for_
  std::vector<double> acting_diagonal_, acting_couplings_;  // scratch of factor()
  bool analysed_ = false;                                   ///< search_ knows the pattern
  ComplementarityProblem problem_;
  ActiveSetSolver search_;
};

}  // namespace sheave
