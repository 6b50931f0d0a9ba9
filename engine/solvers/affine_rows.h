#pragma once
// Rows with constant gradients along the coordinates of bodies that move along straight lines.

#include <cstddef>
#include <span>
#include <vector>

#include "engine/index.h"

namespace sheave {

struct StepStatistics;

/// Unilateral rows C >= 0 whose multiplier is at least 0, as slices of flat arrays.
class AffineRows {
 public:
  /// Begins a row with this compliance [m/N] and damping [N s/m]. `index`: index of its multiplier
  /// among those of its feature.
  void add_row(double compliance, double damping, int index) {
    compliances_.push_back(compliance);
    dampings_.push_back(damping);
    indices_.push_back(index);
    starts_.push_back(starts_.back());
  }
  /// Adds to the gradient of the last row along the coordinate `number`; number 0 adds nothing.
  void add_term(int number, double gradient) {
    if (number == 0) return;
    for (int p = starts_[starts_.size() - 2]; p < starts_.back(); ++p) {
      if (numbers_[at(p)] != number) continue;
      gradients_[at(p)] += gradient;
      return;
    }
    numbers_.push_back(number);
    gradients_.push_back(gradient);
    ++starts_.back();
  }

  [[nodiscard]] std::size_t size() const { return compliances_.size(); }
  [[nodiscard]] double compliance(std::size_t row) const { return compliances_[row]; }
  [[nodiscard]] double damping(std::size_t row) const { return dampings_[row]; }
  [[nodiscard]] int index(std::size_t row) const { return indices_[row]; }
  // The terms of row i are those from starts()[i] to starts()[i + 1].
  [[nodiscard]] std::span<const int> starts() const { return starts_; }
  [[nodiscard]] std::span<const int> numbers() const { return numbers_; }
  [[nodiscard]] std::span<const double> gradients() const { return gradients_; }

 private:
  std::vector<double> compliances_;
  std::vector<double> dampings_;
  std::vector<int> indices_;
  std::vector<int> starts_{0};
  std::vector<int> numbers_;
  std::vector<double> gradients_;
};

/// A substep of such a machine, as a feature sees it.
struct AffineSubstep {
  double end_time = 0.0;           ///< [s]
  double h = 0.0;                  ///< [s]
  std::span<const double> places;  ///< per number, at the start [m], [rad]
  std::span<const double> speeds;  ///< per number, at the start [m/s], [rad/s]
  std::span<const double> motion;  ///< displacements; at the start of a substep without constraints
  std::span<const double> multipliers;  ///< of the feature's rows: mean force times h squared
  bool dissipates = false;              ///< the integrator is implicit Euler (`xpbd`)
  StepStatistics* statistics = nullptr;
  /// The state at the start is not the result of the substep before.
  bool fresh = true;
  /// First substep of a call; other callers may have used the feature since the last call.
  bool first = true;
};

}  // namespace sheave
