// Advice fits the settings in use: it never advises what is in use already, and always something.

#include "command/run/remedy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sheave::command {
namespace {

using testing::HasSubstr;
using testing::Not;

StepSettings with(SolverKind solver, IntegratorKind integrator) {
  StepSettings step;
  step.solver = solver;
  step.integrator = integrator;
  return step;
}

TEST(Remedy, NeverNamesSettingsInUse) {
  for (const SolverKind solver : {SolverKind::gauss_seidel, SolverKind::direct}) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      for (const StepFault fault :
           {StepFault::unconverged, StepFault::long_step, StepFault::either}) {
        const std::string text = remedy(with(solver, integrator), fault);
        EXPECT_THAT(text, testing::StartsWith("more "));
        if (solver == SolverKind::direct) {
          EXPECT_THAT(text, Not(HasSubstr("direct")));
          EXPECT_THAT(text, Not(HasSubstr("iterations")));
        }
        if (integrator == IntegratorKind::rattle) {
          EXPECT_THAT(text, Not(HasSubstr("rattle")));
        }
      }
    }
  }
}

TEST(Remedy, NamesSettingsThatHelp) {
  const StepSettings paper = with(SolverKind::gauss_seidel, IntegratorKind::xpbd);
  EXPECT_EQ(remedy(paper, StepFault::unconverged),
            "more iterations or the direct solver (--solver direct)");
  EXPECT_EQ(remedy(paper, StepFault::long_step), "more substeps or rattle (--integrator rattle)");
  EXPECT_EQ(remedy(paper, StepFault::either),
            "more substeps, more iterations or the direct solver (--solver direct)");
  const StepSettings best = with(SolverKind::direct, IntegratorKind::rattle);
  EXPECT_EQ(remedy(best, StepFault::unconverged), "more substeps");
  EXPECT_EQ(remedy(best, StepFault::long_step), "more substeps");
  EXPECT_EQ(remedy(with(SolverKind::direct, IntegratorKind::xpbd), StepFault::long_step),
            "more substeps or rattle (--integrator rattle)");
}

}  // namespace
}  // namespace sheave::command
