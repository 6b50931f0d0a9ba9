// Cables that slide through points and over massless wheels: one tension on both sides.

#include "cable/links/pinhole.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::roll;

std::shared_ptr<PinholeLink> hole(BodyId body, const Vector3& point = Vector3::Zero(),
                                  double friction = 0.0) {
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  link->friction = friction;
  return link;
}

/// Two weights on one cable through `count` holes in a zigzag between them; bodies 0 and 1.
test::Machine chain(int count, double m1, double m2) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.01, 1, 1);
  const double end = 0.3 * (count - 1);
  const BodyId a = m.model.add(test::weight("a", {0.0, -20.0, 0.0}, m1));
  const BodyId b = m.model.add(test::weight("b", {end, -20.0, 0.0}, m2));
  CableDef rope = cable("rope", {attach(a)});
  for (int i = 0; i < count; ++i) {
    rope.links.push_back(hole(BodyId::world(), {0.3 * i, i % 2 == 1 ? -0.4 : 0.0, 0.0}));
  }
  rope.links.push_back(attach(b));
  m.cables.push_back(rope);
  return m;
}

TEST(Pinhole, ChainsHaveOneTensionAndTheAccelerationOfAtwood) {
  for (const int count : {1, 5, 50}) {
    Simulation s = test::start(chain(count, 1.0, 2.0));
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    const double tension = 2.0 * 1.0 * 2.0 * g / 3.0;
    for (const SpanReport& span : report.spans) {
      // One row: the same multiplier, bit for bit. Its value: a step's force from positions of 20 m
      // over h^2.
      EXPECT_EQ(span.tension, report.spans[0].tension);
      EXPECT_NEAR(span.tension, tension, 1e-9 * tension) << count;
      EXPECT_NEAR(span.rest_length, span.length, 1e-12);
    }
    EXPECT_NEAR(s.world.velocity({0}).y(), g / 3.0 * 0.5, 1e-9) << count;
    EXPECT_EQ(report.length_error, 0.0);
  }
}

TEST(Pinhole, SlipIsTheLengthThatHasPassed) {
  Simulation s = test::start(chain(3, 1.0, 2.0));
  const double before = s.world.position({1}).y();
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  const double fallen = before - s.world.position({1}).y();
  for (const std::size_t i : {1U, 2U, 3U}) EXPECT_NEAR(report.links[i].slip, fallen, 1e-12);
}

TEST(Pinhole, SlackCableIsNeverShared) {
  test::Machine m = chain(5, 1.0, 2.0);
  const Simulation first = test::start(m);
  const std::vector<CableReport> at_first = first.cable_reports();
  for (const SpanReport& span : at_first[0].spans) {
    m.cables[0].rest_lengths.push_back(1.1 * span.length);
  }
  Simulation s = test::start(m);
  const std::vector<SpanReport> before = s.cable_reports()[0].spans;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(s.world.step().ok());
  const std::vector<SpanReport> after = s.cable_reports()[0].spans;
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_EQ(after[k].rest_length, before[k].rest_length);
    EXPECT_EQ(after[k].tension, 0.0);
  }
}

TEST(Pinhole, ASpanThatGrowsTakesSlackFromTheNearest) {
  test::Machine m = chain(5, 1.0, 2.0);
  const Simulation first = test::start(m);
  const std::vector<CableReport> at_first = first.cable_reports();
  for (const SpanReport& span : at_first[0].spans) {
    m.cables[0].rest_lengths.push_back(span.length);
  }
  m.cables[0].rest_lengths[3] += 0.05;  // b falls by less than this in 0.09 s
  Simulation s = test::start(m);
  const std::vector<SpanReport> before = s.cable_reports()[0].spans;
  for (int i = 0; i < 9; ++i) ASSERT_TRUE(s.world.step().ok());
  const std::vector<SpanReport> after = s.cable_reports()[0].spans;
  for (const std::size_t k : {1U, 2U, 4U}) EXPECT_EQ(after[k].rest_length, before[k].rest_length);
  EXPECT_LT(after[3].rest_length, before[3].rest_length);
  for (const SpanReport& span : after) EXPECT_GE(span.rest_length - span.length, -1e-12);
}

