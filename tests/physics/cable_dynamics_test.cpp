// Motion on cables: slack and taut, pendulums, oscillators, belts, and the price of XPBD.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/joints/ball.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

TEST(SlackCable, ExertsNothing) {
  test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.0);
  machine.cables[0].rest_lengths = {1.5};
  Simulation s = test::start(machine);
  // It falls 0.44 m in 0.3 s and stays within the slack: free fall, bit for bit.
  Model free = machine.model;
  World reference = test::start(free);
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    ASSERT_TRUE(reference.step().ok());
    ASSERT_EQ(s.cable_reports()[0].spans[0].tension, 0.0);
    ASSERT_EQ(s.world.position({0}), reference.position({0}));
  }
}

TEST(SlackCable, GoesTautSlackAndTautAgain) {
  test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.0);
  machine.model.step = test::settings(0.001, 1, 5);
  machine.model.bodies[0].velocity = {0.0, 2.0, 0.0};
  Simulation s = test::start(machine);
  // Up and down again takes 2 v / g = 0.408 s; then it hangs.
  const double flight = 4.0 / g;
  while (s.world.state().time < 1.0) {
    ASSERT_TRUE(s.world.step().ok());
    const SpanReport span = s.cable_reports()[0].spans[0];
    EXPECT_LT(span.length, 1.0 + 1e-12);
    if (s.world.state().time < flight - 0.003) {
      EXPECT_EQ(span.tension, 0.0);
    } else if (s.world.state().time > flight + 0.003) {
      EXPECT_NEAR(span.tension, g, 1e-9 * g);  // the impact is inelastic: no bounce
    }
  }
}

TEST(SlackCable, OneSpanIsSlackWhileTheOtherIsTaut) {
  // The left weight stands on a floor, the right one hangs lower than its cable allows to lift it.
  test::Machine machine = test::Atwood{.m1 = 1.0, .m2 = 2.0}.machine();
  machine.cables[0].rest_lengths = {2.0, 2.5};
  Simulation s = test::start(machine);
  ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  EXPECT_GT(report.spans[0].tension, 0.0);
  EXPECT_EQ(report.spans[1].tension, 0.0);
  // v = (x' - x) / h with x of about 2 m and h = 1 ms: 10 steps of 4e-13 of rounding.
  EXPECT_NEAR(s.world.velocity({2}).y(), -0.01 * g, 1e-11);
}

TEST(Belt, RimSpeedsAgreeAndTheTorqueAcceleratesBothWheels) {
  // The rims' common acceleration is (M/r1) / (J1/r1^2 + J2/r2^2). Gauss-Seidel has to carry the
  // torque over the tight span only.
  test::Machine machine = test::belt(0.3, 0.1, 1.0, 0.03, 0.01);
  machine.model.step = test::settings(0.01, 1, 20);
  machine.model.bodies[0].torque = {0.0, 0.0, 2.0};
  Simulation s = test::start(machine);
  test::run(s.world, 1.0);
  const double rim = (2.0 / 0.3) / (0.03 / 0.09 + 0.01 / 0.01);
  EXPECT_NEAR(0.3 * s.world.angular_velocity({0}).z(), rim, 1e-9 * rim);
  EXPECT_NEAR(0.1 * s.world.angular_velocity({1}).z(), rim, 1e-9 * rim);
  const CableReport report = s.cable_reports()[0];
  // Tight span: F r2 = J2 w2'. Round the driver counter-clockwise the cable comes in on the span
  // that leads back from the follower, so that one pulls.
  EXPECT_NEAR(report.spans[1].tension, 0.01 * rim / 0.01, 1e-9 * rim);
  EXPECT_NEAR(report.spans[0].tension, 0.0, 1e-9 * rim);
}

