#pragma once
// A function of time given by a few points.

#include <vector>

namespace sheave {

/// Piecewise linear through (times[i], values[i]), constant before the first and after the last point. Times increase
/// strictly. Without times it is the constant values[0]; without values it is 0.
struct TimeTable {
  std::vector<double> times;  ///< [s]
  std::vector<double> values;

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] double at(double time) const;
  /// Slope [per s]; at a corner that of the piece which ends there.
  [[nodiscard]] double rate(double time) const;
  /// Integral from `from` to `to` [s], from <= to; exact.
  [[nodiscard]] double integral(double from, double to) const;
};

}  // namespace sheave
