// Friction at links whose spans no body can lengthen: their tension follows from their neighbours
// alone (cable/cable_friction.cpp). Sums of a few numbers of some metres carry 1e-15 m of rounding;
// g h^2, the motion that a tension holds back in a step of 0.01 s, is 1e-3 m, so tensions are known
// to 1e-12, and velocities after 50 steps to 1e-11.

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"

namespace sheave::open_span {
namespace {

using test::attach;
using test::cable;
using test::eyelet;
using test::g;
using test::left;
using test::post;
using test::right;
using test::tensions;
using test::wrapped;

constexpr double exact = 1e-10;
constexpr double h = 0.01;

std::shared_ptr<SpoolLink> spool(BodyId body, Winding winding, double stored) {
  auto link = std::make_shared<SpoolLink>();
  link->body = body;
  link->winding = winding;
  link->stored_length = stored;
  return link;
}

class OpenSpan : public test::ForEveryCombination {
 protected:
  static test::Machine machine() {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step_settings(h, 20);
    return m;
  }
};
INSTANTIATE_TEST_SUITE_P(All, OpenSpan, testing::ValuesIn(test::combinations),
                         test::combination_name);

/// Weights m1 and m2 that hang from what turns the cable by half a turn in all, with the friction
/// mu: with q = e^(mu pi), both have the acceleration a = (m2 - q m1) g / (m2 + q m1) where m2 > q
/// m1, and each bend its share of q.
void expect_capstan(const test::Machine& m, double m1, double m2, double friction,
                    const std::vector<double>& bends) {
  constexpr double time = 0.5;
  Simulation s = test::start(m);
  test::run(s.world, time);
  const CableReport report = s.cable_reports()[0];
  const double q = std::exp(friction * pi);
  const double light = std::min(m1, m2);
  const double heavy = std::max(m1, m2);
  const double a = heavy > q * light ? (heavy - q * light) * g / (heavy + q * light) : 0.0;
  const double way = m2 > m1 ? 1.0 : -1.0;
  EXPECT_NEAR(s.world.velocity({0}).y(), way * a * time, exact);
  EXPECT_NEAR(s.world.velocity({1}).y(), -way * a * time, exact);
  EXPECT_LT(report.max_stretch, 1e-12);
  const std::vector<double> t = tensions(report);
  EXPECT_NEAR(t.front(), m1 * (g + way * a), exact * m1 * g);
  EXPECT_NEAR(t.back(), m2 * (g - way * a), exact * m2 * g);
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const double held = std::exp(friction * bends[i]);
    if (a > 0.0) {
      EXPECT_NEAR(t[i + 1] / t[i], m2 > m1 ? held : 1.0 / held, exact * held) << "bend " << i;
    } else {
      EXPECT_LE(t[i + 1] / t[i], held * (1.0 + exact)) << "bend " << i;
      EXPECT_GE(t[i + 1] / t[i], (1.0 - exact) / held) << "bend " << i;
      EXPECT_EQ(report.links[i + 1].slip, 0.0);
    }
  }
}

constexpr std::array<std::array<double, 2>, 4> weights{{{1, 3}, {3, 1}, {1, 1.3}, {1.3, 1}}};

TEST_P(OpenSpan, TwoEyeletsAreOneCapstan) {
  for (const auto& [m1, m2] : weights) {
    test::Machine m = machine();
    m.model.add(test::weight("first", {0, -4, 0}, m1));
    m.model.add(test::weight("second", {1, -4, 0}, m2));
    m.cables.push_back(cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, 0.1),
                                      eyelet(BodyId::world(), {1, 0, 0}, 0.1), attach({1})}));
    expect_capstan(m, m1, m2, 0.1, {0.5 * pi, 0.5 * pi});
  }
}

TEST_P(OpenSpan, TwoPostsAreOneCapstan) {
  for (const auto& [m1, m2] : weights) {
    test::Machine m = machine();
    m.model.add(test::weight("first", {-0.2, -4, 0}, m1));
    m.model.add(test::weight("second", {1.2, -4, 0}, m2));
    const BodyId a = m.model.add(post("a", {0, 0, 0}, 0.2));
    const BodyId b = m.model.add(post("b", {1, 0, 0}, 0.2));
    m.cables.push_back(
        cable("rope", {attach({0}), wrapped(a, right, 0.1), wrapped(b, right, 0.1), attach({1})}));
    expect_capstan(m, m1, m2, 0.1, {0.5 * pi, 0.5 * pi});
  }
}

