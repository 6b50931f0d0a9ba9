// Sum of rest lengths and stored lengths = L, for millions of substeps, and in agreement with
// geometry.
//
// All lengths are multiples of a power of two, so that sums are exact: the invariant holds to the
// last bit and the tests ask for 0, not for 1e-12.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/span_geometry.h"
#include "tests/support/builders.h"
#include "tests/support/effort.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::roll;

void run_steps(Simulation& s, int steps) {
  for (int i = 0; i < steps; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
    ASSERT_EQ(s.cable_reports()[0].length_error, 0.0);
  }
}

/// Largest difference between the stored lengths and the arcs between entry and exit, mod 2 pi r.
double arc_error(const CableReport& report) {
  double worst = 0.0;
  for (const LinkReport& link : report.links) {
    if (link.radius == 0.0) continue;
    const double arc =
        link.winding * angle_between((link.entry - link.center) / link.radius,
                                     (link.exit - link.center) / link.radius, link.normal);
    worst =
        std::max(worst, link.radius * std::abs(std::remainder(link.wrap_angle - arc, 2.0 * pi)));
  }
  return worst;
}

// 10^6 substeps of a belt between wheels of odd radii. The wheels stand still, so the arcs are
// constant; per substep the transport of each end is rounded by about eps of itself, 1e-18 m, and
// what is below the quantum is carried on.
TEST(LengthInvariant, RunningBeltForAMillionSubsteps) {
  test::Machine machine = test::belt(0.317, 0.123, 1.7, 0.03, 0.01);
  machine.model.step = test::settings(0.1, 1000, 2);
  machine.model.bodies[0].angular_velocity = {0.0, 0.0, 7.3};
  machine.model.bodies[1].angular_velocity = {0.0, 0.0, 7.3 * 0.317 / 0.123};
  Simulation s = test::start(machine);
  const double stored = s.cable_reports()[0].links[0].stored_length;
  run_steps(s, test::long_run(1000));
  const CableReport report = s.cable_reports()[0];
  EXPECT_GT(std::abs(s.world.state().bodies[0].angle), 10.0);
  EXPECT_LT(std::abs(report.links[0].stored_length - stored), 1e-9);
  EXPECT_LT(arc_error(report), 1e-9);
  // Rim speeds agree, and nothing but rounding slows an ideal belt.
  EXPECT_NEAR(0.317 * s.world.angular_velocity({0}).z(), 0.123 * s.world.angular_velocity({1}).z(),
              1e-9);
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), 7.3, 1e-6);
}

TEST(LengthInvariant, OscillatingElasticAtwoodForAMillionSubsteps) {
  test::Machine machine = test::Atwood{.m1 = 1.0, .m2 = 1.0}.machine();
  machine.model.step = test::settings(0.01, 1000, 3);
  machine.cables[0].compliance = 0.01;
  machine.model.bodies[1].velocity = {0.0, 0.3, 0.0};
  Simulation s = test::start(machine);
  run_steps(s, test::long_run(1000));
  EXPECT_LT(arc_error(s.cable_reports()[0]), 1e-9);
  // C does not drift: the right rest length is a function of the wheel's angle.
  const double angle = s.world.state().bodies[0].angle;
  EXPECT_NEAR(s.cable_reports()[0].spans[0].rest_length, 2.0 + 0.25 * angle, 1e-9);
  EXPECT_NEAR(s.cable_reports()[0].spans[1].rest_length, 2.0 - 0.25 * angle, 1e-9);
}

// A weight that swings: the tangent point moves, and stored length must follow the wrap angle.
TEST(LengthInvariant, StoredLengthFollowsTheWrapOfASwingingWeight) {
  for (const TangentUpdate update : {TangentUpdate::iteration, TangentUpdate::substep}) {
    test::Machine machine = test::Atwood{.m1 = 1.2, .m2 = 1.0}.machine();
    BodyDef bob = test::lump("bob", {1.25, -1.0, 0.0}, 1.0);
    machine.model.bodies[2] = bob;
    machine.model.step = test::settings(0.001, 1, 20);
    machine.cables[0].tangent_update = update;
    Simulation s = test::start(machine);
    double most = 0.0;
    double least = 10.0;
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport report = s.cable_reports()[0];
      ASSERT_EQ(report.length_error, 0.0);
      ASSERT_LT(arc_error(report), 1e-12);
      most = std::max(most, report.links[1].stored_length);
      least = std::min(least, report.links[1].stored_length);
    }
    EXPECT_GT(most - least, 0.05);  // it did swing
  }
}

