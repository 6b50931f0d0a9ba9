#pragma once
// What to change about the settings of a run that went wrong. It never names what is in use
// already.

#include <string>

#include "engine/step_settings.h"

namespace sheave::command {

/// What was wrong.
enum class StepFault {
  unconverged,  ///< the solver left constraints open
  long_step,    ///< motion was damped or distorted by the integrator
  either,       ///< one of the two, nobody knows which
};

/// "more iterations or the direct solver (--solver direct)", for these settings.
[[nodiscard]] std::string remedy(const StepSettings& step, StepFault fault);

}  // namespace sheave::command
