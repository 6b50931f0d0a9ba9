#include "engine/solvers/sparse_factor.h"

#include <algorithm>
#include <numeric>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include "engine/index.h"

namespace sheave {
namespace {

/// Minimum degree order: place of each unknown.
std::vector<int> minimum_degree(int n, std::span<const std::pair<int, int>> entries) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& [i, j] : entries) {
    triplets.emplace_back(i, j, 1.0);
    triplets.emplace_back(j, i, 1.0);
  }
  for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, 1.0);
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  // Eigen gives which unknown comes at each place.
  std::vector<int> place(at(n));
  for (int k = 0; k < n; ++k) place[at(order.indices()[k])] = k;
  return place;
}

}  // namespace

int SparseFactor::count_fill(std::span<const std::pair<int, int>> entries) {
  const int n = size_;
  // Columns of the upper triangle.
  std::vector<int> counts(at(n) + 1, 0);
  for (const auto& [i, j] : entries) ++counts[at(std::max(place_[at(i)], place_[at(j)])) + 1];
  std::partial_sum(counts.begin(), counts.end(), counts.begin());
  column_start_ = counts;
  entry_row_.resize(entries.size());
  entry_of_.resize(entries.size());
  turned_.resize(entries.size());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const int a = place_[at(entries[e].first)];
    const int b = place_[at(entries[e].second)];
    const int slot = counts[at(std::max(a, b))]++;
    entry_row_[at(slot)] = std::min(a, b);
    entry_of_[at(slot)] = static_cast<int>(e);
    turned_[at(slot)] = a > b ? 1 : 0;
  }
  // Row k of L has an entry at each node on the ways in the tree from its entries of A up to k.
  tree_.assign(at(n), -1);
  mark_.assign(at(n), -1);
  factor_count_.assign(at(n), 0);
  int fill = 0;
  for (int k = 0; k < n; ++k) {
    mark_[at(k)] = k;
    for (int p = column_start_[at(k)]; p < column_start_[at(k) + 1]; ++p) {
      for (int i = entry_row_[at(p)]; mark_[at(i)] != k; i = tree_[at(i)]) {
        if (tree_[at(i)] < 0) tree_[at(i)] = k;
        mark_[at(i)] = k;
        ++factor_count_[at(i)];
        ++fill;
      }
    }
  }
  return fill;
}

void SparseFactor::analyse(int n, std::span<const std::pair<int, int>> entries) {
  size_ = n;
  place_.resize(at(n));
  std::iota(place_.begin(), place_.end(), 0);
  int fill = count_fill(entries);
  // A chain in its own order fills nothing; only what does is worth another order.
  if (fill > static_cast<int>(entries.size())) {
    const std::vector<int> natural = place_;
    const int natural_fill = fill;
    place_ = minimum_degree(n, entries);
    fill = count_fill(entries);
    if (fill >= natural_fill) {
      place_ = natural;
      fill = count_fill(entries);
    }
  }
  factor_start_.assign(at(n) + 1, 0);
  std::partial_sum(factor_count_.begin(), factor_count_.end(), factor_start_.begin() + 1);
  row_of_.resize(at(fill));
  factor_.resize(at(fill));
  inverse_pivot_.resize(at(n));
  work_.assign(at(n), 0.0);
  path_.resize(at(n));
  chain_ = is_chain();
  if (chain_) factor_.assign(at(n), 0.0);
}

bool SparseFactor::is_chain() const {
  for (int k = 0; k < size_; ++k) {
    if (place_[at(k)] != k) return false;
    const int start = column_start_[at(k)];
    const int count = column_start_[at(k) + 1] - start;
    if (count > 1 || (count == 1 && entry_row_[at(start)] != k - 1)) return false;
  }
  return true;
}

void SparseFactor::factor_chain(std::span<const double> diagonal, std::span<const double> values,
                                const double* transposed_values) {
  dropped_ = 0;
  for (int k = 0; k < size_; ++k) {
    const double full = diagonal[at(k)];
    double pivot = full;
    const int p = column_start_[at(k)];
    factor_[at(k)] = 0.0;
    if (transposed_values != nullptr) upper_[at(k)] = 0.0;
    if (p < column_start_[at(k) + 1]) {
      const auto entry = at(entry_of_[at(p)]);
      const bool turned = turned_[at(p)] != 0;
      const double inverse = inverse_pivot_[at(k) - 1];
      if (transposed_values == nullptr) {
        const double y = values[entry];
        factor_[at(k)] = y * inverse;
        pivot -= factor_[at(k)] * y;
      } else {
        const double y = turned ? transposed_values[entry] : values[entry];
        const double z = turned ? values[entry] : transposed_values[entry];
        factor_[at(k)] = z * inverse;
        upper_[at(k)] = y * inverse;
        pivot -= factor_[at(k)] * y;
      }
    }
    keep_pivot(k, pivot, full);
  }
}

void SparseFactor::solve_chain(std::span<double> x) const {
  if (size_ == 0) return;
  const double* const below = factor_.data();
  const double* const above = (symmetric_ ? factor_ : upper_).data();
  const double* const inverse = inverse_pivot_.data();
  double* const unknown = x.data();
  double last = unknown[0];
  for (int k = 1; k < size_; ++k) {
    last = unknown[k] - below[k] * last;
    unknown[k] = last;
  }
  // A dropped unknown is 0 whatever the others are, and so is what it couples.
  last = inverse[size_ - 1] > 0.0 ? inverse[size_ - 1] * last : 0.0;
  unknown[size_ - 1] = last;
  for (int k = size_ - 1; k-- > 0;) {
    const double y = unknown[k] * inverse[k] - above[k + 1] * last;
    last = inverse[k] > 0.0 ? y : 0.0;
    unknown[k] = last;
  }
}

