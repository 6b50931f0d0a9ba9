// Friction between a cable and what it is wrapped round: Euler-Eytelwein, T2 / T1 = e^(m a).

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::right;
using test::roll;

/// 1 kg on the left and `heavy` on the right of a fixed drum; half a turn and `turns` more, or with `quarter` a quarter
/// turn less, the light weight then sliding sideways. Bodies: 0 drum, 1 light, 2 heavy.
test::Machine capstan(double friction, int turns, double heavy, int iterations = 20) {
  test::Machine m = test::Atwood{.m1 = 1.0, .m2 = heavy, .hang = 50.0}.machine();
  m.model.step = test::settings(0.01, 1, iterations);
  m.model.bodies[0].mobility = Mobility::fixed;
  m.model.bodies[0].axis.reset();
  auto drum = roll({0}, right);
  drum->friction = friction;
  drum->turns = turns;
  m.cables[0].links[1] = drum;
  return m;
}

TEST(Capstan, HoldsUpToTheRatioAndSlipsBeyond) {
  for (const double friction : {0.05, 0.2, 0.5}) {
    for (const int turns : {0, 1}) {
      const double ratio = std::exp(friction * pi * (1 + 2 * turns));
      for (const double share : {0.5, 0.9, 0.995, 1.005, 1.2}) {
        const double heavy = 1.0 + (ratio - 1.0) * share;
        if (share != 0.5 && share != 1.2) {
          if (ratio * std::abs(share - 1.0) < 1e-6) continue;
        }
        Simulation s = test::start(capstan(friction, turns, heavy));
        for (int i = 0; i < 50; ++i) ASSERT_TRUE(s.world.step().ok());
        const CableReport report = s.cable_reports()[0];
        const double v = -s.world.velocity({2}).y();
        if (heavy < ratio) {
          EXPECT_NEAR(v, 0.0, 1e-9) << friction << ' ' << turns << ' ' << share;
          EXPECT_NEAR(report.spans[0].tension, g, 1e-6 * g);
          EXPECT_NEAR(report.spans[1].tension, heavy * g, 1e-6 * heavy * g);
          EXPECT_EQ(report.links[1].slip, 0.0);
        } else {
          // m1 a = T1 - m1 g, m2 a = m2 g - q T1.
          const double a = (heavy - ratio) * g / (heavy + ratio);
          EXPECT_NEAR(v, 0.5 * a, 1e-6 * 0.5 * a) << friction << ' ' << turns << ' ' << share;
          EXPECT_NEAR(report.spans[1].tension / report.spans[0].tension, ratio, 1e-9 * ratio);
          EXPECT_NEAR(report.links[1].slip, -50.0 - s.world.position({2}).y(), 1e-12);
        }
      }
    }
  }
}

TEST(Capstan, HoldingRatioOfPinholesFollowsTheDeflection) {
  // Through a hole at the corner of a right angle: a weight below, another pulled sideways by gravity of its own is
  // not needed: the elastic half of the cable measures the tension.
  const double friction = 0.3;
  const double limit = std::exp(friction * 0.5 * pi);
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.002, 1, 20);
  auto hole = std::make_shared<PinholeLink>();
  hole->friction = friction;
  BodyDef block;
  block.name = "block";
  block.mobility = Mobility::slider;
  block.axis = Vector3::UnitX();
  block.position = {-10.0, 0.0, 0.0};
  block.mass = 1.0;
  const BodyId sideways = m.model.add(block);
  const BodyId weight = m.model.add(test::weight("weight", {0.0, -10.0, 0.0}, 2.0));
  m.cables.push_back(cable("rope", {attach(sideways), hole, attach(weight)}));
  Simulation s = test::start(m);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(report.spans[1].tension / report.spans[0].tension, limit, 1e-9);
  // m1 a = T, m2 a = m2 g - q T.
  const double a = 2.0 * g / (2.0 + limit);
  EXPECT_NEAR(-s.world.velocity(weight).y(), 0.2 * a, 1e-6);
}

