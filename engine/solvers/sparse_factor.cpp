#include "engine/solvers/sparse_factor.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include "engine/index.h"
#include "engine/math/written_out.h"

namespace sheave {
namespace {

/// Minimum degree ordering: the place of each unknown.
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
  // Eigen returns the unknown at each place.
  std::vector<int> place(at(n));
  for (int k = 0; k < n; ++k) place[at(order.indices()[k])] = k;
  return place;
}

}  // namespace

void SparseFactor::sort_entries(std::span<const std::pair<int, int>> entries,
                                std::span<const int> place) {
  order_.resize(at(size_));
  for (int i = 0; i < size_; ++i) order_[at(place[at(i)])] = i;
  column_start_.assign(at(size_) + 1, 0);
  for (const auto& [i, j] : entries) {
    ++column_start_[at(std::max(place[at(i)], place[at(j)])) + 1];
  }
  std::partial_sum(column_start_.begin(), column_start_.end(), column_start_.begin());
  path_.assign(column_start_.begin(), column_start_.end());
  entries_.resize(entries.size());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto [i, j] = entries[e];
    const bool turned = place[at(i)] > place[at(j)];
    const int column = turned ? place[at(i)] : place[at(j)];
    entries_[at(path_[at(column)]++)] = {turned ? j : i, static_cast<int>(e), turned};
  }
}

void SparseFactor::find_path(int k) {
  // Row k of L has an entry at each node on the paths in the tree from the row's entries of A up to
  // k.
  path_.clear();
  mark_[at(k)] = k;
  for (int p = step_start_[at(k)]; p < step_start_[at(k) + 1]; ++p) {
    for (int i = steps_[at(p)].row; mark_[at(i)] != k; i = tree_[at(i)]) {
      if (tree_[at(i)] < 0) tree_[at(i)] = k;
      mark_[at(i)] = k;
      path_.push_back(i);
    }
  }
  std::sort(path_.begin(), path_.end());
}

void SparseFactor::lay_out() {
  unknown_.clear();
  step_of_.assign(at(size_), -1);
  step_start_.assign(1, 0);
  steps_.clear();
  for (int place = 0; place < size_; ++place) {
    const int unknown = order_[at(place)];
    if (chosen_[at(unknown)] == 0) continue;
    for (int p = column_start_[at(place)]; p < column_start_[at(place) + 1]; ++p) {
      Entry entry = entries_[at(p)];
      entry.row = step_of_[at(entry.row)];
      if (entry.row >= 0) steps_.push_back(entry);
    }
    step_of_[at(unknown)] = static_cast<int>(unknown_.size());
    unknown_.push_back(unknown);
    step_start_.push_back(static_cast<int>(steps_.size()));
  }
  const auto count = static_cast<int>(unknown_.size());
  tree_.assign(at(count), -1);
  mark_.assign(at(count), -1);
  factor_start_.assign(at(count) + 1, 0);
  row_start_.assign(1, 0);
  below_.clear();
  for (int k = 0; k < count; ++k) {
    find_path(k);
    for (const int i : path_) {
      below_.push_back({i, factor_start_[at(i) + 1]++});
    }
    row_start_.push_back(static_cast<int>(below_.size()));
  }
  std::partial_sum(factor_start_.begin(), factor_start_.end(), factor_start_.begin());
  row_of_.resize(below_.size());
  for (int k = 0; k < count; ++k) {
    for (int p = row_start_[at(k)]; p < row_start_[at(k) + 1]; ++p) {
      below_[at(p)].place += factor_start_[at(below_[at(p)].column)];
      row_of_[at(below_[at(p)].place)] = k;
    }
  }
  factor_.resize(below_.size());
  inverse_pivot_.resize(at(count));
  work_.assign(at(count), 0.0);
  lower_work_.assign(at(count), 0.0);
  chain_ = is_chain();
  if (chain_) factor_.assign(at(count), 0.0);
  in_order_ = count == size_ && std::is_sorted(unknown_.begin(), unknown_.end());
}

void SparseFactor::analyse(int n, std::span<const std::pair<int, int>> entries) {
  size_ = n;
  chosen_.assign(at(n), 1);
  std::vector<int> place(at(n));
  std::iota(place.begin(), place.end(), 0);
  sort_entries(entries, place);
  lay_out();
  // A chain in its own order has no fill-in. Another order is tried only for patterns with fill-in.
  const int natural_fill = fill();
  if (natural_fill <= static_cast<int>(entries.size())) return;
  sort_entries(entries, minimum_degree(n, entries));
  lay_out();
  if (fill() < natural_fill) return;
  sort_entries(entries, place);
  lay_out();
}

void SparseFactor::select(std::span<const char> chosen, char value) {
  bool changed = false;
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const char takes_part = chosen[i] == value ? 1 : 0;
    changed = changed || takes_part != chosen_[i];
    chosen_[i] = takes_part;
  }
  if (changed) lay_out();
}

