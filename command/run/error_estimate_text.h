#pragma once
// What `sheave run --estimate-error` tells people.

#include <string>

#include "measure/error_estimate.h"

namespace sheave::command {

/// A table of what differs most, worst first, and the conclusion.
[[nodiscard]] std::string error_estimate_text(const measure::ErrorEstimate& estimate);

/// One line without a line break: how wrong positions and tensions are by the step alone, or why
/// nobody can tell.
[[nodiscard]] std::string error_estimate_conclusion(const measure::ErrorEstimate& estimate);

}  // namespace sheave::command