TEST(Capstan, GoesContinuouslyFromSlipToStickAsFrictionGrows) {
  // An Atwood machine on a wheel with inertia: it slips below the friction at which rolling needs the ratio.
  const test::Atwood atwood{.m1 = 1.0, .m2 = 2.0, .inertia = 0.2, .hang = 50.0};
  const double rolling = atwood.acceleration();
  const double needed = 2.0 * (g - rolling) / (g + rolling);  // T2 / T1 when it rolls
  const double critical = std::log(needed) / pi;
  double last = 1e9;
  for (int i = 0; i <= 20; ++i) {
    const double friction = critical * i / 10.0;
    test::Machine m = atwood.machine();
    m.model.step = test::settings(0.002, 1, 60);
    auto wheel = roll({0}, right);
    wheel->friction = friction;
    m.cables[0].links[1] = wheel;
    Simulation s = test::start(m);
    for (int k = 0; k < 100; ++k) ASSERT_TRUE(s.world.step().ok());
    const double q = std::exp(friction * pi);
    const double slipping = (2.0 - q) * g / (2.0 + q);
    const double expected = friction < critical ? slipping : rolling;
    const double a = -s.world.velocity({2}).y() / 0.2;
    EXPECT_NEAR(a, expected, 1e-3 * expected) << i;
    EXPECT_LE(a, last + 1e-9);
    last = a;
    // The wheel's own acceleration: by the difference of the tensions when it slips.
    const double spin = -s.world.angular_velocity({0}).z() / 0.2;
    const double t1 = g + slipping;
    const double expected_spin = friction < critical ? (q - 1.0) * t1 * 0.25 / 0.2 : rolling / 0.25;
    EXPECT_NEAR(spin, expected_spin, 2e-3 * rolling / 0.25) << i;
  }
}

TEST(Capstan, WithoutFrictionTheWheelStandsStill) {
  // A pinhole of finite size: no torque on the wheel but what rounding leaves of 10 N x 0.25 m.
  test::Machine m = test::Atwood{.m1 = 1.0, .m2 = 2.0, .hang = 50.0}.machine();
  auto wheel = roll({0}, right);
  wheel->friction = 0.0;
  m.cables[0].links[1] = wheel;
  Simulation s = test::start(m);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), 0.0, 1e-13);
  EXPECT_NEAR(-s.world.velocity({2}).y(), 0.5 * g / 3.0, 1e-9);
}

TEST(Capstan, StaysFiniteWhereNothingButTheWheelCanMove) {
  // Sliding over the wheel turns it but gives no cable, so what pulls a rigid cable apart here cannot be met.
  for (int i = 0; i < 20; ++i) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(0.01, 4, 10);
    const BodyId pulley = m.model.add(test::wheel("wheel", {0.0, 0.0, 0.0}, 0.2, 0.01));
    BodyDef drive = test::lump("drive", {1.1, -0.7 + 0.05 * i, 0.0}, 1.0);
    drive.mobility = Mobility::kinematic;
    drive.velocity = {0.5, -0.3, 0.0};
    const BodyId away = m.model.add(drive);
    auto wheel = roll(pulley, right);
    wheel->friction = 0.07;
    m.cables.push_back(
        cable("rope", {attach(BodyId::world(), {-1.3, -0.4, 0.0}), wheel, attach(away)}));
    Simulation s = test::start(m);
    for (int k = 0; k < 50; ++k) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport report = s.cable_reports()[0];
      // The cable is torn by the drive's way and no more.
      ASSERT_LT(std::abs(report.spans[0].rest_length - report.spans[0].length), 0.5);
      ASSERT_LT(std::abs(report.spans[1].rest_length - report.spans[1].length), 0.5);
      ASSERT_LT(report.spans[0].tension, 1e9);
      ASSERT_LT(s.world.angular_velocity(pulley).norm(), 1e3);
    }
  }
}

}  // namespace
}  // namespace sheave