TEST_P(OpenSpan, FiveEyeletsOnHalfACircleAreOneCapstan) {
  for (const auto& [m1, m2] : weights) {
    test::Machine m = machine();
    m.model.add(test::weight("first", {-1, -4, 0}, m1));
    m.model.add(test::weight("second", {1, -4, 0}, m2));
    CableDef rope = cable("rope", {attach({0})});
    for (int i = 0; i < 5; ++i) {
      const double angle = pi - 0.25 * pi * i;
      const Vector3 point(std::cos(angle), std::sin(angle), 0.0);
      rope.links.push_back(eyelet(BodyId::world(), point, 0.1));
    }
    rope.links.push_back(attach({1}));
    m.cables.push_back(rope);
    expect_capstan(m, m1, m2, 0.1, {pi / 8.0, 0.25 * pi, 0.25 * pi, 0.25 * pi, pi / 8.0});
  }
}

/// A drum on the world winds a rope in and pays it out over a static post: speed, then rest, then
/// back.
test::Machine winch(StepSettings step) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef drum = test::wheel("drum", {0, 0, 0}, 0.2, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_times = {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0};
  drum.drive_values = {0.0, 2.0, 2.0, 0.0, 0.0, -2.0, 0.0};
  m.model.add(drum);
  m.model.add(post("post", {1.5, 0.1, 0}, 0.1));
  m.model.add(test::weight("load", {1.6, -5, 0}, 20.0));
  m.cables.push_back(
      cable("rope", {spool({0}, right, 3.0), wrapped({1}, right, 0.5), attach({2})}));
  m.cables.back().breaking_tension = 2000.0;
  return m;
}

TEST_P(OpenSpan, ADrivenDrumPullsItsRopeOverAPost) {
  Simulation s = test::start(winch(step_settings(h, 20)));
  const double start = s.world.position({2}).y();
  // Of steps within one piece of the drive's table, whose acceleration is exact.
  struct Moment {
    double time;
    double acceleration;  ///< of the drum [rad/s2]
    int pulls;            ///< +1: the drum's side carries more; 0: what it had last
  };
  for (const Moment& at : {Moment{0.4, 4.0, 1}, Moment{0.8, 0.0, 1}, Moment{1.3, -4.0, 1},
                           Moment{1.8, 0.0, 0}, Moment{2.3, -4.0, -1}, Moment{2.8, 4.0, -1}}) {
    test::run(s.world, at.time);
    SCOPED_TRACE(at.time);
    const CableReport report = s.cable_reports()[0];
    ASSERT_FALSE(report.cut);
    EXPECT_LT(report.max_stretch, 1e-12);
    EXPECT_NEAR(s.world.position({2}).y() - start, 0.2 * s.world.state().bodies[0].angle, exact);
    const double carried = 20.0 * (g + 0.2 * at.acceleration);
    EXPECT_NEAR(report.spans[1].tension, carried, 1e-8 * carried);
    if (at.pulls == 0) continue;
    const double held = std::exp(at.pulls * 0.5 * report.links[1].wrap_angle);
    EXPECT_NEAR(report.spans[0].tension / report.spans[1].tension, held, 1e-9);
  }
}

TEST_P(OpenSpan, KeepsTheTensionOfTheLastSlip) {
  Simulation s = test::start(winch(step_settings(h, 20)));
  const auto drum_side = [&] { return s.cable_reports()[0].spans[0].tension; };
  const double held = std::exp(0.5 * s.cable_reports()[0].links[1].wrap_angle);
  // From 1.5 s to 2 s the drum rests after winding in and slowing down by 4 rad/s2; from 3 s on
  // after paying out.
  test::run(s.world, 1.9);
  EXPECT_NEAR(drum_side(), held * 20.0 * (g - 0.8), 1e-6);
  test::run(s.world, 3.5);
  EXPECT_NEAR(drum_side(), 20.0 * (g + 0.8) / held, 1e-6);
}

TEST_P(OpenSpan, ADeadEndCarriesTheNearestTensionInTheConeOfItsPost) {
  test::Machine m = machine();
  m.model.add(test::weight("load", {0.1, -3, 0}, 20.0));
  const BodyId round = m.model.add(post("post", {0, 0, 0}, 0.1));
  m.cables.push_back(cable(
      "rope", {attach(BodyId::world(), {-0.1, -2, 0}), wrapped(round, right, 0.2), attach({0})}));
  Simulation s = test::start(m);
  test::run(s.world, 0.5);
  const std::vector<double> t = tensions(s.cable_reports()[0]);
  // Nothing has ever pulled there, and 0 is outside the cone.
  EXPECT_NEAR(t[0], 20.0 * g * std::exp(-0.2 * pi), 1e-8);
  EXPECT_NEAR(t[1], 20.0 * g, 1e-8);
  EXPECT_EQ(s.world.velocity({0}).y(), 0.0);
}

