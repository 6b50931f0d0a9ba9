#pragma once
// Medians and quartiles of repeated measurements.

#include <vector>

namespace sheave::measure {

/// Distribution of measured values. Quartiles instead of a standard deviation, because other load
/// on a machine delays single measurements by any amount and never makes one too short.
struct Spread {
  double median = 0.0;
  double lower = 0.0;  ///< a quarter of the values lies below
  double upper = 0.0;  ///< a quarter of the values lies above
  double minimum = 0.0;
  int count = 0;
};

/// The value below which a fraction `share` (0 ... 1) of the values lies, linear between
/// neighbours; NaN without values.
[[nodiscard]] double quantile(std::vector<double> values, double share);
[[nodiscard]] Spread spread_of(const std::vector<double>& values);

}  // namespace sheave::measure
