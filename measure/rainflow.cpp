#include "measure/rainflow.h"

#include <algorithm>
#include <cmath>

namespace sheave::measure {
namespace {

LoadCycle cycle(double from, double to, double count) {
  return {std::abs(to - from), 0.5 * (from + to), count};
}

}  // namespace

void Rainflow::close(std::vector<double>& points, std::vector<LoadCycle>& cycles) {
  // With the last three points, range X between the last two and Y between the two before: Y is
  // closed once X is no smaller. If it has the first point of all, it is a half cycle.
  while (points.size() >= 3) {
    const std::size_t n = points.size();
    const double last = std::abs(points[n - 1] - points[n - 2]);
    const double before = std::abs(points[n - 2] - points[n - 3]);
    if (last < before) break;
    if (n == 3) {
      cycles.push_back(cycle(points[0], points[1], 0.5));
      points.erase(points.begin());
    } else {
      cycles.push_back(cycle(points[n - 3], points[n - 2], 1.0));
      points.erase(points.end() - 3, points.end() - 1);
    }
  }
}

void Rainflow::add(double value) {
  const std::size_t n = points_.size();
  if (n > 0 && value == points_.back()) return;
  if (n >= 2 && (value > points_[n - 1]) == (points_[n - 1] > points_[n - 2])) {
    points_.back() = value;  // it goes on the same way
    return;
  }
  // The last point was a turning point.
  close(points_, cycles_);
  points_.push_back(value);
}

std::vector<LoadCycle> Rainflow::cycles() const {
  std::vector<LoadCycle> result = cycles_;
  std::vector<double> points = points_;
  close(points, result);
  for (std::size_t i = 1; i < points.size(); ++i) {
    result.push_back(cycle(points[i - 1], points[i], 0.5));
  }
  return result;
}

std::vector<double> range_histogram(const std::vector<LoadCycle>& cycles, int bins) {
  std::vector<double> counts(static_cast<std::size_t>(bins), 0.0);
  double largest = 0.0;
  for (const LoadCycle& one : cycles) largest = std::max(largest, one.range);
  if (!(largest > 0.0)) return counts;
  for (const LoadCycle& one : cycles) {
    const auto bin = static_cast<std::size_t>(one.range / largest * bins);
    counts[std::min(bin, counts.size() - 1)] += one.count;
  }
  return counts;
}

}  // namespace sheave::measure
