#include "measure/work_precision.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace sheave::measure {
namespace {

constexpr double largest_fitted_error = 0.1;
constexpr double smallest_fitted_error = 1e-11;
constexpr double well_above_doubt = 3.0;
constexpr double least_gain = 0.99;

bool usable(const WorkPoint& point) {
  return std::isfinite(point.cost) && std::isfinite(point.bound);
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const WorkPoint> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (usable(points[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(points[a].cost, points[a].bound) < std::tie(points[b].cost, points[b].bound);
  });
  // From the cheapest on, each point that is better than all cheaper ones.
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    if (front.empty() || points[i].bound < least_gain * points[front.back()].bound)
      front.push_back(i);
  }
  return front;
}

std::optional<std::size_t> cheapest_within(std::span<const WorkPoint> points, double error) {
  std::optional<std::size_t> cheapest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!usable(points[i]) || points[i].bound > error) continue;
    if (!cheapest || points[i].cost < points[*cheapest].cost) cheapest = i;
  }
  return cheapest;
}

std::optional<std::size_t> best_within(std::span<const WorkPoint> points, double budget) {
  std::optional<std::size_t> best;
  for (const std::size_t i : pareto_front(points)) {
    if (points[i].cost <= budget) best = i;
  }
  return best;
}

std::optional<FittedOrder> fitted_order(std::span<const StepError> errors) {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  std::set<double> steps;
  for (const StepError& own : errors) {
    const double floor = std::max(smallest_fitted_error, well_above_doubt * own.doubt);
    if (!(own.error > floor && own.error < largest_fitted_error)) continue;
    const double log_step = std::log(own.step);
    const double log_error = std::log(own.error);
    steps.insert(own.step);
    n += 1.0;
    x += log_step;
    y += log_error;
    xx += log_step * log_step;
    xy += log_step * log_error;
  }
  if (steps.size() < 3) return {};
  return FittedOrder{(n * xy - x * y) / (n * xx - x * x), static_cast<int>(n)};
}

}  // namespace sheave::measure
