#include "engine/step_settings.h"

namespace sheave {

std::span<const Field> StepSettings::field_table() {
  static const std::array table{
      field<&StepSettings::dt>("dt", "s", above(0.0), optional, "time per step, one frame"),
      field<&StepSettings::substeps>("substeps", "", between(1, 100000), optional,
                                     "substeps per step"),
      field<&StepSettings::iterations>("iterations", "", between(1, 1000000), optional,
                                       "sweeps over all constraint rows per substep; of the direct "
                                       "solver, rounds at most"),
      choice_field<&StepSettings::solver>(
          "solver", solver_names, optional,
          "how the rows of a substep are solved: one after the other "
          "as in the paper, or all at once"),
      choice_field<&StepSettings::integrator>("integrator", integrator_names, optional,
                                              "how states are carried forward in time"),
  };
  return table;
}

}  // namespace sheave
