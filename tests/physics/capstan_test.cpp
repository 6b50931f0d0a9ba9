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

/// A cable from a sliding block, bent by `angle` round something fixed, down to a hanging weight.
/// The block is pulled away by as much as gravity pulls a hanging mass of its size, so both ends
/// accelerate like those of Atwood's machine.
struct Capstan {
  static constexpr double radius = 0.25;
  static constexpr double reach = 10.0;  ///< of the cable to either side [m]
  static constexpr double time = 0.5;    ///< that a run takes [s]

  double angle = pi;  ///< pi / 2 or a multiple of pi; a pinhole: pi / 2
  double friction = 0.1;
  double block = 1.0;   ///< [kg]
  double weight = 1.0;  ///< [kg]
  bool pinhole = false;

  static constexpr BodyId block_id{1};
  static constexpr BodyId weight_id{2};

  /// Whole turns in `angle`.
  [[nodiscard]] int turns() const { return static_cast<int>(angle / (2.0 * pi) + 0.1); }

  /// Where the cable comes from, seen from the drum, whose right side it leaves downwards: from the
  /// left over the drum's top for a quarter turn, from below on the left for half a turn, from
  /// above on the right for none.
  [[nodiscard]] Vector3 away() const {
    const double rest = angle - 2.0 * pi * turns();
    if (rest < 0.1) return Vector3::UnitY();
    return rest < 0.6 * pi ? Vector3(-Vector3::UnitX()) : Vector3(-Vector3::UnitY());
  }

  [[nodiscard]] test::Machine machine() const {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(0.01, 1, 20);
    const double r = pinhole ? 0.0 : radius;
    BodyDef drum = test::wheel("drum", Vector3::Zero(), radius, 0.01);
    drum.mobility = Mobility::fixed;
    drum.axis.reset();
    const BodyId post = m.model.add(drum);
    BodyDef pulled = test::weight("block", {0.0, 0.0, 0.0}, block);
    pulled.axis = away();
    // The cable runs clockwise: to the right of it lies the drum.
    pulled.position = reach * away() + r * Vector3(away().y(), -away().x(), 0.0);
    pulled.force = block * (g * away() - test::down);
    m.model.add(pulled);
    m.model.add(test::weight("weight", {r, -reach, 0.0}, weight));
    std::shared_ptr<LinkDef> bend;
    if (pinhole) {
      auto hole = std::make_shared<PinholeLink>();
      hole->body = post;
      hole->friction = friction;
      bend = hole;
    } else {
      auto wheel = roll(post, right);
      wheel->friction = friction;
      wheel->turns = turns();
      bend = wheel;
    }
    m.cables.push_back(cable("rope", {attach(block_id), bend, attach(weight_id)}));
    return m;
  }
};

/// With the tension ratio beyond e^(m a) = q, to either side: the heavier end falls with the
/// acceleration
///   m1 a = T1 - m1 g, m2 a = m2 g - q T1  =>  a = (m2 - q m1) g / (m2 + q m1), exact in every step, as all is straight.
/// Below it nothing moves and each tension is its own weight.
///
/// Rounding: positions of 10 m are known to 1e-15 m, which is 1e-13 m/s in one step of 0.01 s and
/// 1e-12 m/s after 50 steps at worst; to g h^2 = 1e-3 m, the motion that a tension holds back, it
/// is 1e-12, and the same to that of the ratio, because the lighter end has the same g. A factor of
/// 10 is left for the sums on the way.
void expect_capstan(const Capstan& capstan) {
  constexpr double tolerance = 1e-11;
  Simulation s = test::start(capstan.machine());
  test::run(s.world, Capstan::time);
  const CableReport report = s.cable_reports()[0];
  const double t1 = report.spans[0].tension;
  const double t2 = report.spans[1].tension;
  const double v = -s.world.velocity(Capstan::weight_id).y();
  const double q = std::exp(capstan.friction * capstan.angle);
  const double m1 = capstan.block;
  const double m2 = capstan.weight;
  EXPECT_NEAR(report.links[1].wrap_angle, capstan.angle, tolerance);
  if (std::max(m1, m2) < q * std::min(m1, m2)) {
    EXPECT_NEAR(v, 0.0, tolerance);
    EXPECT_NEAR(t1, m1 * g, tolerance * m1 * g);
    EXPECT_NEAR(t2, m2 * g, tolerance * m2 * g);
    EXPECT_EQ(report.links[1].slip, 0.0);
    return;
  }
  const double up = m2 > m1 ? q : 1.0 / q;
  EXPECT_NEAR(v, Capstan::time * (m2 - up * m1) * g / (m2 + up * m1), tolerance);
  EXPECT_NEAR(t2 / t1, up, tolerance * up);
  EXPECT_NEAR(report.links[1].slip, -Capstan::reach - s.world.position(Capstan::weight_id).y(),
              tolerance);
}

/// One end weighs e^(x m a) times the other, x being a share of the exponent: also where the limit
/// is 12000 that comes as near to it as a thousandth, from both sides.
void expect_capstan_near_its_limit(Capstan capstan) {
  for (const double share : {0.5, 0.9, 0.999, 1.001, 1.1}) {
    const double heavy = std::exp(share * capstan.friction * capstan.angle);
    for (const bool weight_is_heavy : {true, false}) {
      SCOPED_TRACE(testing::Message()
                   << "angle " << capstan.angle << ", friction " << capstan.friction << ", share "
                   << share << ", weight " << (weight_is_heavy ? "heavy" : "light"));
      capstan.weight = weight_is_heavy ? heavy : 1.0;
      capstan.block = weight_is_heavy ? 1.0 : heavy;
      expect_capstan(capstan);
    }
  }
}

TEST(Capstan, AWheelHoldsUpToTheRatioAndSlipsBeyond) {
  for (const double angle : {0.5 * pi, pi, 3.0 * pi, 6.0 * pi}) {
    for (const double friction : {0.05, 0.1, 0.2, 0.3, 0.5}) {
      expect_capstan_near_its_limit({.angle = angle, .friction = friction});
    }
  }
}

TEST(Capstan, APinholeHoldsUpToTheRatioAndSlipsBeyond) {
  for (const double friction : {0.05, 0.1, 0.2, 0.3, 0.5}) {
    expect_capstan_near_its_limit({.angle = 0.5 * pi, .friction = friction, .pinhole = true});
  }
}

TEST(Capstan, GoesContinuouslyFromSlipToStickAsFrictionGrows) {
  // An Atwood machine on a wheel with inertia: it slips below the friction at which rolling needs
  // the ratio.
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
  // Sliding over the wheel turns it but gives no cable, so what pulls a rigid cable apart here
  // cannot be met.
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

TEST(Capstan, WithOneRoundTheRopeSlidesOneStepLater) {
  // Whether it slides is decided after a round, so a single one leaves the decision to the next
  // step.
  for (const SolverKind solver : {SolverKind::gauss_seidel, SolverKind::direct}) {
    const Capstan capstan{.weight = 2.0};
    test::Machine m = capstan.machine();
    m.model.step.iterations = 1;
    m.model.step.solver = solver;
    Simulation s = test::start(m);
    test::run(s.world, Capstan::time);
    const double q = std::exp(capstan.friction * capstan.angle);
    const double a = (2.0 - q) * g / (2.0 + q);
    EXPECT_NEAR(-s.world.velocity(Capstan::weight_id).y(), a * (Capstan::time - m.model.step.dt),
                1e-9);
  }
}

}  // namespace
}  // namespace sheave
