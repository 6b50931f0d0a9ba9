#pragma once
// Medians and quartiles of repeated measurements.

#include <vector>

namespace sheave::measure {

/// Where measured values lie. Quartiles rather than a standard deviation, because whatever else
/// runs on a machine makes single measurements late by any amount, and none early.
struct Spread {
  double median = 0.0;
  double lower = 0.0;  ///< a quarter of the values lies below
  double upper = 0.0;  ///< a quarter above
  double minimum = 0.0;
  int count = 0;
};

/// The value below which a `share` (0 ... 1) of them lies, linear between neighbours; NaN without
/// values.
[[nodiscard]] double quantile(std::vector<double> values, double share);
[[nodiscard]] Spread spread_of(const std::vector<double>& values);

}  // namespace sheave::measure
