#pragma once
// Accuracy against cost of many runs: which are worth choosing, and how fast the error falls with
// the step.
//
// An error is only known to lie below error + doubt, where the doubt is the reference's own.
// Choices are made with that bound, so that what is promised holds; fits only take errors that are
// well above the doubt.

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace sheave::measure {

/// One run. Those without a finite cost and bound (failed, not verified) are never chosen.
struct WorkPoint {
  double cost = std::numeric_limits<double>::infinity();   ///< any unit, >= 0
  double bound = std::numeric_limits<double>::infinity();  ///< that the error does not exceed, >= 0
};

/// Indices of the points that are worth their cost, cheapest first: each has a bound below 0.99
/// times that of every cheaper one. Less is no gain, for times are not known better than that. Of
/// equal points the first.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const WorkPoint> points);

/// The cheapest with bound <= `error`, whether it is on the front or not.
[[nodiscard]] std::optional<std::size_t> cheapest_within(std::span<const WorkPoint> points,
                                                         double error);
/// The most accurate of the front with cost <= `budget`.
[[nodiscard]] std::optional<std::size_t> best_within(std::span<const WorkPoint> points,
                                                     double budget);

/// Error of a run with a step.
struct StepError {
  double step = 0.0;   ///< [s], > 0
  double error = 0.0;  ///< relative, >= 0
  double doubt = 0.0;  ///< the reference's own error
};

/// How errors fall with the step: error ~ step^order.
struct FittedOrder {
  double order = 0.0;
  int points = 0;  ///< that the fit is made from, >= 3
};

/// Slope of the straight line through log(error) over log(step) by least squares. Only errors count
/// that the law can hold for: below 0.1, where bodies are still about where they should be, and
/// above three times the doubt and 1e-11, which is rounding. Nothing if fewer than three steps are
/// left.
[[nodiscard]] std::optional<FittedOrder> fitted_order(std::span<const StepError> errors);

}  // namespace sheave::measure