// A weight swinging in a circle without gravity. Each substep predicts along the tangent and
// projects back: tan(w' h) = w h, so w' = w - w^3 h^2 / 3 ... and v' is a chord; the law
// w0 / sqrt(1 + 2 w0^2 h t) holds for small w h.
TEST(Xpbd, DampsACircularMotionByItsLaw) {
  for (const double dt : {2e-3, 1e-3, 5e-4}) {
    constexpr double w0 = 5.0;
    test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.0);
    machine.model.gravity.setZero();
    machine.model.step = test::settings(dt, 1, 5);
    machine.model.bodies[0].velocity = {w0, 0.0, 0.0};
    Simulation s = test::start(machine);
    for (const double time : {2.0, 5.0, 10.0}) {
      test::run(s.world, time);
      const double law = w0 / std::sqrt(1.0 + 2.0 * w0 * w0 * dt * s.world.state().time);
      EXPECT_NEAR(s.world.velocity({0}).norm(), law, 0.01 * law) << dt;
    }
  }
}

/// Accelerations of a weight m1 on a rail and a weight m2 swinging from a wheel (radius r, J), with
/// the free length l and the angle a of its span, v = speed of the cable towards the bob, w = a':
///   l' = v + r w,   (m1 + m2 + J/r^2) v' = m2 (g cos a + l w^2) - m1 g,
///   l w' = -g sin a - (2 v + r w) w.
/// (Bob: p = c + r e + l u, e = (cos a, sin a), u = (sin a, -cos a), p' = v u + l w e.)
struct SwingingAtwood {
  static constexpr double m1 = 1.5, m2 = 1.0, r = 0.25, inertia = 0.03;
  std::array<double, 4> derivative(const std::array<double, 4>& y) const {
    const auto [l, a, v, w] = y;
    return {v + r * w, w,
            (m2 * (g * std::cos(a) + l * w * w) - m1 * g) / (m1 + m2 + inertia / (r * r)),
            (-g * std::sin(a) - (2.0 * v + r * w) * w) / l};
  }
  std::array<double, 4> solve(std::array<double, 4> y, double time) const {
    constexpr int steps = 20000;
    const double h = time / steps;
    const auto moved = [](std::array<double, 4> from, const std::array<double, 4>& by, double f) {
      for (std::size_t i = 0; i < 4; ++i) from[i] += f * by[i];
      return from;
    };
    for (int i = 0; i < steps; ++i) {
      const auto k1 = derivative(y);
      const auto k2 = derivative(moved(y, k1, h / 2));
      const auto k3 = derivative(moved(y, k2, h / 2));
      const auto k4 = derivative(moved(y, k3, h));
      for (std::size_t k = 0; k < 4; ++k) y[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
    }
    return y;
  }
};

TEST(Xpbd, ConvergesInFirstOrderOnASwingingAtwoodMachine) {
  const SwingingAtwood exact;
  constexpr double angle = 0.9;
  constexpr double length = 1.5;
  constexpr double time = 1.0;
  const auto y = exact.solve({length, angle, 0.0, 0.0}, time);
  const Vector3 e{std::cos(y[1]), std::sin(y[1]), 0.0};
  const Vector3 u{std::sin(y[1]), -std::cos(y[1]), 0.0};
  const Vector3 expected = SwingingAtwood::r * e + y[0] * u;
  const auto error = [&](double dt) {
    test::Machine machine = test::Atwood{.m1 = SwingingAtwood::m1,
                                         .radius = SwingingAtwood::r,
                                         .inertia = SwingingAtwood::inertia}
                                .machine();
    const Vector3 bob = SwingingAtwood::r * Vector3(std::cos(angle), std::sin(angle), 0.0) +
                        length * Vector3(std::sin(angle), -std::cos(angle), 0.0);
    machine.model.bodies[2] = test::lump("bob", bob, SwingingAtwood::m2);
    machine.model.step = test::settings(dt, 1, 60);
    Simulation s = test::start(machine);
    test::run(s.world, time);
    return (s.world.position({2}) - expected).norm();
  };
  const double e1 = error(1.0 / 500);
  const double e2 = error(1.0 / 1000);
  const double e4 = error(1.0 / 2000);
  EXPECT_LT(e4, 5e-3);
  EXPECT_NEAR(std::log2(e1 / e2), 1.0, 0.15);
  EXPECT_NEAR(std::log2(e2 / e4), 1.0, 0.08);
  RecordProperty("order", std::to_string(std::log2(e2 / e4)));
  RecordProperty("error", std::to_string(e4));
}

// Small swings: T = 2 pi sqrt((J + m l^2) / (m g l)) (1 + A^2/16). First order in h: extrapolated.
TEST(BallJointPendulum, HasTheClosedFormPeriod) {
  const auto period = [](double dt) {
    Model model;
    model.gravity = test::down;
    model.step = test::settings(dt, 1, 20);
    constexpr double angle = 0.05;
    BodyDef bob = test::lump("bob", Vector3(std::sin(angle), -std::cos(angle), 0.0), 2.0);
    bob.orientation = rotation_by({0.0, 0.0, angle});
    model.add(bob);
    auto joint = std::make_shared<BallJoint>();
    joint->name = "pivot";
    joint->body_b = {0};
    model.joints.push_back(joint);
    World world = test::start(model);
    double last_x = world.position({0}).x();
    double first_crossing = 0.0;
    for (int crossings = 0;;) {
      if (!world.step().ok()) return 0.0;
      const double x = world.position({0}).x();
      if (last_x * x < 0.0) {
        const double at = world.state().time - dt * x / (x - last_x);
        if (++crossings == 1) first_crossing = at;
        if (crossings == 5) return (at - first_crossing) / 2.0;
      }
      last_x = x;
    }
  };
  const double inertia = 2.0 * 0.12;
  const double expected =
      2.0 * pi * std::sqrt((inertia + 2.0) / (2.0 * g)) * (1.0 + 0.05 * 0.05 / 16.0);
  const double extrapolated = 2.0 * period(5e-4) - period(1e-3);
  EXPECT_NEAR(period(1e-3), expected, 1e-3 * expected);
  // The amplitude decays meanwhile, which changes A^2/16 = 1.6e-4 by less than itself.
  EXPECT_NEAR(extrapolated, expected, 2e-4 * expected);
}

// An oscillator x'' + (b/m) x' + x/(a m) = 0 on an elastic cable that stays taut. The step is a
// linear map with a pair of complex eigenvalues, so samples obey y2 = p y1 + q y0, with
// -q = exp(-2 c T) for the decay rate c over the sampling time T. Implicit integration adds
// w^2 h / 2 to b / 2m; what is left when the two finest are extrapolated is the physical rate.
TEST(DampedCable, DampingRateConvergesToTheAnalyticOne) {
  constexpr double mass = 1.0;
  constexpr double compliance = 1.0 / 400.0;
  for (const double damping : {0.0, 2.0, 8.0}) {
    const auto rate = [&](double dt) {
      test::Machine machine = test::cable_pendulum(mass, 1.0, 0.0);
      machine.model.step = test::settings(dt, 1, 3);
      machine.cables[0].compliance = compliance;
      machine.cables[0].damping = damping;
      machine.cables[0].rest_lengths = {1.0 - mass * g * compliance - 0.01};  // 1 cm off balance
      Simulation s = test::start(machine);
      const double balance = -(1.0 - 0.01);
      std::array<double, 4> y{};
      for (double& sample : y) {
        sample = s.world.position({0}).y() - balance;
        test::run(s.world, s.world.state().time + 0.08);  // about a quarter period
      }
      // y2 = p y1 + q y0,  y3 = p y2 + q y1.
      const double q = (y[2] * y[2] - y[1] * y[3]) / (y[0] * y[2] - y[1] * y[1]);
      return -0.5 * std::log(-q) / 0.08;
    };
    const double c1 = rate(4e-4);
    const double c2 = rate(2e-4);
    const double c4 = rate(1e-4);
    const double exact = damping / (2.0 * mass);
    const double frequency_squared = 1.0 / (compliance * mass);
    EXPECT_NEAR(2.0 * c4 - c2, exact, 1e-3 * (exact + 1.0)) << damping;
    EXPECT_NEAR(std::log2((c1 - c2) / (c2 - c4)), 1.0, 0.1) << damping;
    // The integrator's own share for b = 0.
    if (damping == 0.0) {
      EXPECT_NEAR(c4, 0.5 * frequency_squared * 1e-4, 0.02 * c4);
    }
  }
}

}  // namespace
}  // namespace sheave
