#include "engine/step_settings.h"

namespace sheave {

StepSettings StepSettings::paper() {
  return {1.0 / 60.0, 1, 10, SolverKind::gauss_seidel, IntegratorKind::xpbd, 0.0};
}

StepSettings StepSettings::of(StepPreset preset) {
  return preset == StepPreset::paper ? paper() : StepSettings{};
}

std::span<const Field> StepSettings::field_table() {
  static const std::array table{
      field<&StepSettings::dt>("dt", "s", above(0.0), optional, "time per step, one frame"),
      field<&StepSettings::substeps>("substeps", "", between(1, 100000), optional,
                                     "substeps per step"),
      field<&StepSettings::iterations>(
          "iterations", "", between(1, 1000000), optional,
          "sweeps over all constraint rows per substep; for the direct solver, the most rounds"),
      choice_field<&StepSettings::solver>(
          "solver", solver_names, optional,
          "gauss-seidel: row after row as in the paper, rough unless there are many iterations; "
          "direct: all rows at once, for more than a few wheels, light wheels, large mass ratios "
          "or accurate results (bench/SOLVERS.md)"),
      choice_field<&StepSettings::integrator>(
          "integrator", integrator_names, optional,
          "xpbd: as in the paper, of first order, with numerical damping that grows with the step; "
          "rattle: of second order, conserves energy"),
      field<&StepSettings::tolerance>(
          "tolerance", "m", at_least(0.0), optional,
          "in place of substeps: the error of positions that one second of motion may add; the "
          "lengths of substeps follow from it, also at events; needs direct and rattle; 0: fixed "
          "substeps"),
  };
  return table;
}

}  // namespace sheave
