// Cable of a material over a massless wheel between fixed points, where nothing but the wheel can
// move: what passes over it is known.
//
// With lengths l and unstretched lengths L both spans come to one strain,
//   1 + e = (l1 + l2) / (L1 + L2),
// so l1 / (1 + e) - L1 passes into the first, and its rim turns by that times one plus a strain
// between those that the spans have had.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::massless_strain {
namespace {

using test::attach;
using test::cable;
using test::roll;

class MasslessStrain : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, MasslessStrain, testing::ValuesIn(test::combinations),
                         test::combination_name);

constexpr double radius = 0.2;
constexpr double height = 2.0;  // of the wheel above the ends: the length of both spans [m]

test::Machine bow(const StepSettings& step, const std::vector<double>& rest_lengths) {
  test::Machine m;
  m.model.step = step;
  BodyDef wheel = test::wheel("wheel", {0, height, 0}, radius, 1.0);
  wheel.spin_inertia = 0.0;
  const BodyId massless = m.model.add(wheel);
  m.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-radius, 0, 0}), roll(massless, test::right),
                     attach(BodyId::world(), {radius, 0, 0})}));
  m.cables[0].axial_stiffness = 1000.0;
  m.cables[0].rest_lengths = rest_lengths;
  return m;
}

void expect_clean(const Simulation& simulation) {
  const auto certificate = simulation.certificate();
  ASSERT_TRUE(certificate.has_value());
  EXPECT_TRUE(certificate->clean(1e-6)) << certificate->worst()->sentence();
}

// Several times the wheel's perimeter passes within one substep.
TEST_P(MasslessStrain, UnequalStrainsBecomeEqualInOneStep) {
  const std::vector<double> rest_lengths{0.4, 1.9};
  Simulation s = test::start(bow(step_settings(0.01, 50), rest_lengths));
  ASSERT_TRUE(s.world.step().ok());
  expect_clean(s);
  const double strain = 2.0 * height / (rest_lengths[0] + rest_lengths[1]) - 1.0;
  const double passed = height / (1.0 + strain) - rest_lengths[0];
  const std::vector<CableReport> reports = s.cable_reports();
  for (const SpanReport& span : reports[0].spans) {
    EXPECT_NEAR(span.rest_length, height / (1.0 + strain), 1e-12);
  }
  const double turned = radius * std::abs(s.world.state().bodies[0].angle);
  EXPECT_GE(turned, passed * (height / rest_lengths[1]) - 1e-12);
  EXPECT_LE(turned, passed * (height / rest_lengths[0]) + 1e-12);
  EXPECT_GT(turned, 2.0 * pi * radius);
}

// A slack span gives what the strained one lacks. The wheel goes on turning and would give more
// than there is, so some comes back: other cable than what has come off the wheel with the strain
// with which it lay there.
TEST_P(MasslessStrain, AWheelThatTurnsTooFarIsTurnedBack) {
  constexpr double slack = 0.06;
  Simulation s = test::start(bow(step_settings(0.01, 50), {height + slack, height / 1.02}));
  const double length = s.cable_reports()[0].total_length;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    expect_clean(s);
    EXPECT_NEAR(s.cable_reports()[0].total_length, length, 1e-12);
  }
  // All of the slack is on the other side, and the wheel has passed no more than it.
  const std::vector<CableReport> reports = s.cable_reports();
  EXPECT_NEAR(reports[0].spans[0].rest_length, height, 1e-12);
  EXPECT_NEAR(radius * std::abs(s.world.state().bodies[0].angle), slack, 1e-12);
}

}  // namespace
}  // namespace sheave::massless_strain