TEST(Pinhole, RestLengthsNeverGoNegativeWhenAnEndReachesAHole) {
  // a is pulled right up to its hole, 20 m in a little over 3.5 s, which ends the run.
  Simulation s = test::start(chain(3, 1.0, 2.0));
  double shortest = 1.0;
  double highest = -20.0;
  bool arrived = false;
  for (int i = 0; i < 500 && !arrived; ++i) {
    const StepReport report = s.world.step();
    arrived = !report.ok();
    if (arrived) {
      EXPECT_NE(report.divergence->message.find("the pinhole"), std::string::npos);
    }
    highest = std::max(highest, s.world.position({0}).y());
    const std::vector<CableReport> reports = s.cable_reports();
    for (const SpanReport& span : reports[0].spans) {
      shortest = std::min(shortest, span.rest_length);
    }
  }
  EXPECT_TRUE(arrived);
  EXPECT_GT(highest, -0.2);
  EXPECT_GE(shortest, 0.0);
  EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
}

TEST(Pinhole, OnAMovingBodyActsLikeAMovingPulley) {
  // A ring of mass M hangs in a loop of cable between two fixed points; one end runs over a hole to
  // the effort m:
  // 2 T - M g = M a, m g - T = 2 m a  =>  a = (2 m - M) g / (M + 4 m).
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.01, 1, 1);
  const double load = 3.0;
  const double effort = 2.0;
  const BodyId ring = m.model.add(test::weight("ring", {0.0, -20.0, 0.0}, load));
  const BodyId weight = m.model.add(test::weight("weight", {0.0, -5.0, 0.0}, effort));
  m.cables.push_back(
      cable("rope", {attach(BodyId::world()), hole(ring), hole(BodyId::world()), attach(weight)}));
  Simulation s = test::start(m);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
  const double a = (2.0 * effort - load) * g / (load + 4.0 * effort);
  EXPECT_NEAR(s.world.velocity(ring).y(), 0.6 * a, 1e-9);
  const CableReport report = s.cable_reports()[0];
  EXPECT_EQ(report.spans[0].tension, report.spans[2].tension);
}

TEST(Pinhole, AnElasticCableStretchesAsAWhole) {
  // Of a material, L / EA for the whole length, wherever the hole is; the oscillator of the weight
  // on it has the period 2 pi sqrt(m L / EA).
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.001, 10, 2);
  const BodyId weight = m.model.add(test::weight("weight", {0.0, -1.0, 0.0}, 2.0));
  m.cables.push_back(cable(
      "rope", {attach(BodyId::world(), {3.0, 0.0, 0.0}), hole(BodyId::world()), attach(weight)}));
  m.cables[0].axial_stiffness = 1000.0;
  m.cables[0].damping = 40.0;
  Simulation s = test::start(m);
  test::run(s.world, 8.0);  // the oscillation dies out with e^(-c t / 2 m) = e^-20 or faster
  const CableReport report = s.cable_reports()[0];
  // At rest F = 2 g; L = 4 m at rest, and the material's stiffness holds for the rest length.
  EXPECT_NEAR(s.world.position(weight).y(), -1.0 - 2.0 * g / 1000.0 * 4.0, 1e-6);
  EXPECT_NEAR(report.spans[0].tension, 2.0 * g, 1e-4);
  EXPECT_NEAR(report.spans[0].rest_length, 3.0 / (1.0 + 2.0 * g / 1000.0), 1e-6);
}

/// The rule as Algorithm 1 of the paper prints it (lines 9-16), for one pinhole between spans of
/// the lengths l1, l2 with the rest lengths r1, r2: each in turn takes the excess of the other.
void printed_rule(double l1, double l2, double& r1, double& r2) {
  const double excess1 = l1 - r1;
  const double excess2 = l2 - r2;
  r1 = r1 + excess1 - excess2;
  r2 = r2 + excess2 - excess1;
}

TEST(Pinhole, ThePrintedRuleSwapsTheExcessesAndMayOvershoot) {
  double r1 = 1.0;
  double r2 = 1.0;
  printed_rule(1.3, 1.1, r1, r2);
  EXPECT_NEAR(1.3 - r1, 0.1, 1e-15);  // now the first has the excess of the second,
  EXPECT_NEAR(1.1 - r2, 0.3, 1e-15);  // and the other way round: it never settles
  r1 = 1.0;
  r2 = 0.1;
  printed_rule(2.0, 0.1, r1, r2);
  EXPECT_LT(r2, 0.0);  // the second span has lent length that it does not have
}

