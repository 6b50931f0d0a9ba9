// What happens to a cable at its links and falls on the very end of a substep, and a little to
// either side of it: touch, leave, attach, wind and break. Rounding decides in which substep they
// are found, and that must make no difference.
//
// Wheels are driven and weights keep cables taut, so where everything is follows from lengths
// alone.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/hybrid.h"
#include "cable/links/pinhole.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

constexpr double link_step = 1.0 / 60.0;
/// How much later than the end of a step [m], at some tenths of a metre per second.
constexpr std::array<double, 5> link_shifts{-1e-9, -1e-12, 0.0, 1e-12, 1e-9};
/// Lengths are solved to 1e-10 of a scene of some metres, or by sweeps.
constexpr double link_tolerance = 1e-8;

StepSettings link_settings(const test::Method& method) {
  StepSettings step = test::settings(link_step, 1, 50);
  step.solver = method.solver;
  step.integrator = method.integrator;
  return step;
}

std::string link_trace(const test::Method& method, double shift) {
  return test::name_of(method) + ", shift " + std::to_string(1e12 * shift) + "e-12";
}

/// Of a cable between two points 1 m to either side of a peg of radius r whose top is `height`
/// above their line: what it is longer by than the straight one. The tangents leave the peg at
/// acos(r / d) from the directions to the points.
double detour(double radius, double height) {
  if (height <= 0.0) return 0.0;
  const double below = radius - height;  // of its centre
  const double distance = std::hypot(1.0, below);
  const double arc = std::atan2(1.0, below) - std::acos(radius / distance);
  return 2.0 * (std::sqrt(distance * distance - radius * radius) + radius * arc - 1.0);
}

std::shared_ptr<PinholeLink> hole_at(double x) {
  auto hole = std::make_shared<PinholeLink>();
  hole->point = {x, 0.0, 0.0};
  return hole;
}

/// Two weights on a cable through two holes of the world, 2 m apart, and a peg below its middle
/// that moves at `speed`.
test::Machine pushed_cable(const test::Method& method, double top, double speed, bool lifted) {
  constexpr double radius = 0.1;
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = link_settings(method);
  BodyDef peg = test::wheel("peg", {0.0, top - radius, 0.0}, radius, 0.01);
  peg.mobility = Mobility::kinematic;
  peg.axis.reset();
  peg.velocity = {0.0, speed, 0.0};
  const BodyId pusher = m.model.add(peg);
  const double lift = 0.5 * detour(radius, top);
  const BodyId a = m.model.add(test::weight("a", {-1.0, lift - 1.0, 0.0}, 1.0));
  const BodyId b = m.model.add(test::weight("b", {1.0, lift - 1.0, 0.0}, 1.0));
  auto over = test::roll(pusher, test::right);
  over->lifted = lifted;
  m.cables.push_back(
      test::cable("rope", {test::attach(a), hole_at(-1.0), over, hole_at(1.0), test::attach(b)}));
  return m;
}

TEST(StepEndLinks, WheelsTouch) {
  for (const test::Method& method : test::methods) {
    for (const double shift : link_shifts) {
      SCOPED_TRACE(link_trace(method, shift));
      Simulation s = test::start(pushed_cable(method, -0.1 - shift, 0.2, true));
      for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
      ASSERT_EQ(s.cables->events().size(), 1U);
      EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::touch);
      EXPECT_NEAR(s.cables->events()[0].time, 0.5, 1.001 * link_step);
      for (const BodyId weight : {BodyId{1}, BodyId{2}}) {
        EXPECT_NEAR(s.world.position(weight).y(), 0.5 * detour(0.1, 0.1) - 1.0, link_tolerance);
      }
    }
  }
}

TEST(StepEndLinks, WheelsLeave) {
  for (const test::Method& method : test::methods) {
    for (const double shift : link_shifts) {
      SCOPED_TRACE(link_trace(method, shift));
      Simulation s = test::start(pushed_cable(method, 0.1 + shift, -0.2, false));
      for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
      ASSERT_EQ(s.cables->events().size(), 1U);
      EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::leave);
      EXPECT_NEAR(s.cables->events()[0].time, 0.5, 1.001 * link_step);
      for (const BodyId weight : {BodyId{1}, BodyId{2}}) {
        EXPECT_NEAR(s.world.position(weight).y(), -1.0, link_tolerance);
        EXPECT_NEAR(s.world.velocity(weight).y(), 0.0, link_tolerance / link_step);
      }
      int taut = 0;  // the span that went over the peg is one now
      const CableReport rope = s.cable_reports()[0];
      for (const SpanReport& span : rope.spans) {
        if (span.length == 0.0) continue;
        ++taut;
        EXPECT_NEAR(span.tension, test::g, 1e-3 * test::g);
      }
      EXPECT_EQ(taut, 3);
    }
  }
}

