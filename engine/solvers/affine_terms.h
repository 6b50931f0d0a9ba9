#pragma once
// Constant gradients in slices of one length, so that loops over them have no inner loop.

#include <algorithm>
#include <span>
#include <vector>

#include "engine/solvers/affine_rows.h"

namespace sheave {

class AffineTerms {
 public:
  static constexpr int most = 4;  ///< terms of a row: two ends, each on a rotor on a slider

  /// False if a row has more terms.
  [[nodiscard]] bool take(const AffineRows& rows) {
    const std::span<const int> starts = rows.starts();
    int longest = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      longest = std::max(longest, starts[i + 1] - starts[i]);
    }
    width_ = longest > 2 ? most : 2;
    const std::size_t width = at(width_);
    // What a slice does not need are terms of number 0, which nothing moves.
    numbers_.assign(width * rows.size(), 0);
    gradients_.assign(width * rows.size(), 0.0);
    responses_ = gradients_;
    for (std::size_t i = 0; i < rows.size() && longest <= most; ++i) {
      const auto first = static_cast<std::ptrdiff_t>(starts[i]);
      const auto count = static_cast<std::size_t>(starts[i + 1] - starts[i]);
      const auto slice = static_cast<std::ptrdiff_t>(width * i);
      std::copy_n(rows.numbers().begin() + first, count, numbers_.begin() + slice);
      std::copy_n(rows.gradients().begin() + first, count, gradients_.begin() + slice);
    }
    return longest <= most;
  }
  /// How numbers respond along the gradients: W J^T of the inverse masses W.
  void weigh(std::span<const double> inverse_masses) {
    for (std::size_t p = 0; p < numbers_.size(); ++p) {
      responses_[p] = inverse_masses[at(numbers_[p])] * gradients_[p];
    }
  }

  template <int width>
  struct Slices {
    const int* numbers;
    const double* gradients;
    const double* responses;

    /// J x of a row.
    [[nodiscard, gnu::always_inline]] double along(std::size_t row, const double* x) const {
      const std::size_t first = static_cast<std::size_t>(width) * row;
      double sum = 0.0;
      for (std::size_t p = first; p < first + static_cast<std::size_t>(width); ++p) {
        sum += gradients[p] * x[numbers[p]];
      }
      return sum;
    }
    /// x += W J^T multiplier.
    [[gnu::always_inline]] void act(std::size_t row, double multiplier, double* x) const {
      const std::size_t first = static_cast<std::size_t>(width) * row;
      for (std::size_t p = first; p < first + static_cast<std::size_t>(width); ++p) {
        x[numbers[p]] += responses[p] * multiplier;
      }
    }
  };
  /// Calls visit() with the slices.
  template <class Visit>
  [[gnu::always_inline]] auto visit(Visit visit) const {
    if (width_ == 2) {
      return visit(Slices<2>{numbers_.data(), gradients_.data(), responses_.data()});
    }
    return visit(Slices<most>{numbers_.data(), gradients_.data(), responses_.data()});
  }

 private:
  int width_ = 2;
  std::vector<int> numbers_;
  std::vector<double> gradients_;
  std::vector<double> responses_;
};

}  // namespace sheave