TEST_P(OpenSpan, AFeedPushesAndPullsThroughAFrictionalEyelet) {
  for (const double speed : {0.5, -0.5}) {
    test::Machine m = machine();
    BodyDef load = test::weight("load", {2, -3, 0}, 20.0);
    load.velocity = {0.0, -speed, 0.0};
    m.model.add(load);
    auto feed = attach(BodyId::world(), {0, 0, 0});
    feed->feed_speed = speed;
    m.cables.push_back(cable("rope", {feed, eyelet(BodyId::world(), {2, 0, 0}, 0.5), attach({0})}));
    Simulation s = test::start(m);
    test::run(s.world, 1.0);
    const std::vector<double> t = tensions(s.cable_reports()[0]);
    const double held = std::exp(0.5 * 0.5 * pi);
    EXPECT_NEAR(s.world.position({0}).y(), -3.0 - speed, exact);
    EXPECT_NEAR(t[1], 20.0 * g, 1e-8);
    EXPECT_NEAR(t[0], 20.0 * g * (speed > 0.0 ? 1.0 / held : held), 1e-8);
  }
}

// A driven wheel under which the rope passes by half a turn, between two posts with a weight of m
// beyond each. It speeds up by b, so the weights would have to move with R b t.
struct WheelBetweenPosts {
  double post_friction = 0.0;
  double wheel_friction = 0.0;
  static constexpr double speeding = 1.0;  ///< b [rad/s2]
  static constexpr double radius = 0.5;

  [[nodiscard]] test::Machine machine(StepSettings step) const {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step;
    m.model.add(test::weight("first", {-1.5, -5, 0}, 2.0));
    m.model.add(test::weight("second", {1.5, -5, 0}, 2.0));
    const BodyId a = m.model.add(post("a", {-1, 0, 0}, 0.5));
    const BodyId b = m.model.add(post("b", {1, 0, 0}, 0.5));
    BodyDef driven = test::wheel("wheel", {0, -3, 0}, radius, 1.0);
    driven.drive = DriveKind::speed;
    driven.drive_times = {0.0, 1.0};
    driven.drive_values = {0.0, speeding};
    const BodyId wheel = m.model.add(driven);
    m.cables.push_back(cable("rope", {attach({0}), wrapped(a, right, post_friction),
                                      wrapped(wheel, left, wheel_friction),
                                      wrapped(b, right, post_friction), attach({1})}));
    return m;
  }
};

TEST_P(OpenSpan, ADrivenWheelSlipsBetweenPostsThatHold) {
  const WheelBetweenPosts setup{.post_friction = 0.4, .wheel_friction = 0.1};
  Simulation s = test::start(setup.machine(step_settings(h, 20)));
  test::run(s.world, 1.0);
  const CableReport report = s.cable_reports()[0];
  const std::vector<double> t = tensions(report);
  EXPECT_NEAR(s.world.velocity({0}).y(), 0.0, exact);
  EXPECT_NEAR(s.world.velocity({1}).y(), 0.0, exact);
  EXPECT_NEAR(t[0], 2.0 * g, 1e-9);
  EXPECT_NEAR(t[3], 2.0 * g, 1e-9);
  // The wheel drags the rope towards the second weight.
  EXPECT_NEAR(t[1] / t[2], std::exp(0.1 * pi), 1e-9);
  EXPECT_NEAR(report.links[2].slip, -0.5 * WheelBetweenPosts::radius * WheelBetweenPosts::speeding,
              exact);
  EXPECT_LE(t[1] / t[0], std::exp(0.4 * pi) * (1.0 + exact));
  EXPECT_LE(t[3] / t[2], std::exp(0.4 * pi) * (1.0 + exact));
}

