#pragma once
// Which of many rows C >= 0 act, and with which multipliers >= 0, where the matrix stays what it is.
//
// Mostly the rows act that acted before: their factor is kept. Otherwise block pivoting finds which
// ones do (engine/solvers/active_set.h), as it does for the stages of engine/step.cpp, and from the
// same set, so that both find the same forces where there is more than one answer.

#include <span>
#include <utility>
#include <vector>

#include "engine/solvers/active_set.h"
#include "engine/solvers/sparse_factor.h"

namespace sheave {

class AffineProblem {
 public:
  /// Factorisations after which a search is given up: it mostly takes two or three.
  static constexpr int most_factorisations = 32;

  /// Rows whose matrix has these entries off its diagonal, (i, j) with i < j.
  void analyse(int size, std::span<const std::pair<int, int>> entries);
  /// Takes the matrix: its diagonal, and the values of the entries in their order. Rows that are
  /// never to act have `excluded` not 0; it may be empty: none.
  void set_matrix(std::span<const double> diagonal, std::span<const double> couplings,
                  std::span<const char> excluded);
  /// Factors the matrix of the rows that act, unless it has just been; false if some of them are
  /// redundant.
  [[nodiscard]] bool factor(std::span<const char> acts);
  /// Whether factor() was called for all rows last, and none of them is redundant.
  [[nodiscard]] bool factored_for_all() const { return regular_ && all_; }
  /// Solves A x = b in place for the rows that factor() was called for; b is to be 0 elsewhere.
  void solve(std::span<double> x) { factor_.solve(x); }

  /// What search() is to solve: with the matrix, bounds 0 and infinity. Constants, what a constant
  /// may be off by, and which rows to begin with are the caller's.
  [[nodiscard]] ComplementarityProblem& posed();
  /// False if there is no solution, or it is not found soon.
  [[nodiscard]] bool search();
  /// Of the last search.
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
  bool all_ = false;                                        ///< of factored_for_
  std::vector<double> acting_diagonal_, acting_couplings_;  // scratch of factor()
  bool analysed_ = false;                                   ///< for searches
  ComplementarityProblem problem_;
  ActiveSetSolver search_;
};

}  // namespace sheave
