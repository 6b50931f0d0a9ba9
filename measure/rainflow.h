#pragma once
// Cycles of a load over time, by the rainflow method (ASTM E1049-85, 5.4.4 and 5.4.5).

#include <vector>

namespace sheave::measure {

struct LoadCycle {
  double range = 0.0;  ///< largest minus smallest value
  double mean = 0.0;   ///< mean of the largest and the smallest value
  double count = 0.0;  ///< 1: a full cycle, 0.5: a half cycle
};

/// Takes values one by one; keeps closed cycles, and the turning points that have not closed a
/// cycle.
class Rainflow {
 public:
  void add(double value);
  /// The cycles so far; open ones count as half cycles (5.4.4).
  [[nodiscard]] std::vector<LoadCycle> cycles() const;
  /// The cycles of a history that repeats (5.4.5). All are full; loading and unloading form one
  /// cycle. Open cycles at the end are closed by the next repetition.
  [[nodiscard]] std::vector<LoadCycle> closed_cycles() const;

 private:
  std::vector<double> points_;     ///< turning points; the last may still change
  std::vector<LoadCycle> cycles_;  ///< full cycles
};

/// Cycles in bins of equal widths from 0 to the largest range: their counts.
[[nodiscard]] std::vector<double> range_histogram(const std::vector<LoadCycle>& cycles, int bins);

}  // namespace sheave::measure
