// Affine spans against the geometry of spans: wherever the bodies are, the row's value is the rest
// length, with what the wheels have given, less the length that the general geometry finds, and
// nothing turns the gradient.

#include "cable/affine_span.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::affine_span {
namespace {

using test::attach;
using test::g;
using test::right;
using test::roll;

/// Wheels on fixed axles in three planes, and a weight that slides below the first and one below
/// the last.
test::Machine skew_wheels() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(1.0 / 240.0, 1, 50);
  m.model.step.solver = SolverKind::direct;
  m.model.bodies = {
      test::wheel("a", {0.0, 0.0, 0.0}, 0.3, 0.02), test::wheel("b", {2.0, 0.7, 0.4}, 0.2, 0.01),
      test::wheel("c", {4.0, 0.1, 0.0}, 0.25, 0.03), test::weight("light", {-0.3, -2.0, 0.0}, 1.0),
      test::weight("heavy", {4.25, -2.0, 0.0}, 1.4)};
  m.model.bodies[1].orientation = rotation_by({0.2, 0.3, 0.0});
  m.model.bodies[1].axis = m.model.bodies[1].orientation * Vector3::UnitZ();
  m.cables = {
      test::cable("cable", {attach(BodyId{3}), roll(BodyId{0}, right), roll(BodyId{1}, right),
                            roll(BodyId{2}, right), attach(BodyId{4})})};
  return m;
}

TEST(AffineSpan, RestLengthsFollowRimsAndLengthsInSkewPlanesToRounding) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine m = skew_wheels();
    m.model.step.integrator = integrator;
    Simulation s = test::start(m);
    const std::vector<CableReport> before = s.cable_reports();
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(s.world.step().ok());
    const std::vector<CableReport> after = s.cable_reports();
    const State& state = s.world.state();
    // All rims run with the cable, whatever plane they lie in.
    const double risen = state.bodies[3].position.y() + 2.0;
    EXPECT_GT(risen, 0.1);
    const double rounding = 1e-12;
    const double radii[]{0.3, 0.2, 0.25};
    for (std::size_t wheel = 0; wheel < 3; ++wheel) {
      EXPECT_NEAR(std::abs(state.bodies[wheel].angle) * radii[wheel], risen, rounding) << wheel;
    }
    EXPECT_NEAR(state.bodies[4].position.y() + 2.0, -risen, rounding);
    for (std::size_t k = 0; k < after[0].spans.size(); ++k) {
      // Reports find their spans by the general geometry.
      EXPECT_NEAR(after[0].spans[k].rest_length, after[0].spans[k].length, rounding) << k;
      if (k == 1 || k == 2) {
        EXPECT_EQ(after[0].spans[k].length, before[0].spans[k].length);
      }
    }
    EXPECT_EQ(after[0].length_error, 0.0);
    // (m2 - m1) g / (m1 + m2 + sum of J / r^2), constant: v = a t.
    const double inertia = 0.02 / 0.09 + 0.01 / 0.04 + 0.03 / 0.0625;
    const double speed = 0.4 * g / (2.4 + inertia) * 100.0 / 240.0;
    EXPECT_NEAR(state.bodies[3].velocity.y(), speed, 1e-11);
  }
}

TEST(AffineSpan, RunFromASnapshotIsTheSameBitForBit) {
  const test::Machine m = skew_wheels();
  Simulation whole = test::start(m);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(whole.world.step().ok());
  const State middle = whole.world.state();
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(whole.world.step().ok());
  // A world in which the spans have been looked at only now.
  Simulation second = test::start(m);
  ASSERT_TRUE(second.world.restore(middle).empty());
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(second.world.step().ok());
  EXPECT_EQ(hash(whole.world.state()), hash(second.world.state()));
}

TEST(AffineSpan, DragIsExactForEverySubstepLength) {
  // All have the same ratio k of drag to inertia, so v = a (1 - e^(-k t)) / k, with the decay exact
  // for any step. (The inverse masses that rows are copied with belong to the length of the
  // substep.)
  test::Machine m = test::Atwood{.m1 = 1.0, .m2 = 2.0, .inertia = 0.0625}.machine();
  // J / r^2 = 1 kg.
  m.model.bodies[0].angular_damping = 0.5 * 0.0625;
  m.model.bodies[1].damping = 0.5;
  m.model.bodies[2].damping = 1.0;
  const double acceleration = g / 4.0;
  for (const int substeps : {1, 3}) {
    m.model.step = test::settings(0.01, substeps, 50);
    m.model.step.solver = SolverKind::direct;
    Simulation s = test::start(m);
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(s.world.step().ok());
    const double exact = acceleration / 0.5 * (1.0 - std::exp(-0.5 * 0.5));
    EXPECT_NEAR(-s.world.state().bodies[2].velocity.y(), exact, 1e-11) << substeps;
  }
}

}  // namespace
}  // namespace sheave::affine_span