int SparseFactor::scatter(int k, std::span<const double> values, const double* transposed_values) {
  int top = size_;
  mark_[at(k)] = k;
  for (int p = column_start_[at(k)]; p < column_start_[at(k) + 1]; ++p) {
    int i = entry_row_[at(p)];
    const auto entry = at(entry_of_[at(p)]);
    if (transposed_values == nullptr) {
      work_[at(i)] += values[entry];
    } else {
      const bool turned = turned_[at(p)] != 0;
      work_[at(i)] += turned ? transposed_values[entry] : values[entry];
      lower_work_[at(i)] += turned ? values[entry] : transposed_values[entry];
    }
    int length = 0;
    for (; mark_[at(i)] != k; i = tree_[at(i)]) {
      path_[at(length++)] = i;
      mark_[at(i)] = k;
    }
    while (length > 0) path_[at(--top)] = path_[at(--length)];
  }
  return top;
}

void SparseFactor::begin_factor(std::span<const double> diagonal) {
  dropped_ = 0;
  std::fill(factor_count_.begin(), factor_count_.end(), 0);
  std::fill(mark_.begin(), mark_.end(), -1);
  for (int i = 0; i < size_; ++i) inverse_pivot_[at(place_[at(i)])] = diagonal[at(i)];
}

void SparseFactor::keep_pivot(int k, double pivot, double full) {
  // Written so that NaN is dropped, too.
  const bool kept = pivot > dropped_pivot * full;
  if (!kept) ++dropped_;
  inverse_pivot_[at(k)] = kept ? 1.0 / pivot : 0.0;
}

void SparseFactor::factor(std::span<const double> diagonal, std::span<const double> values) {
  symmetric_ = true;
  if (chain_) return factor_chain(diagonal, values, nullptr);
  begin_factor(diagonal);
  for (int k = 0; k < size_; ++k) {
    const double full = inverse_pivot_[at(k)];
    double pivot = full;
    for (int top = scatter(k, values, nullptr); top < size_; ++top) {
      const int i = path_[at(top)];
      const double y = work_[at(i)];
      work_[at(i)] = 0.0;
      const int end = factor_start_[at(i)] + factor_count_[at(i)];
      for (int p = factor_start_[at(i)]; p < end; ++p) {
        work_[at(row_of_[at(p)])] -= factor_[at(p)] * y;
      }
      const double entry = y * inverse_pivot_[at(i)];
      pivot -= entry * y;
      row_of_[at(end)] = k;
      factor_[at(end)] = entry;
      ++factor_count_[at(i)];
    }
    keep_pivot(k, pivot, full);
  }
}

void SparseFactor::factor(std::span<const double> diagonal, std::span<const double> values,
                          std::span<const double> transposed_values) {
  symmetric_ = false;
  upper_.resize(factor_.size());
  lower_work_.resize(at(size_), 0.0);
  if (chain_) return factor_chain(diagonal, values, transposed_values.data());
  begin_factor(diagonal);
  for (int k = 0; k < size_; ++k) {
    const double full = inverse_pivot_[at(k)];
    double pivot = full;
    for (int top = scatter(k, values, transposed_values.data()); top < size_; ++top) {
      const int i = path_[at(top)];
      // D U of column k, and L D of row k.
      const double y = work_[at(i)];
      const double z = lower_work_[at(i)];
      work_[at(i)] = lower_work_[at(i)] = 0.0;
      const int end = factor_start_[at(i)] + factor_count_[at(i)];
      for (int p = factor_start_[at(i)]; p < end; ++p) {
        work_[at(row_of_[at(p)])] -= factor_[at(p)] * y;
        lower_work_[at(row_of_[at(p)])] -= upper_[at(p)] * z;
      }
      pivot -= z * inverse_pivot_[at(i)] * y;
      row_of_[at(end)] = k;
      factor_[at(end)] = z * inverse_pivot_[at(i)];
      upper_[at(end)] = y * inverse_pivot_[at(i)];
      ++factor_count_[at(i)];
    }
    keep_pivot(k, pivot, full);
  }
}

void SparseFactor::solve(std::span<double> x) {
  if (chain_) return solve_chain(x);
  const std::vector<double>& back = symmetric_ ? factor_ : upper_;
  for (int i = 0; i < size_; ++i) work_[at(place_[at(i)])] = x[at(i)];
  for (int k = 0; k < size_; ++k) {
    const double y = work_[at(k)];
    for (int p = factor_start_[at(k)]; p < factor_start_[at(k) + 1]; ++p) {
      work_[at(row_of_[at(p)])] -= factor_[at(p)] * y;
    }
  }
  for (int k = size_ - 1; k >= 0; --k) {
    double y = work_[at(k)] * inverse_pivot_[at(k)];
    for (int p = factor_start_[at(k)]; p < factor_start_[at(k) + 1]; ++p) {
      y -= back[at(p)] * work_[at(row_of_[at(p)])];
    }
    // A dropped unknown is 0 whatever the others are.
    work_[at(k)] = inverse_pivot_[at(k)] > 0.0 ? y : 0.0;
  }
  for (int i = 0; i < size_; ++i) x[at(i)] = work_[at(place_[at(i)])];
  std::fill(work_.begin(), work_.end(), 0.0);
}

}  // namespace sheave
