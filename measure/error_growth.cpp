#include "measure/error_growth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheave::measure {
namespace {

constexpr double least_error = 1e-12;
constexpr double saturated = 0.03;
constexpr std::size_t fewest_frames = 10;
constexpr double least_growth = 100.0;
/// Part of the variance that a law may leave unexplained. No law describes the jump of an impact.
constexpr double unexplained = 0.1;

/// A straight line through points by least squares.
struct Line {
  double slope = 0.0;
  double residual = 0.0;  ///< sum of squares
  double total = 0.0;     ///< the same for a line without slope
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

Line fit(const std::vector<double>& x, const std::vector<double>& y) {
  const double x_mean = mean_of(x);
  const double y_mean = mean_of(y);
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x_mean) * (x[i] - x_mean);
    xy += (x[i] - x_mean) * (y[i] - y_mean);
    yy += (y[i] - y_mean) * (y[i] - y_mean);
  }
  return {xy / xx, yy - xy * xy / xx, yy};
}

}  // namespace

ErrorGrowth error_growth(std::span<const double> errors, double dt, double level) {
  ErrorGrowth growth;
  growth.trusted_frames = errors.size();
  std::vector<double> times;
  std::vector<double> log_times;
  std::vector<double> log_errors;
  double largest = 0.0;
  for (std::size_t f = 0; f < errors.size(); ++f) {
    largest = std::max(largest, errors[f]);
    if (largest > level) growth.trusted_frames = std::min(growth.trusted_frames, f);
    if (f == 0 || largest < least_error || largest > saturated) continue;
    times.push_back(dt * static_cast<double>(f));
    log_times.push_back(std::log(times.back()));
    log_errors.push_back(std::log(largest));
  }
  growth.trusted_frames = std::max<std::size_t>(growth.trusted_frames, 1);
  if (times.size() < fewest_frames) return growth;
  if (log_errors.back() - log_errors.front() < std::log(least_growth)) return growth;
  const Line exponential = fit(times, log_errors);
  const Line power = fit(log_times, log_errors);
  const bool fits = exponential.residual < unexplained * exponential.total;
  if (fits && exponential.residual < power.residual) growth.rate = exponential.slope;
  return growth;
}

Trajectory first_frames(const Trajectory& run, std::size_t frames) {
  Trajectory part = run;
  part.frames.resize(std::clamp<std::size_t>(frames, 1, run.frames.size()));
  return part;
}

}  // namespace sheave::measure