TEST(MasslessWheel, TackleAcceleratesInClosedFormForAnyInertia) {
  // Between 0 and about 1e-4 kg m2 Gauss-Seidel needs more sweeps the lighter the wheels are: the
  // rows of a light wheel's two spans are then nearly opposite. A cable on wheels without any
  // inertia is one row.
  for (const double inertia : {0.0, 1e-3, 1.0}) {
    test::Tackle tackle{.strands = 4, .load = 8.0, .effort = 3.0};
    tackle.inertia = inertia;
    test::Machine m = tackle.machine();
    for (BodyDef& body : m.model.bodies) {
      if (body.mobility != Mobility::rotor) continue;
      body.spin_inertia = inertia;
      body.inertia = Vector3(1e-3, 1e-3, 1e-3);
    }
    m.model.step = test::settings(0.01, 1, 400);
    Simulation s = test::start(m);
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR(s.world.velocity(test::Tackle::block).y(), 0.3 * tackle.acceleration(),
                1e-3 * 0.3 * std::abs(tackle.acceleration()))
        << inertia;
  }
}

TEST(MasslessWheel, HoldsItsCableWhenItIsDriven) {
  // A brake: the drive's speed is 0, so the wheel takes up the difference of the weights.
  test::Machine m = test::Atwood{.m1 = 1.0, .m2 = 2.0}.machine();
  m.model.bodies[0].spin_inertia = 0.0;
  m.model.bodies[0].drive = DriveKind::speed;
  m.model.bodies[0].drive_values = {0.0};
  Simulation s = test::start(m);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_NEAR(s.world.velocity({2}).y(), 0.0, 1e-9);
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(report.spans[0].tension, g, 1e-6 * g);
  EXPECT_NEAR(report.spans[1].tension, 2.0 * g, 1e-6 * g);
}

TEST(Pinhole, ASpanWithBothEndsOnOneBodyExertsNoForce) {
  // A tendon's last stretch: from its end through a hole with friction in the same bone. The bone
  // moves as if the tendon ended at the hole, but for what the direct solver's rounds leave in each
  // of n = 100 steps: e = 1e-10 of 2 m, hence e / h of velocity, and n^2 e / 2 in the end.
  for (const SolverKind solver : {SolverKind::gauss_seidel, SolverKind::direct}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(0.01, 1, 20);
    m.model.step.solver = solver;
    BodyDef lump = test::lump("bone", {0.1, 0.2, 0.3}, 1.0);
    lump.angular_velocity = {1.0, 2.0, 3.0};
    const BodyId bone = m.model.add(lump);
    const Vector3 place(0.1, 0.05, -0.07);
    const auto anchor = attach(BodyId::world(), {0.3, 2.0, 0.1});
    m.cables.push_back(
        cable("tendon", {attach(bone, {-0.1, 0.0, 0.1}), hole(bone, place, 0.3), anchor}));
    Simulation s = test::start(m);
    m.cables[0] = cable("tendon", {attach(bone, place), anchor});
    Simulation shorter = test::start(m);
    const double left = solver == SolverKind::direct ? 1e-6 : 1e-9;
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      ASSERT_TRUE(shorter.world.step().ok());
      ASSERT_LT((s.world.position(bone) - shorter.world.position(bone)).norm(), left) << i;
    }
  }
}

TEST(MasslessWheel, TurnsWithItsCable) {
  for (const double inertia : {0.0, 0.05}) {
    test::Machine m = test::Atwood{.m1 = 1.0, .m2 = 2.0}.machine();
    m.model.bodies[0].spin_inertia = inertia;
    Simulation s = test::start(m);
    for (int i = 0; i < 40; ++i) ASSERT_TRUE(s.world.step().ok());
    const double fallen = -2.0 - s.world.position({2}).y();
    EXPECT_NEAR(s.world.state().bodies[0].angle, -fallen / 0.25, 1e-9) << inertia;
    EXPECT_NEAR(s.world.angular_velocity({0}).z(), s.world.velocity({2}).y() / 0.25, 1e-6)
        << inertia;
  }
}

}  // namespace
}  // namespace sheave
