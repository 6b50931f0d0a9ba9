#pragma once
// Cycles of a load over time, by the rainflow method (ASTM E1049-85, 5.4.4 and 5.4.5).

#include <vector>

namespace sheave::measure {

struct LoadCycle {
  double range = 0.0;  ///< largest less smallest value
  double mean = 0.0;   ///< half way between them
  double count = 0.0;  ///< 1: a whole cycle, 0.5: a half of one
};

/// Takes values one by one; keeps turning points that have not closed a cycle, and what has.
class Rainflow {
 public:
  void add(double value);
  /// The cycles so far; what has not closed counts as halves (5.4.4).
  [[nodiscard]] std::vector<LoadCycle> cycles() const;
  /// The cycles of a history that repeats itself (5.4.5): all are whole, loading and unloading are
  /// one. What has not come back when it ends comes back when it begins again.
  [[nodiscard]] std::vector<LoadCycle> closed_cycles() const;

 private:
  std::vector<double> points_;     ///< turning points; the last one may still move on
  std::vector<LoadCycle> cycles_;  ///< whole ones
};

/// Cycles in bins of equal widths from 0 to the largest range: their counts.
[[nodiscard]] std::vector<double> range_histogram(const std::vector<LoadCycle>& cycles, int bins);

}  // namespace sheave::measure
