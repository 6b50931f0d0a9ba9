#pragma once
// The text that `sheave run --estimate-error` prints.

#include <string>

#include "measure/error_estimate.h"

namespace sheave::command {

/// A table of the largest errors, worst first, and the conclusion.
[[nodiscard]] std::string error_estimate_text(const measure::ErrorEstimate& estimate);

/// One line without a line break: the errors of positions and tensions that are due to the step, or
/// the reason why they are unknown.
[[nodiscard]] std::string error_estimate_conclusion(const measure::ErrorEstimate& estimate);

}  // namespace sheave::command