bool SparseFactor::is_chain() const {
  for (int k = 0; k < static_cast<int>(unknown_.size()); ++k) {
    const int start = step_start_[at(k)];
    const int count = step_start_[at(k) + 1] - start;
    if (count > 1 || (count == 1 && steps_[at(start)].row != k - 1)) return false;
  }
  return true;
}

void SparseFactor::factor_chain(std::span<const double> diagonal, std::span<const double> values,
                                const double* transposed_values) {
  dropped_ = 0;
  for (int k = 0; k < static_cast<int>(unknown_.size()); ++k) {
    const double full = diagonal[at(unknown_[at(k)])];
    double pivot = full;
    factor_[at(k)] = 0.0;
    if (transposed_values != nullptr) upper_[at(k)] = 0.0;
    const int p = step_start_[at(k)];
    if (p < step_start_[at(k) + 1]) {
      const auto entry = at(steps_[at(p)].value);
      const double inverse = inverse_pivot_[at(k) - 1];
      if (transposed_values == nullptr) {
        const double y = values[entry];
        factor_[at(k)] = y * inverse;
        pivot -= factor_[at(k)] * y;
      } else {
        const bool turned = steps_[at(p)].turned;
        const double y = turned ? transposed_values[entry] : values[entry];
        const double z = turned ? values[entry] : transposed_values[entry];
        factor_[at(k)] = z * inverse;
        upper_[at(k)] = y * inverse;
        pivot -= factor_[at(k)] * y;
      }
    }
    keep_pivot(k, pivot, full, diagonal);
  }
}

void SparseFactor::solve_chain(std::span<double> x) const {
  const auto count = static_cast<int>(unknown_.size());
  if (count == 0) return;
  const double* const below = factor_.data();
  const double* const above = (symmetric_ ? factor_ : upper_).data();
  const double* const inverse = inverse_pivot_.data();
  const auto sweep = [&](const auto& value) {
    double last = value(0);
    for (int k = 1; k < count; ++k) {
      last = value(k) - below[k] * last;
      value(k) = last;
    }
    // A dropped unknown is 0 whatever the others are, and adds nothing to their equations.
    last = inverse[count - 1] > 0.0 ? inverse[count - 1] * last : 0.0;
    value(count - 1) = last;
    for (int k = count - 1; k-- > 0;) {
      const double y = value(k) * inverse[k] - above[k + 1] * last;
      last = inverse[k] > 0.0 ? y : 0.0;
      value(k) = last;
    }
  };
  double* const values = x.data();
  if (in_order_ && dropped_ == 0) {
    // The same without conditions. Products that wait for no other result come first.
    double last = values[0];
    for (int k = 1; k < count; ++k) {
      last = values[k] - below[k] * last;
      values[k] = last;
    }
    for (int k = 0; k < count; ++k) values[k] *= inverse[k];
    last = values[count - 1];
    for (int k = count - 1; k-- > 0;) {
      last = values[k] - above[k + 1] * last;
      values[k] = last;
    }
  } else if (in_order_) {
    sweep([values](int k) -> double& { return values[k]; });
  } else {
    const int* const unknown = unknown_.data();
    sweep([values, unknown](int k) -> double& { return values[unknown[k]]; });
  }
}

double SparseFactor::weight_of(int k, std::span<const double> below,
                               std::span<const double> diagonal) {
  double sum = diagonal[at(unknown_[at(k)])];
  if (chain_) {
    double z = 1.0;
    for (int i = k; i > 0 && z != 0.0; --i) {
      z = inverse_pivot_[at(i) - 1] > 0.0 ? -below[at(i)] * z : 0.0;
      sum += z * z * diagonal[at(unknown_[at(i) - 1])];
    }
    return sum;
  }
  // L^T z = -(row k of L), over the columns in which row k has entries.
  null_vector_.resize(unknown_.size());
  for (int p = row_start_[at(k)]; p < row_start_[at(k) + 1]; ++p) {
    null_vector_[at(below_[at(p)].column)] = 0.0;
  }
  for (int p = row_start_[at(k) + 1]; p-- > row_start_[at(k)];) {
    const auto [column, place] = below_[at(p)];
    double z = -below[at(place)];
    for (int q = factor_start_[at(column)]; q < place; ++q) {
      z -= below[at(q)] * null_vector_[at(row_of_[at(q)])];
    }
    if (!(inverse_pivot_[at(column)] > 0.0)) z = 0.0;
    null_vector_[at(column)] = z;
    sum += z * z * diagonal[at(unknown_[at(column)])];
  }
  return sum;
}

