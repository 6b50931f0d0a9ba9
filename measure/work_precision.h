#pragma once
// Accuracy against cost of many runs: the runs worth choosing, and the order of the error in the
// step.
//
// An error is known only to lie below error + doubt, where the doubt is the error of the reference.
// Choices use that bound, so that their promise holds; fits use only errors well above the doubt.

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace sheave::measure {

/// One run. Runs without a finite cost and bound (failed, not verified) are never chosen.
struct WorkPoint {
  double cost = std::numeric_limits<double>::infinity();   ///< any unit, >= 0
  double bound = std::numeric_limits<double>::infinity();  ///< upper bound of the error, >= 0
};

/// Indices of the points on the Pareto front, cheapest first: each has a bound below 0.99 times
/// that of every cheaper one. A smaller gain is within the uncertainty of times. Of equal points
/// the first.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const WorkPoint> points);

/// The cheapest point with bound <= `error`, on the front or not.
[[nodiscard]] std::optional<std::size_t> cheapest_within(std::span<const WorkPoint> points,
                                                         double error);
/// The most accurate point of the front with cost <= `budget`.
[[nodiscard]] std::optional<std::size_t> best_within(std::span<const WorkPoint> points,
                                                     double budget);

/// Error of a run with a given step.
struct StepError {
  double step = 0.0;   ///< [s], > 0
  double error = 0.0;  ///< relative, >= 0
  double doubt = 0.0;  ///< error of the reference
};

/// How errors fall with the step: error ~ step^order.
struct FittedOrder {
  double order = 0.0;
  int points = 0;  ///< number of points in the fit, >= 3
};

/// Slope of the straight line through log(error) over log(step) by least squares. Only errors
/// within the range of the law count: below 0.1, where bodies are still near their places, and
/// above three times the doubt and 1e-11, which is rounding. Nothing if fewer than three steps are
/// left.
[[nodiscard]] std::optional<FittedOrder> fitted_order(std::span<const StepError> errors);

}  // namespace sheave::measure
