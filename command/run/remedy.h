#pragma once
// Advice which settings of a failed run to change. Settings that are already in use are not
// advised.

#include <string>

#include "engine/step_settings.h"

namespace sheave::command {

/// The cause of the failure.
enum class StepFault {
  unconverged,  ///< the solver left residuals
  long_step,    ///< motion was damped or distorted by the integrator
  either,       ///< one of the two; the cause is unknown
};

/// The advice for these settings, e.g. "more iterations or the direct solver (--solver direct)".
[[nodiscard]] std::string remedy(const StepSettings& step, StepFault fault);

}  // namespace sheave::command
