#pragma once
// The text of close decisions that `sheave run --estimate-error` prints.

#include <string>

#include "measure/error_estimate.h"

namespace sheave::command {

/// A table of the least margins in units of their errors, and a line per close decision; empty if the
/// motion has no alternatives.
[[nodiscard]] std::string decision_text(const measure::ErrorEstimate& estimate);

}  // namespace sheave::command
