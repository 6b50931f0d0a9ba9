#pragma once
// A run whose certificate is that of `sheave run`, with a fault that may be planted on the way.

#include <functional>

#include <gtest/gtest.h>

#include "cable/run_check.h"
#include "tests/support/builders.h"

namespace sheave::test {

/// Runs to `time`; at the first step at or behind `when` the last body's velocity is multiplied.
/// `follows`: the work of sources is observed in every substep.
inline Certificate checked_run(const Machine& machine, double time, double when = 1e9,
                               double factor = 1.0, bool follows = true) {
  Simulation s = start(machine);
  RunCheck check(s);
  bool planted = false;
  while (s.world.state().time < time - 1e-9) {
    if (!planted && s.world.state().time >= when - 1e-9) {
      State state = s.world.state();
      state.bodies.back().velocity *= factor;
      EXPECT_TRUE(s.world.restore(state).empty());
      planted = true;
    }
    const StepReport report = s.step({}, follows ? check.within(s) : std::function<void()>(), {});
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
    check.observe(s, report.statistics, s.world.state().time >= time - 1e-9);
  }
  return check.certificate();
}

}  // namespace sheave::test
