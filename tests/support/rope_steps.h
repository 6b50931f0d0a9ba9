#pragma once
// Settings of the step for tests of ropes with weight and inertia.

#include "tests/support/builders.h"

namespace sheave::test {

/// Steps of 1/60 s with at most 50 rounds in each substep.
inline StepSettings step_of(SolverKind solver, IntegratorKind integrator, int substeps) {
  StepSettings step = settings(1.0 / 60.0, substeps, 50);
  step.solver = solver;
  step.integrator = integrator;
  return step;
}

/// The same of second order.
inline StepSettings accurate(int substeps) {
  return step_of(SolverKind::direct, IntegratorKind::rattle, substeps);
}

}  // namespace sheave::test
