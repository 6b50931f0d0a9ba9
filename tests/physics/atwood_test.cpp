// Two weights over a heavy wheel, and what hangs on elastic cables at rest.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::g;

struct Outcome {
  double acceleration = 0.0;  // of the right weight, downwards
  double left_tension = 0.0;
  double right_tension = 0.0;
};

Outcome simulate(const test::Machine& machine, double time) {
  Simulation s = test::start(machine);
  test::run(s.world, time);
  const CableReport report = s.cable_reports()[0];
  return {-s.world.velocity({2}).y() / s.world.state().time, report.spans[0].tension,
          report.spans[1].tension};
}

// All forces are constant, and XPBD integrates constant forces exactly: what is left is the solver.
// With J' = I/r^2 = 0.8 kg, Gauss-Seidel on the two spans shrinks the error by
// q = (1/J')^2 / ((1/m1 + 1/J') (1/m2 + 1/J')) = 0.39 per iteration, and what a substep leaves
// unsolved stays in the positions for the next, so the transient decays over all iterations since
// the start: 30 steps of 10 leave nothing but rounding, v = (x' - x) / h with x of 2 m.
TEST(Atwood, HeavyWheelHasClosedFormAccelerationAndTensions) {
  test::Atwood atwood;
  for (const auto& [iterations, tolerance] : {std::pair{1, 1e-6}, std::pair{10, 1e-11}}) {
    test::Machine machine = atwood.machine();
    machine.model.step = test::settings(1.0 / 60.0, 1, iterations);
    const double a = atwood.acceleration();
    const Outcome outcome = simulate(machine, 0.5);
    EXPECT_NEAR(outcome.acceleration, a, tolerance * a);
    EXPECT_NEAR(outcome.left_tension, atwood.m1 * (g + a), tolerance * atwood.m1 * g);
    EXPECT_NEAR(outcome.right_tension, atwood.m2 * (g - a), tolerance * atwood.m2 * g);
  }
}

// The worst q above over m2/m1 is that of m2 -> infinity, (1/J')/(1/m1 + 1/J') = 0.56. One
// iteration is enough here (0.03 % of the tensions); two leave 1e-8.
TEST(Atwood, MassRatiosUpToAMillionStayWithinOnePercent) {
  for (double ratio = 1.0; ratio < 2e6; ratio *= 10.0) {
    for (const bool heavy_right : {true, false}) {
      test::Atwood atwood;
      atwood.m1 = heavy_right ? 1.0 : ratio;
      atwood.m2 = heavy_right ? ratio : 1.0;
      test::Machine machine = atwood.machine();
      machine.model.step = test::settings(1.0 / 60.0, 1, 1);
      const double a = atwood.acceleration();
      const Outcome outcome = simulate(machine, 0.5);
      EXPECT_NEAR(outcome.acceleration, a, 1e-3 * g) << ratio;
      EXPECT_NEAR(outcome.left_tension, atwood.m1 * (g + a), 1e-3 * atwood.m1 * (g + a)) << ratio;
      EXPECT_NEAR(outcome.right_tension, atwood.m2 * (g - a), 1e-3 * atwood.m2 * g) << ratio;
    }
  }
}

// Each span stretches by T alpha = m g alpha. The settling leaves exp(-b t / 2m) of the start.
TEST(CableStretch, IsForceTimesCompliance) {
  for (const double compliance : {0.01, 0.001, 1e-6}) {
    test::Machine machine = test::Atwood{.m1 = 2.0, .m2 = 2.0}.machine();
    machine.model.step = test::settings(0.01, 10, 100);
    machine.cables[0].compliance = compliance;
    machine.cables[0].damping = 2.0 * std::sqrt(2.0 / compliance);
    Simulation s = test::start(machine);
    test::run(s.world, 5.0);
    const std::vector<SpanReport> spans = s.cable_reports()[0].spans;
    for (const SpanReport& span : spans) {
      EXPECT_NEAR(span.length - span.rest_length, 2.0 * g * compliance,
                  1e-6 * 2.0 * g * compliance);
      EXPECT_NEAR(span.tension, 2.0 * g, 1e-6 * 2.0 * g);
    }
  }
}

TEST(CableStretch, OfAMaterialIsForceTimesLengthOverStiffness) {
  constexpr double stiffness = 5000.0;
  test::Machine machine = test::Atwood{.m1 = 2.0, .m2 = 2.0, .inertia = 0.02}.machine();
  machine.model.bodies[1].position.y() = -1.0;  // unequal sides
  machine.model.step = test::settings(0.01, 10, 200);
  machine.cables[0].axial_stiffness = stiffness;
  machine.cables[0].damping = 100.0;
  Simulation s = test::start(machine);
  test::run(s.world, 5.0);
  const std::vector<SpanReport> spans = s.cable_reports()[0].spans;
  for (const SpanReport& span : spans) {
    const double stretch = 2.0 * g * span.rest_length / stiffness;
    EXPECT_NEAR(span.length - span.rest_length, stretch, 1e-4 * stretch);
    EXPECT_NEAR(span.tension, 2.0 * g, 1e-4 * 2.0 * g);
  }
}

// Weights m and m at the ends of a cable over an odd number of wheels: nothing moves.
TEST(BalancedWheelTrain, StaysAtRest) {
  test::Machine machine = test::wheel_train(5, 1.0, 1.0, 0.2, 0.02);
  machine.model.step = test::settings(1.0 / 60.0, 1, 200);
  Simulation s = test::start(machine);
  test::run(s.world, 2.0);
  const std::vector<SpanReport> spans = s.cable_reports()[0].spans;
  for (const SpanReport& span : spans) {
    EXPECT_NEAR(span.tension, g, 1e-9 * g);
  }
  EXPECT_NEAR(s.world.velocity({5}).y(), 0.0, 1e-9);
}

}  // namespace
}  // namespace sheave
