#pragma once
// Constant gradients in slices of one length, so that loops over them have no inner loop.

#include <algorithm>
#include <span>
#include <vector>

#include "engine/solvers/affine_kernels.h"
#include "engine/solvers/affine_rows.h"

namespace sheave {

class AffineTerms {
 public:
  static constexpr int most = 4;  ///< terms of a row: two ends, each on a rotor on a slider

  /// Takes the rows' gradients along `numbers` coordinates; false if a row has too many terms.
  [[nodiscard]] bool take(const AffineRows& rows, std::size_t numbers) {
    rows_ = rows.size();
    const std::span<const int> starts = rows.starts();
    int longest = 0;
    for (std::size_t i = 0; i < rows_; ++i) longest = std::max(longest, starts[i + 1] - starts[i]);
    if (longest > most) return false;
    width_ = longest > 2 ? most : 2;
    // Unused places hold terms of number 0, which no row moves.
    numbers_.assign(at(width_) * rows_, 0);
    gradients_.assign(at(width_) * rows_, 0.0);
    responses_ = gradients_;
    for (std::size_t i = 0; i < rows_; ++i) {
      for (int p = starts[i]; p < starts[i + 1]; ++p) {
        const std::size_t place = at(p - starts[i]) * rows_ + i;
        numbers_[place] = rows.numbers()[at(p)];
        gradients_[place] = rows.gradients()[at(p)];
      }
    }
    sort_by_numbers(numbers);
    return true;
  }
  /// Computes the responses along the gradients: W J^T with the inverse masses W.
  void weigh(std::span<const double> inverse_masses) {
    for (std::size_t p = 0; p < numbers_.size(); ++p) {
      responses_[p] = inverse_masses[at(numbers_[p])] * gradients_[p];
    }
    for (std::size_t p = 0; p < column_places_.size(); ++p) {
      if (column_places_[p] >= 0) column_responses_[p] = responses_[at(column_places_[p])];
    }
  }

  [[nodiscard]] AffineGradients gradients() const {
    return {rows_, at(width_), numbers_.data(), gradients_.data()};
  }
  template <int width>
  struct Slices {
    std::size_t rows;
    const int* numbers;
    const double* gradients;
    const double* responses;

    /// J x of a row.
    [[nodiscard, gnu::always_inline]] double along(std::size_t row, const double* x) const {
      double sum = gradients[row] * x[numbers[row]];
      for (std::size_t p = row + rows; p < static_cast<std::size_t>(width) * rows; p += rows) {
        sum += gradients[p] * x[numbers[p]];
      }
      return sum;
    }
    /// x += W J^T multiplier.
    [[gnu::always_inline]] void act(std::size_t row, double multiplier, double* x) const {
      for (std::size_t p = row; p < static_cast<std::size_t>(width) * rows; p += rows) {
        x[numbers[p]] += responses[p] * multiplier;
      }
    }
  };
  /// Calls visit() with the slices.
  template <class Visit>
  [[gnu::always_inline]] auto visit(Visit visit) const {
    if (width_ == 2) {
      return visit(Slices<2>{rows_, numbers_.data(), gradients_.data(), responses_.data()});
    }
    return visit(Slices<most>{rows_, numbers_.data(), gradients_.data(), responses_.data()});
  }

  /// x += W J^T multipliers, of all rows.
  void respond_to(const double* multipliers, double* x) const {
    if (column_width_ > 0) {
      return respond({column_count_, column_width_, column_rows_.data(), column_responses_.data()},
                     multipliers, x);
    }
    visit([&](const auto& terms) {
      for (std::size_t i = 0; i < rows_; ++i) terms.act(i, multipliers[i], x);
    });
  }

 private:
  static constexpr std::size_t most_rows =
      8;  ///< most rows of a number for which respond() is used

  /// The terms of each number, in the order of their rows.
  void sort_by_numbers(std::size_t numbers) {
    std::vector<std::vector<int>> places(numbers);
    for (std::size_t i = 0; i < rows_; ++i) {
      for (std::size_t p = i; p < numbers_.size(); p += rows_) {
        if (numbers_[p] != 0) places[at(numbers_[p])].push_back(static_cast<int>(p));
      }
    }
    std::size_t longest = 2;
    for (const std::vector<int>& of : places) longest = std::max(longest, of.size());
    column_count_ = numbers;
    column_width_ = longest > most_rows || rows_ == 0 ? 0
                    : longest <= 2                    ? 2
                    : longest <= 4                    ? 4
                                                      : most_rows;
    column_places_.assign(column_width_ * numbers, -1);
    column_rows_.assign(column_width_ * numbers, 0);
    column_responses_.assign(column_width_ * numbers, 0.0);
    for (std::size_t d = 0; d < numbers && column_width_ > 0; ++d) {
      for (std::size_t p = 0; p < places[d].size(); ++p) {
        column_places_[p * numbers + d] = places[d][p];
        column_rows_[p * numbers + d] = places[d][p] % static_cast<int>(rows_);
      }
    }
  }

  int width_ = 2;
  std::size_t rows_ = 0;
  std::vector<int> numbers_;
  std::vector<double> gradients_;
  std::vector<double> responses_;
  // Sorted by numbers; empty if a number has too many rows.
  std::size_t column_count_ = 0;
  std::size_t column_width_ = 0;
  std::vector<int> column_places_;  ///< places in responses_; -1: none
  std::vector<int> column_rows_;
  std::vector<double> column_responses_;
};

}  // namespace sheave
