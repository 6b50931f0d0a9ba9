#pragma once
// Central differences whose step is shortened while that makes them better; internal to statics.
//
// With two steps e and 2 e, whose errors of second order cancel, the derivative is
//
//   d = (4 d(e) - d(2e)) / 3,   d(e) = (f(e) - f(-e)) / 2 e.
//
// The difference between the two single results is the error of the worse one, which bounds that
// of d. A step that suits a large crane is too long for the short pendulum on it, so steps are
// shortened as long as the bound falls.

#include <utility>

#include "statics/configuration.h"

namespace sheave {

/// A derivative of a vector.
struct Difference {
  VectorX slope;
  double error = 0.0;  ///< a bound of the error of each entry
};

/// at(displacement) - at(-displacement), in this order: calls may start from where the last one
/// ended, and compilers choose the order of the operands of a difference.
template <class At>
[[nodiscard]] VectorX change_across(const At& at, double displacement) {
  VectorX ahead = at(displacement);
  ahead -= at(-displacement);
  return ahead;
}

/// Central differences of at(displacement) with one step.
template <class At>
[[nodiscard]] Difference difference_with(const At& at, double step) {
  const VectorX near = change_across(at, step) / (2.0 * step);
  const VectorX far = change_across(at, 2.0 * step) / (4.0 * step);
  return {(4.0 * near - far) / 3.0, (far - near).cwiseAbs().maxCoeff() / 3.0};
}

/// The derivative of at(displacement), a vector, at 0. `step`: the longest step.
template <class At>
[[nodiscard]] Difference difference(const At& at, double step) {
  constexpr double shorter = 0.125;
  constexpr int most_steps = 5;
  constexpr double good_enough = 1e-9;  // relative
  // Longer steps may lead beyond a kink, as to a rope that hangs in a fold, and tell nothing.
  constexpr double rough = 1e-3;  // relative
  Difference best = difference_with(at, step);
  for (int i = 1; i < most_steps; ++i) {
    if (best.error <= good_enough * best.slope.cwiseAbs().maxCoeff()) break;
    step *= shorter;
    Difference next = difference_with(at, step);
    if (next.error < best.error) {
      best = std::move(next);
    } else if (best.error <= rough * best.slope.cwiseAbs().maxCoeff()) {
      break;  // rounding dominates from here on
    }
  }
  return best;
}

}  // namespace sheave
