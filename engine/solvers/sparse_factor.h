#pragma once
// Factorisation of a sparse matrix with a symmetric pattern, for constraint rows: A = L D L^T for a
// symmetric positive semidefinite matrix, A = L D U for a nearly symmetric one (friction, gradients
// at two instants).
//
// Up-looking (Davis, "Direct Methods for Sparse Linear Systems", 2006, chapter 4): row k of L
// solves a triangular system with the rows before it, and the elimination tree determines which of
// its entries are not zero. The pattern of L is computed once per set of unknowns that take part,
// in an order that is computed once per pattern of A. A chain, such as the spans of a cable over
// wheels, has one entry per row, next to the diagonal. For a chain the operations are those of a
// tridiagonal solver, and have a loop of their own.
//
// Redundant rows make A singular: a belt round two wheels, a frame with more joints than degrees of
// freedom. Their pivots are zero but for rounding. A pivot below `dropped_pivot` times its diagonal
// entry is dropped: its unknown remains 0. The other unknowns then also satisfy its equation, if it
// has a solution.
//
// Rounding is larger if nearly redundant rows come before. A pivot is z^T A z, with z_k = 1 and the
// other components such that rows before k have A z = 0. The factors are those of a matrix whose
// entries differ from A by some eps sqrt(a_ii a_jj) (Higham, "Accuracy and Stability of Numerical
// Algorithms", 2002, theorem 10.3). If these errors have random signs, the error of the pivot is
// eps times the sum of z_i^2 a_ii. In machines with nearly dependent rows pivots scatter up to
// 4e-16 of this sum. Small pivots are therefore compared with the sum, too: a pivot that is
// rounding would cause forces without bound, between walls even without any motion.

#include <span>
#include <utility>
#include <vector>

namespace sheave {

class SparseFactor {
 public:
  /// Relative size of a pivot that counts as 0. A pivot that is zero but for rounding has some
  /// 1e-16 of the diagonal; a wheel of 1e-12 kg m2 in a cable between kilograms still has 1e-10.
  static constexpr double dropped_pivot = 1e-14;
  /// The same limit relative to the sum of z_i^2 a_ii.
  static constexpr double dropped_noise = 1e-15;
  /// Relative size of a pivot below which this sum is computed.
  static constexpr double small_pivot = 1e-7;

  /// Prepares for n x n matrices whose entries off the diagonal are at `entries`, (row, column)
  /// with row != column, each pair once in either order. Chooses the order of elimination; all
  /// unknowns take part.
  void analyse(int n, std::span<const std::pair<int, int>> entries);
  /// Restricts the matrix to the unknowns for which `chosen` is `value`. The others have rows and
  /// columns of the identity, and solve() does not change them.
  void select(std::span<const char> chosen, char value);
  /// Factors the symmetric matrix with this diagonal and these values of the entries of analyse(),
  /// in their order.
  void factor(std::span<const double> diagonal, std::span<const double> values);
  /// Factors the matrix whose entry (i, j) of the pattern has a value in `values` and (j, i) a
  /// value in `transposed_values`. Without pivoting.
  void factor(std::span<const double> diagonal, std::span<const double> values,
              std::span<const double> transposed_values);
  /// Solves A x = b in place.
  void solve(std::span<double> x);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int dropped() const { return dropped_; }  ///< pivots left out in the last factor()
  /// Whether the pivot of unknown i was dropped.
  [[nodiscard]] bool is_dropped(int i) const {
    const int k = step_of_[static_cast<std::size_t>(i)];
    return k >= 0 && !(inverse_pivot_[static_cast<std::size_t>(k)] > 0.0);
  }
  /// Entries of L below the diagonal: the cost of factor() and solve().
  [[nodiscard]] int fill() const { return static_cast<int>(row_of_.size()); }

 private:
  /// An entry of A above the diagonal, in a column of the order of elimination.
  struct Entry {
    int row = 0;          ///< unknown; in steps_: step
    int value = 0;        ///< which of the given values
    bool turned = false;  ///< the value was given as (column, row)
  };
  /// An entry of L: its column, and where it is in factor_.
  struct Below {
    int column = 0;
    int place = 0;
  };
  /// Sorts the entries into columns by `place`, of each unknown in the order of elimination.
  void sort_entries(std::span<const std::pair<int, int>> entries, std::span<const int> place);
  /// Finds the pattern of L of the unknowns that take part.
  void lay_out();
  /// The steps whose entries in row k of L are not 0, in their order, into path_.
  void find_path(int k);
  /// The factors of a chain; null `transposed_values`: symmetric.
  void factor_chain(std::span<const double> diagonal, std::span<const double> values,
                    const double* transposed_values);
  void solve_chain(std::span<double> x) const;
  [[nodiscard]] bool is_chain() const;
  /// Keeps the pivot of row k, or drops it.
  [[gnu::always_inline]] void keep_pivot(int k, double pivot, double full,
                                         std::span<const double> diagonal) {
    if (pivot > small_pivot * full) {
      inverse_pivot_[static_cast<std::size_t>(k)] = 1.0 / pivot;
    } else {
      judge_pivot(k, pivot, full, diagonal);
    }
  }
  /// Likewise for a pivot that may be rounding.
  void judge_pivot(int k, double pivot, double full, std::span<const double> diagonal);
  /// The sum of z_i^2 a_ii of row k, with the factors `below` of L or U.
  [[nodiscard]] double weight_of(int k, std::span<const double> below,
                                 std::span<const double> diagonal);

  int size_ = 0;
  int dropped_ = 0;
  // The matrix above its diagonal, by columns, in the order of elimination of all unknowns.
  std::vector<int> order_;  ///< unknown at each place
  std::vector<int> column_start_;
  std::vector<Entry> entries_;
  std::vector<char> chosen_;  ///< per unknown: takes part
  // Per step, for the unknowns that take part.
  std::vector<int> unknown_;  ///< of each step
  std::vector<int> step_of_;  ///< of each unknown, -1: none
  std::vector<int> step_start_;
  std::vector<Entry> steps_;
  std::vector<int> tree_;       ///< parent in the elimination tree, -1 at a root
  std::vector<int> row_start_;  ///< of rows of L in below_
  std::vector<Below> below_;
  // L below its diagonal, by columns.
  std::vector<int> factor_start_;
  std::vector<int> row_of_;
  std::vector<double> factor_;  ///< of a chain per row: its entry left of the diagonal, or 0
  std::vector<double> upper_;   ///< U above its diagonal, by rows, with the pattern of L
  bool symmetric_ = true;
  bool in_order_ = true;               ///< all unknowns take part, in their own order
  bool chain_ = false;                 ///< every entry joins neighbours, in their own order
  std::vector<double> inverse_pivot_;  ///< 0 where dropped
  // Scratch.
  std::vector<double> work_;
  std::vector<double> lower_work_;
  std::vector<double> null_vector_;
  std::vector<int> path_;
  std::vector<int> mark_;
};

}  // namespace sheave
