#include "measure/rainflow.h"

#include <algorithm>
#include <cmath>

namespace sheave::measure {
namespace {

LoadCycle cycle(double from, double to, double count) {
  return {std::abs(to - from), 0.5 * (from + to), count};
}

/// A range between two turning points that does not exceed its neighbours is a full cycle.
void close_whole(std::vector<double>& points, std::vector<LoadCycle>& cycles) {
  while (points.size() >= 4) {
    const std::size_t n = points.size();
    const double last = std::abs(points[n - 1] - points[n - 2]);
    const double inner = std::abs(points[n - 2] - points[n - 3]);
    const double first = std::abs(points[n - 3] - points[n - 4]);
    if (inner > last || inner > first) break;
    cycles.push_back(cycle(points[n - 3], points[n - 2], 1.0));
    points.erase(points.end() - 3, points.end() - 1);
  }
}

/// Adds a value to turning points: as a new one, or as the end of a continued range.
void turn_to(double value, std::vector<double>& points) {
  const std::size_t n = points.size();
  if (n > 0 && value == points.back()) return;
  if (n >= 2 && (value > points[n - 1]) == (points[n - 1] > points[n - 2])) {
    points.back() = value;
  } else {
    points.push_back(value);
  }
}

}  // namespace

void Rainflow::add(double value) {
  const std::size_t before = points_.size();
  if (before > 0 && value == points_.back()) return;
  const bool goes_on =
      before >= 2 && (value > points_[before - 1]) == (points_[before - 1] > points_[before - 2]);
  // Otherwise the last point was a turning point.
  if (!goes_on) close_whole(points_, cycles_);
  turn_to(value, points_);
}

std::vector<LoadCycle> Rainflow::cycles() const {
  std::vector<LoadCycle> result = cycles_;
  std::vector<double> rest = points_;
  close_whole(rest, result);
  // The remaining ranges grow, then shrink. A range from the very first point is a half cycle once
  // the next range is not smaller, and so are all remaining ones.
  for (std::size_t i = 1; i < rest.size(); ++i) {
    result.push_back(cycle(rest[i - 1], rest[i], 0.5));
  }
  return result;
}

std::vector<LoadCycle> Rainflow::closed_cycles() const {
  std::vector<LoadCycle> result = cycles_;
  std::vector<double> rest = points_;
  close_whole(rest, result);
  if (rest.size() < 2) return result;
  // From the largest value round to itself, no range exceeds the first one, so every range that is
  // not larger than the next is a full cycle.
  const auto largest = std::max_element(rest.begin(), rest.end());
  std::vector<double> ring;
  for (auto i = largest; i != rest.end(); ++i) turn_to(*i, ring);
  for (auto i = rest.begin(); i != largest + 1; ++i) turn_to(*i, ring);
  std::vector<double> points;
  for (const double value : ring) {
    points.push_back(value);
    while (points.size() >= 3) {
      const std::size_t n = points.size();
      const double last = std::abs(points[n - 1] - points[n - 2]);
      const double inner = std::abs(points[n - 2] - points[n - 3]);
      if (last < inner) break;
      result.push_back(cycle(points[n - 3], points[n - 2], 1.0));
      points.erase(points.end() - 3, points.end() - 1);
    }
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
