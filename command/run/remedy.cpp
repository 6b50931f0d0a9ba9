#include "command/run/remedy.h"

#include <vector>

namespace sheave::command {

std::string remedy(const StepSettings& step, StepFault fault) {
  const bool sweeps = step.solver == SolverKind::gauss_seidel;
  const bool solver = fault != StepFault::long_step;
  std::vector<std::string> changes;
  // The residual of sweeps does not shrink with shorter substeps, which only distribute it.
  if (!(sweeps && fault == StepFault::unconverged)) changes.emplace_back("more substeps");
  if (sweeps && solver) {
    changes.emplace_back("more iterations");
    changes.emplace_back("the direct solver (--solver direct)");
  }
  if (fault == StepFault::long_step && step.integrator == IntegratorKind::xpbd) {
    changes.emplace_back("rattle (--integrator rattle)");
  }
  std::string text = changes.front();
  for (std::size_t i = 1; i < changes.size(); ++i) {
    text += (i + 1 == changes.size() ? " or " : ", ") + changes[i];
  }
  return text;
}

}  // namespace sheave::command