TEST_P(OpenSpan, ADrivenWheelDragsTheRopeOverPostsThatDoNotHold) {
  const WheelBetweenPosts setup{.post_friction = 0.05, .wheel_friction = 0.5};
  Simulation s = test::start(setup.machine(step_settings(h, 20)));
  test::run(s.world, 1.0);
  const CableReport report = s.cable_reports()[0];
  const std::vector<double> t = tensions(report);
  const double a = WheelBetweenPosts::radius * WheelBetweenPosts::speeding;
  EXPECT_NEAR(s.world.position({0}).y(), -5.0 + 0.5 * a, exact);
  EXPECT_NEAR(s.world.position({1}).y(), -5.0 - 0.5 * a, exact);
  EXPECT_NEAR(t[0], 2.0 * (g + a), 1e-8);
  EXPECT_NEAR(t[3], 2.0 * (g - a), 1e-8);
  EXPECT_NEAR(t[1] / t[0], std::exp(0.05 * pi), 1e-9);
  EXPECT_NEAR(t[3] / t[2], std::exp(0.05 * pi), 1e-9);
  EXPECT_EQ(report.links[2].slip, 0.0);
  EXPECT_LT(report.max_stretch, 1e-12);
}

TEST_P(OpenSpan, AnEyeletThatMovesTakesCableFromTheLighterSide) {
  // It rises beside a fixed one at v and carries the heavier weight along; the lighter one rises as
  // the span between them gets longer, by sqrt(1 + v^2 t^2) - 1.
  constexpr double v = 0.3;
  constexpr double friction = 0.3;
  test::Machine m = machine();
  m.model.add(test::weight("light", {0, -3, 0}, 1.0));
  BodyDef heavy = test::weight("heavy", {1, -3, 0}, 1.2);
  heavy.velocity = {0.0, v, 0.0};
  m.model.add(heavy);
  BodyDef guide;
  guide.name = "guide";
  guide.mobility = Mobility::kinematic;
  guide.position = {1, 0, 0};
  guide.velocity = {0.0, v, 0.0};
  m.model.add(guide);
  m.cables.push_back(cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, friction),
                                    eyelet({2}, {0, 0, 0}, friction), attach({1})}));
  Simulation s = test::start(m);
  test::run(s.world, 1.0);
  const CableReport report = s.cable_reports()[0];
  const std::vector<double> t = tensions(report);
  EXPECT_NEAR(s.world.position({0}).y(), -3.0 + std::hypot(1.0, v) - 1.0, exact);
  EXPECT_NEAR(s.world.position({1}).y(), -3.0 + v, exact);
  // `rattle` reports the mean of a substep, whose halves have the angles of its start and of its
  // end.
  const auto held = [&](double time) {
    return std::exp(friction * (0.5 * pi - std::atan(v * time)));
  };
  EXPECT_GE(t[1] / t[0], held(1.0) - 1e-9);
  EXPECT_LE(t[1] / t[0], held(GetParam().rattle() ? 1.0 - h : 1.0) + 1e-9);
  EXPECT_NEAR(t[2], 1.2 * g, 1e-8);
  EXPECT_EQ(report.links[2].slip, 0.0);
}

// A bob of 2 kg swings on a rope that it pulls over a frictional eyelet, against 1 kg on a level
// rail. In polar coordinates,
// with q = e^(mu (pi / 2 - phi)):  (m2 + q m1) r'' = m2 (g cos phi + r phi'^2),  r phi'' + 2 r' phi' = -g sin phi.
struct SlidingSwing {
  static constexpr double friction = 0.1;
  static constexpr double time = 0.5;

  [[nodiscard]] static std::array<double, 4> rates(const std::array<double, 4>& s) {
    const auto [r, phi, dr, dphi] = s;
    const double q = std::exp(friction * (0.5 * pi - phi));
    return {dr, dphi, 2.0 * (g * std::cos(phi) + r * dphi * dphi) / (2.0 + q),
            (-g * std::sin(phi) - 2.0 * dr * dphi) / r};
  }
  /// Where the bob is in the end, by Runge and Kutta's rule with an error below 1e-12.
  [[nodiscard]] static Vector3 end() {
    constexpr int steps = 5000;
    constexpr double dt = time / steps;
    std::array<double, 4> s{std::hypot(0.8, 1.2), std::atan2(0.8, 1.2), 0.0, 0.0};
    const auto moved = [](const std::array<double, 4>& from, const std::array<double, 4>& by,
                          double share) {
      std::array<double, 4> to{};
      for (std::size_t i = 0; i < 4; ++i) to[i] = from[i] + share * by[i];
      return to;
    };
    for (int i = 0; i < steps; ++i) {
      const auto k1 = rates(s);
      const auto k2 = rates(moved(s, k1, 0.5 * dt));
      const auto k3 = rates(moved(s, k2, 0.5 * dt));
      const auto k4 = rates(moved(s, k3, dt));
      for (std::size_t j = 0; j < 4; ++j) {
        s[j] += dt / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
      }
    }
    return {s[0] * std::sin(s[1]), -s[0] * std::cos(s[1]), 0.0};
  }
  [[nodiscard]] static double error(StepSettings step) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step;
    BodyDef counterweight = test::weight("counterweight", {-3, 0, 0}, 1.0);
    counterweight.axis = Vector3::UnitX();
    m.model.add(counterweight);
    BodyDef bob = test::lump("bob", {0.8, -1.2, 0}, 2.0);
    bob.mobility = Mobility::planar;
    m.model.add(bob);
    m.cables.push_back(
        cable("rope", {attach({0}), eyelet(BodyId::world(), {0, 0, 0}, friction), attach({1})}));
    Simulation s = test::start(m);
    test::run(s.world, time);
    return (s.world.position({1}) - end()).norm();
  }
};