TEST(StepEndLinks, EndsAttachAndAreWoundUpAgain) {
  // A wheel turns by 4 t^2 - 4 t: its cable is used up at 0.25 s, and lies on it again from 0.75 s.
  // In between it hangs on a point of the rim that has turned on by p.
  constexpr double radius = 0.2;
  for (const test::Method& method : test::methods) {
    for (const double shift : link_shifts) {
      SCOPED_TRACE(link_trace(method, shift));
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = link_settings(method);
      BodyDef drum = test::wheel("wheel", Vector3::Zero(), radius, 0.02);
      drum.drive = DriveKind::speed;
      drum.drive_times = {0.0, 1.0};
      drum.drive_values = {-4.0, 4.0};
      const BodyId wheel = m.model.add(drum);
      BodyDef load = test::weight("weight", {radius, -1.0, 0.0}, 1.0);
      load.velocity = {0.0, -4.0 * radius, 0.0};
      const BodyId weight = m.model.add(load);
      auto end = std::make_shared<HybridLink>();
      end->body = wheel;
      end->winding = test::left;
      end->stored_length = 0.75 * radius + shift;
      m.cables.push_back(test::cable("rope", {test::attach(weight), end}));
      Simulation s = test::start(m);
      for (int i = 1; i <= 60; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        const double t = i * link_step;
        const double turned = 4.0 * t * (1.0 - t);
        const double on = std::max(turned - 0.75, 0.0);
        const double length = 1.0 + radius * std::min(turned, 0.75);
        const double off = radius * (1.0 - std::cos(on));
        const double y = -radius * std::sin(on) - std::sqrt(length * length - off * off);
        // An end that is found to be used up, or on the wheel again, a turn of a late takes the
        // straight way for the arc: r (a - sin a), each time. The wheel turns at 2 rad/s then.
        const double times = t > 0.75 ? 2.0 : 1.0;
        const double late = t > 0.25 ? 2.0 * link_step * 1.04 : 0.0;
        EXPECT_NEAR(s.world.position(weight).y(), y,
                    link_tolerance + times * radius * std::pow(late, 3) / 6.0)
            << t;
      }
      ASSERT_EQ(s.cables->events().size(), 2U);
      EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::attach);
      EXPECT_EQ(s.cables->events()[1].kind, CableEvent::Kind::wind);
      EXPECT_NEAR(s.cables->events()[0].time, 0.25, 1.001 * link_step);
      EXPECT_NEAR(s.cables->events()[1].time, 0.75, 1.001 * link_step);
    }
  }
}

TEST(StepEndLinks, CablesBreak) {
  // The strength is the tension at the end of the tenth step, by the place x and the speed v of the
  // bob there, T = g (-y) + v^2, or differs from it by little. The cable breaks at this end, or
  // beside it: the tension found at the instant has an error of second order, and with `xpbd` the
  // velocity is that of half a substep before, so that the speed is off by g h / 2 and the tension
  // by 3 g h v / 2. The tension grows by 3 g |x| v per second.
  for (const test::Method& method : test::methods) {
    test::Machine m = test::cable_pendulum(1.0, 1.0, 1.0);
    m.model.step = link_settings(method);
    Simulation whole = test::start(m);
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(whole.world.step().ok());
    const double speed = whole.world.velocity({0}).norm();
    const double tension = -test::g * whole.world.position({0}).y() + speed * speed;
    const double slope = 3.0 * test::g * std::abs(whole.world.position({0}).x()) * speed;
    const bool means = method.integrator == IntegratorKind::xpbd;
    const double h = link_step;
    for (const double share : {-1e-3, -1e-6, 0.0, 1e-6, 1e-3}) {
      SCOPED_TRACE(link_trace(method, share));
      m.cables[0].breaking_tension = tension * (1.0 + share);
      Simulation s = test::start(m);
      while (s.cables->events().empty()) ASSERT_TRUE(s.world.step().ok());
      const double error = means ? 1.5 * test::g * h * speed / slope : 10.0 * h * h;
      EXPECT_NEAR(s.cables->events()[0].time, 10.0 * h + share * tension / slope, error);
      const BodyState from = s.world.state().bodies[0];
      const int n = 9;
      for (int i = 0; i < n; ++i) ASSERT_TRUE(s.world.step().ok());
      ASSERT_EQ(s.cables->events().size(), 1U);
      // The bob flies freely. Implicit Euler falls by half a step more per step.
      const double sum = means ? n * (n + 1.0) : n * n;
      const Vector3 way = n * h * from.velocity + 0.5 * sum * h * h * test::down;
      EXPECT_NEAR((s.world.velocity({0}) - from.velocity - n * h * test::down).norm(), 0.0, 1e-11);
      EXPECT_NEAR((s.world.position({0}) - from.position - way).norm(), 0.0, 1e-11);
    }
  }
}

}  // namespace
}  // namespace sheave