// Skew planes: the same with a free wheel whose plane turns.
TEST(LengthInvariant, StoredLengthFollowsTheWrapInThreeDimensions) {
  test::Machine machine = test::Atwood{.m1 = 1.2, .m2 = 1.0}.machine();
  BodyDef block = test::lump("block", Vector3::Zero(), 2.0);
  machine.model.bodies[0].mount = BodyId{3};
  machine.model.bodies[2] = test::lump("bob", {0.9, -1.2, 0.6}, 1.0);
  machine.model.bodies[1] = test::lump("left bob", {-0.4, -1.7, -0.3}, 1.0);
  block.angular_velocity = {0.2, 0.4, -0.3};
  machine.model.add(block);
  machine.model.step = test::settings(0.001, 1, 20);
  auto joint_cable =
      cable("hanger", {attach(BodyId::world(), {0.1, 1.5, 0.2}), attach({3}, {0.1, 0.1, 0.05})});
  machine.cables.push_back(joint_cable);
  Simulation s = test::start(machine);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    ASSERT_EQ(report.length_error, 0.0);
    ASSERT_LT(arc_error(report), 1e-12);
  }
}

// Turns per substep far beyond half a turn: a driven drum winds a weight up, r w h per substep.
TEST(LengthInvariant, DrumAtSeveralTurnsPerSubstepWindsTheRightLength) {
  for (const double turns : {0.3, 0.5, 0.9, 2.5, 7.77}) {
    for (const TangentUpdate update : {TangentUpdate::iteration, TangentUpdate::substep}) {
      constexpr double r = 0.1;
      test::Machine machine;
      machine.model.step = test::settings(0.01, 1, 10);
      BodyDef drum = test::wheel("drum", Vector3::Zero(), r, 0.01);
      drum.mobility = Mobility::kinematic;
      drum.mass.reset();
      drum.inertia.reset();
      drum.angular_velocity = {0.0, 0.0, -turns * 2.0 * pi / 0.01};
      machine.model.add(drum);
      machine.model.add(test::weight("weight", {-r, -1000.0, 0.0}, 1.0));
      auto spool = roll({0}, right);
      spool->stored_length = 1.0;
      machine.cables.push_back(cable("rope", {attach({1}), spool}));
      machine.cables[0].tangent_update = update;
      Simulation s = test::start(machine);
      run_steps(s, 20);
      const double wound = 20 * turns * 2.0 * pi * r;
      const CableReport report = s.cable_reports()[0];
      EXPECT_NEAR(report.links[1].stored_length, 1.0 + wound, 1e-9);
      EXPECT_NEAR(report.spans[0].rest_length, 1000.0 - wound, 1e-9);
      if (update == TangentUpdate::iteration) {
        EXPECT_NEAR(s.world.position({1}).y(), -1000.0 + wound, 1e-9);
      }
    }
  }
}

TEST(LengthInvariant, BeltAtSeveralTurnsPerSubstepDrivesTheFollower) {
  constexpr double turns = 3.3;
  test::Machine machine = test::belt(0.3, 0.1, 1.0, 0.03, 0.01);
  machine.model.step = test::settings(0.01, 1, 200);
  BodyDef& driver = machine.model.bodies[0];
  driver.mobility = Mobility::kinematic;
  driver.mass.reset();
  driver.inertia.reset();
  driver.angular_velocity = {0.0, 0.0, turns * 2.0 * pi / 0.01};
  Simulation s = test::start(machine);
  const CableReport before = s.cable_reports()[0];
  run_steps(s, 50);
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(s.world.angular_velocity({1}).z(), 3.0 * driver.angular_velocity.z(), 1e-3);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(report.links[i].stored_length, before.links[i].stored_length, 1e-6);
  }
}

// Not a machine any more, but the cable must not be wound on by whole turns that nothing made: the
// line between the centres turns by less than half a turn, however fast it turns as they pass.
TEST(LengthInvariant, WheelsThatPassThroughEachOtherAddNoTurns) {
  constexpr double r1 = 0.3;
  constexpr double r2 = 0.2;
  for (int i = 0; i < 40; ++i) {
    test::Machine machine;
    machine.model.step = test::settings(0.01, 1, 1);
    BodyDef still = test::wheel("still", Vector3::Zero(), r1, 0.01);
    BodyDef passing = test::wheel("passing", {-1.001 + 1e-3 * i, 1e-3, 0.0}, r2, 0.01);
    still.mobility = passing.mobility = Mobility::kinematic;
    passing.velocity = {2.0, 0.0, 0.0};
    const BodyId a = machine.model.add(still);
    const BodyId b = machine.model.add(passing);
    auto first = roll(a, left);
    auto second = roll(b, right);
    first->stored_length = second->stored_length = 5.0;
    machine.cables.push_back(cable("rope", {first, second}));
    Simulation s = test::start(machine);
    double before = s.cable_reports()[0].spans[0].rest_length;
    for (int k = 0; k < 100; ++k) {
      ASSERT_TRUE(s.world.step().ok());
      const double rest_length = s.cable_reports()[0].spans[0].rest_length;
      ASSERT_LT(std::abs(rest_length - before), pi * (r1 + r2)) << i << ", step " << k;
      before = rest_length;
    }
  }
}

}  // namespace
}  // namespace sheave
