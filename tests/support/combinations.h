#pragma once
// Every solver with every integrator.

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "engine/step_settings.h"

namespace sheave::test {

struct Combination {
  SolverKind solver = SolverKind::direct;
  IntegratorKind integrator = IntegratorKind::xpbd;
  [[nodiscard]] bool rattle() const { return integrator == IntegratorKind::rattle; }
};
inline constexpr std::array<Combination, 4> combinations{{
    {SolverKind::gauss_seidel, IntegratorKind::xpbd},
    {SolverKind::gauss_seidel, IntegratorKind::rattle},
    {SolverKind::direct, IntegratorKind::xpbd},
    {SolverKind::direct, IntegratorKind::rattle},
}};
inline std::string combination_name(const ::testing::TestParamInfo<Combination>& info) {
  return std::string(info.param.solver == SolverKind::direct ? "direct" : "gauss_seidel") +
         (info.param.rattle() ? "_rattle" : "_xpbd");
}

/// A test that runs with each of them.
class ForEveryCombination : public ::testing::TestWithParam<Combination> {
 protected:
  /// Steps of `h` [s] with so many sweeps or rounds.
  [[nodiscard]] static StepSettings step_settings(double h, int iterations) {
    StepSettings step;
    step.dt = h;
    step.substeps = 1;
    step.iterations = iterations;
    step.solver = GetParam().solver;
    step.integrator = GetParam().integrator;
    return step;
  }
};

}  // namespace sheave::test