TEST_P(OpenSpan, SlidingWithFrictionHasTheOrderOfTheIntegrator) {
  // The error's next term is a few per cent of the first at 100 Hz and halves with the step.
  const double coarse = SlidingSwing::error(step_settings(0.01, 50));
  const double fine = SlidingSwing::error(step_settings(0.005, 50));
  EXPECT_NEAR(std::log2(coarse / fine), GetParam().rattle() ? 2.0 : 1.0, 0.1);
  EXPECT_LT(coarse, GetParam().rattle() ? 1e-4 : 3e-2);
}

TEST_P(OpenSpan, ABlockWithTwoFrictionalHolesRunsAlongItsRope) {
  // Mass M on two strands with holes of a quarter turn each; the counterweight m rises by 2 x when
  // it falls by x. What its strand pulls with, T, the dead end has e^(mu pi) times, so M a = M g -
  // (1 + e^(mu pi)) T and T = m (g + 2 a).
  for (const double friction : {0.05, 0.2, 0.5}) {
    const double block = 20.0;
    const double counterweight = 1.5;
    test::Machine m = machine();
    BodyDef carried = test::weight("block", {0, 0, 0}, block);
    m.model.add(carried);
    m.model.add(test::weight("counterweight", {2, 2, 0}, counterweight));
    m.cables.push_back(cable(
        "rope", {attach(BodyId::world(), {-0.5, 5, 0}), eyelet({0}, {-0.5, 0, 0}, friction),
                 eyelet({0}, {0.5, 0, 0}, friction), eyelet(BodyId::world(), {0.5, 5, 0}, 0.0),
                 eyelet(BodyId::world(), {2, 5, 0}, 0.0), attach({1})}));
    Simulation s = test::start(m);
    test::run(s.world, 0.5);
    const CableReport report = s.cable_reports()[0];
    const std::vector<double> t = tensions(report);
    const double q = std::exp(friction * pi);
    const double a =
        (block - (1.0 + q) * counterweight) * g / (block + 2.0 * (1.0 + q) * counterweight);
    EXPECT_NEAR(s.world.velocity({0}).y(), -0.5 * a, exact);
    EXPECT_NEAR(t[4], counterweight * (g + 2.0 * a), 1e-9);
    EXPECT_NEAR(t[1] / t[2], std::sqrt(q), 1e-9);
    EXPECT_NEAR(t[0] / t[2], q, 1e-9);
    EXPECT_LT(report.max_stretch, 1e-12);
  }
}

TEST_P(OpenSpan, ASheathOfFrictionalHolesHoldsItsTendon) {
  // A bar on an axle, pulled down by a weight at 1 m, held by a tendon that runs through holes
  // along it and ends on it: between holes the tendon cannot give, so the first span holds the bar
  // with the moment of the weight.
  test::Machine m = machine();
  BodyDef bar = test::wheel("bar", {0, 0, 0}, 0.1, 0.5);
  bar.torque = {0.0, 0.0, -2.0 * g};
  m.model.add(bar);
  m.cables.push_back(
      cable("tendon", {attach(BodyId::world(), {0.3, 0.8, 0}), eyelet({0}, {0.3, 0.1, 0}, 0.2),
                       eyelet({0}, {0.5, 0.05, 0}, 0.2), eyelet({0}, {0.7, 0.1, 0}, 0.2),
                       attach({0}, {0.9, 0.0, 0})}));
  Simulation s = test::start(m);
  test::run(s.world, 1.0);
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(report.spans[0].length, 0.7, exact);
  // Sweeps pull along the direction of the prediction, which is turned by a h^2 with a = 2 g / 0.5
  // kg m2.
  const bool swept = GetParam().solver == SolverKind::gauss_seidel && !GetParam().rattle();
  const double share = swept ? 2.0 * g / 0.5 * h * h : 1e-10;
  EXPECT_NEAR(report.spans[0].tension, 2.0 * g / 0.3, share * 2.0 * g / 0.3);
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), 0.0, exact);
  for (const LinkReport& link : report.links) EXPECT_EQ(link.slip, 0.0);
}