void SparseFactor::judge_pivot(int k, double pivot, double full, std::span<const double> diagonal) {
  // The comparison also drops a pivot that is NaN.
  bool kept = pivot > dropped_pivot * full;
  if (kept) {
    const double first = weight_of(k, factor_, diagonal);
    const double second = symmetric_ ? first : weight_of(k, upper_, diagonal);
    kept = pivot > dropped_noise * std::sqrt(first * second);
  }
  if (!kept) ++dropped_;
  inverse_pivot_[at(k)] = kept ? 1.0 / pivot : 0.0;
}

void SparseFactor::factor(std::span<const double> diagonal, std::span<const double> values) {
  symmetric_ = true;
  if (chain_) return factor_chain(diagonal, values, nullptr);
  dropped_ = 0;
  double* work = work_.data();
  double* factor = factor_.data();
  const int* row_of = row_of_.data();
  const int* factor_start = factor_start_.data();
  const double* inverse_pivot = inverse_pivot_.data();
  for (std::size_t k = 0; k < unknown_.size(); ++k) {
    for (int p = step_start_[k]; p < step_start_[k + 1]; ++p) {
      work[steps_[at(p)].row] = values[at(steps_[at(p)].value)];
    }
    const double full = diagonal[at(unknown_[k])];
    double pivot = full;
    const Below* end = below_.data() + row_start_[k + 1];
    for (const Below* below = below_.data() + row_start_[k]; below != end; ++below) {
      const int i = below->column;
      const double y = work[i];
      work[i] = 0.0;
      const int first = factor_start[i];
      for_few(
          below->place - first, [&](int e) __attribute__((always_inline)) {
            work[row_of[first + e]] -= factor[first + e] * y;
          });
      const double entry = y * inverse_pivot[i];
      pivot -= entry * y;
      factor[below->place] = entry;
    }
    keep_pivot(static_cast<int>(k), pivot, full, diagonal);
  }
}

void SparseFactor::factor(std::span<const double> diagonal, std::span<const double> values,
                          std::span<const double> transposed_values) {
  symmetric_ = false;
  upper_.resize(factor_.size());
  if (chain_) return factor_chain(diagonal, values, transposed_values.data());
  dropped_ = 0;
  double* work = work_.data();
  double* lower_work = lower_work_.data();
  double* factor = factor_.data();
  double* upper = upper_.data();
  const int* row_of = row_of_.data();
  for (std::size_t k = 0; k < unknown_.size(); ++k) {
    for (int p = step_start_[k]; p < step_start_[k + 1]; ++p) {
      const Entry& entry = steps_[at(p)];
      const double above = values[at(entry.value)];
      const double below = transposed_values[at(entry.value)];
      work[entry.row] = entry.turned ? below : above;
      lower_work[entry.row] = entry.turned ? above : below;
    }
    const double full = diagonal[at(unknown_[k])];
    double pivot = full;
    const Below* end = below_.data() + row_start_[k + 1];
    for (const Below* below = below_.data() + row_start_[k]; below != end; ++below) {
      const int i = below->column;
      // D U of column k, and L D of row k.
      const double y = work[i];
      const double z = lower_work[i];
      work[i] = lower_work[i] = 0.0;
      const int first = factor_start_[at(i)];
      for_few(
          below->place - first, [&](int e) __attribute__((always_inline)) {
            work[row_of[first + e]] -= factor[first + e] * y;
            lower_work[row_of[first + e]] -= upper[first + e] * z;
          });
      const double inverse = inverse_pivot_[at(i)];
      pivot -= z * inverse * y;
      factor[below->place] = z * inverse;
      upper[below->place] = y * inverse;
    }
    keep_pivot(static_cast<int>(k), pivot, full, diagonal);
  }
}

void SparseFactor::solve(std::span<double> x) {
  if (chain_) return solve_chain(x);
  const double* forth = factor_.data();
  const double* back = symmetric_ ? forth : upper_.data();
  const int* row_of = row_of_.data();
  const int* start = factor_start_.data();
  const int* unknown = unknown_.data();
  const double* inverse = inverse_pivot_.data();
  double* work = work_.data();
  const auto count = static_cast<int>(unknown_.size());
  for (int k = 0; k < count; ++k) work[k] = x[at(unknown[k])];
  for (int k = 0; k < count; ++k) {
    const double y = work[k];
    if (y == 0.0) continue;
    const int first = start[k];
    for_few(
        start[k + 1] - first, [&](int e) __attribute__((always_inline)) {
          work[row_of[first + e]] -= forth[first + e] * y;
        });
  }
  for (int k = count - 1; k >= 0; --k) {
    double y = work[k] * inverse[k];
    const int first = start[k];
    for_few(
        start[k + 1] - first, [&](int e) __attribute__((always_inline)) {
          y -= back[first + e] * work[row_of[first + e]];
        });
    // A dropped unknown is 0 whatever the others are.
    work[k] = inverse[k] > 0.0 ? y : 0.0;
  }
  for (int k = 0; k < count; ++k) {
    x[at(unknown[k])] = work[k];
    work[k] = 0.0;
  }
}

}  // namespace sheave