// A rope from a wall over a quarter of a spinning wheel and round a quarter of a rough eyelet to a
// weight. Nothing moves but the wheel, over which the rope slides: with T1 = m g e^(-mu' pi / 2),
// the least that the eyelet holds, and T0 = T1 e^(+-mu pi / 2), larger where the wheel drags the
// rope away from the wall, it slows down by |T0 - T1| r / I, and once it has stopped it stays.
TEST_P(OpenSpan, WheelThatSpinsUnderTheRope) {
  for (const double sense : {-1.0, 1.0}) {
    constexpr double radius = 0.2;
    constexpr double inertia = 0.4;
    constexpr double spin = 5.0;
    constexpr double mass = 2.0;
    test::Machine m = machine();
    BodyDef brake = test::wheel("wheel", {0, 0, 0}, radius, inertia);
    brake.angular_velocity = {0, 0, sense * spin};
    const BodyId wheel = m.model.add(brake);
    const BodyId load = m.model.add(test::weight("load", {1, -1, 0}, mass));
    m.cables.push_back(
        cable("rope", {attach(BodyId::world(), {-radius, -1, 0}), wrapped(wheel, right, 0.2),
                       eyelet(BodyId::world(), {1, radius, 0}, 0.3), attach(load)}));
    Simulation s = test::start(m);
    const double t1 = mass * g * std::exp(-0.3 * 0.5 * pi);
    const double t0 = t1 * std::exp(-sense * 0.2 * 0.5 * pi);
    const double slows = std::abs(t0 - t1) * radius / inertia;
    const double stops = spin / slows;
    test::run(s.world, 0.5 * stops);
    const double time = s.world.state().time;
    EXPECT_NEAR(s.world.angular_velocity(wheel).z(), sense * (spin - slows * time), exact * spin);
    const std::vector<double> t = tensions(s.cable_reports()[0]);
    EXPECT_NEAR(t[0], t0, exact * t0);
    EXPECT_NEAR(t[1], t1, exact * t1);
    EXPECT_NEAR(t[2], mass * g, exact * mass * g);
    ASSERT_TRUE(s.certificate().has_value());
    EXPECT_TRUE(s.certificate()->clean(1e-9)) << s.certificate()->worst()->sentence();
    test::run(s.world, 1.5 * stops);
    EXPECT_NEAR(s.world.angular_velocity(wheel).z(), 0.0, exact * spin);
    EXPECT_NEAR(s.world.position(load).y(), -1.0, exact);
  }
}

// The same with a weight that swings, so that what brakes the wheel changes all the time: its torques
// balance, and a run from the middle is the same to the bit.
TEST_P(OpenSpan, WheelUnderASwingingWeight) {
  test::Machine m = machine();
  BodyDef brake = test::wheel("wheel", {0, 0, 0}, 0.2, 0.4);
  brake.angular_velocity = {0, 0, -20.0};
  const BodyId wheel = m.model.add(brake);
  const BodyId load = m.model.add(test::lump("load", {1.6, -0.6, 0}, 2.0));
  m.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-0.2, -1, 0}), wrapped(wheel, right, 0.2),
                     eyelet(BodyId::world(), {1, 0.2, 0}, 0.3), attach(load)}));
  Simulation s = test::start(m);
  test::run(s.world, 0.3);
  const State middle = s.world.state();
  test::run(s.world, 0.6);
  const Certificate checked = s.certificate().value();
  const auto* torques = checked.find(CertificateItem::Kind::angular_momentum);
  ASSERT_NE(torques, nullptr);
  const bool swept = GetParam().solver == SolverKind::gauss_seidel;
  EXPECT_LT(torques->relative, swept ? 1e-2 : 1e-6) << torques->sentence();
  const std::uint64_t once = hash(s.world.state());
  Simulation again = test::start(m);
  ASSERT_TRUE(again.world.restore(middle).empty());
  test::run(again.world, 0.6);
  EXPECT_EQ(hash(again.world.state()), once);
}

}  // namespace
}  // namespace sheave::open_span
