// Cables that are cut or break: a piece with a free end pulls at nothing.

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;

TEST(Cut, AtItsTimeBothWeightsOfAnAtwoodMachineFall) {
  const test::Atwood atwood;
  test::Machine m = atwood.machine();
  m.model.step = test::settings(0.01, 4, 20);
  m.cables[0].cut_time = 0.2;
  Simulation s = test::start(m);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
  const double a = atwood.acceleration();
  ASSERT_EQ(s.cables->events().size(), 1U);
  EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::cut);
  EXPECT_NEAR(s.cables->events()[0].time, 0.2, 1e-12);
  EXPECT_NEAR(s.world.velocity({1}).y(), 0.2 * a, 1e-6);
  const double spin = s.world.angular_velocity({0}).z();
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_NEAR(s.world.velocity({1}).y(), 0.2 * a - 0.3 * g, 1e-6);
  EXPECT_NEAR(s.world.velocity({2}).y(), -0.2 * a - 0.3 * g, 1e-6);
  EXPECT_EQ(s.world.angular_velocity({0}).z(), spin) << "nothing turns the wheel";
  const CableReport report = s.cable_reports()[0];
  EXPECT_TRUE(report.cut);
  EXPECT_EQ(report.length_error, 0.0);
  EXPECT_NEAR(report.pieces[0] + report.pieces[1], report.total_length, 1e-12);
  for (const SpanReport& span : report.spans) EXPECT_EQ(span.tension, 0.0);
}

TEST(Cut, ACableBreaksAboveItsBreakingTension) {
  // A weight that swings on a cable: T = m (g cos a + v^2 / l) = m g (3 cos a - 2 cos a0), at most
  // 3 - 2 cos 60 = 2 m g.
  const double start = pi / 3.0;
  for (const double share : {0.9, 1.1}) {
    test::Machine m = test::cable_pendulum(1.0, 1.0, start);
    m.model.step = test::settings(0.0005, 1, 20);
    m.cables[0].breaking_tension = share * 2.0 * g;
    Simulation s = test::start(m);
    for (int i = 0; i < 2000 && s.cables->events().empty(); ++i) {
      ASSERT_TRUE(s.world.step().ok());
    }
    EXPECT_EQ(s.cables->events().size(), share < 1.0 ? 1U : 0U);
    if (share > 1.0) continue;
    // It breaks where 3 cos a - 1 = 1.8. XPBD's damping, of order h, shifts that.
    const Vector3 x = s.world.position({0});
    EXPECT_NEAR(-x.y() / x.norm(), 2.8 / 3.0, 2e-3);
    const Vector3 v = s.world.velocity({0});
    ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR((s.world.velocity({0}) - v - 0.0005 * test::down).norm(), 0.0, 1e-12) << "free";
  }
}

/// A hand draws a mass by a spring at the speed v: T = (v / w) / c sin wt, and the mass has the speed
/// v (1 - cos wt). Returns the errors of the instant of the break [s] and of the speed then [m/s].
std::array<double, 2> drawn_until_it_breaks(StepSettings step) {
  constexpr double compliance = 0.01;
  constexpr double mass = 1.0;
  const double omega = 1.0 / std::sqrt(mass * compliance);
  test::Machine m;
  m.model.step = step;
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  hand.position = {1.0, 0.0, 0.0};
  hand.velocity = {1.0, 0.0, 0.0};
  const BodyId drawing = m.model.add(hand);
  BodyDef load = test::weight("load", Vector3::Zero(), mass);
  load.axis = Vector3::UnitX();
  const BodyId drawn = m.model.add(load);
  CableDef rope = cable("rope", {attach(drawn), attach(drawing)});
  rope.compliance = compliance;
  rope.breaking_tension = 5.0;
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  for (int i = 0; i < 2000 && s.cables->events().empty(); ++i) EXPECT_TRUE(s.world.step().ok());
  EXPECT_EQ(s.cables->events().size(), 1U);
  const double phase = std::asin(5.0 * compliance * omega);
  return {s.cables->events()[0].time - phase / omega,
          s.world.velocity(drawn).x() - (1.0 - std::cos(phase))};
}

TEST(Cut, ACableBreaksAtTheInstantOfItsBreakingTension) {
  // Of the order of the integrator; a break at the end of its substep would be off by up to h, and
  // by no power of h.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const bool rattle = integrator == IntegratorKind::rattle;
    std::array<double, 2> coarse{};
    for (const int substeps : {1, 2, 4, 8, 16, 32}) {
      SCOPED_TRACE(std::string(rattle ? "rattle" : "xpbd") + ", substeps " +
                   std::to_string(substeps));
      const std::array<double, 2> error =
          drawn_until_it_breaks(test::direct_settings(integrator, 1.0 / 120.0, substeps));
      const double turn = 10.0 / 120.0 / substeps;  // w h
      // Implicit Euler: terms of wh / 2 times those of the motion. `rattle`: (wh)^2 / 24 of them, and
      // the part that ends at the break is shorter than the others.
      EXPECT_LT(std::abs(error[0]), (rattle ? 0.1 * turn * turn : 0.06 * turn));
      EXPECT_LT(std::abs(error[1]), (rattle ? 0.5 * turn * turn : 0.5 * turn));
      coarse = error;
    }
    EXPECT_LT(std::abs(coarse[0]), rattle ? 1e-7 : 2e-4);
  }
}

TEST(Cut, ARopeThatIsWoundUpBreaksAtTheInstantOfItsBreakingTension) {
  // A drum with the speed v winds up a rope of the length L: L / v ln(1 + T / EA).
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 3, 10}) {
      SCOPED_TRACE(std::string(integrator_names[static_cast<std::size_t>(integrator)]) +
                   ", substeps " + std::to_string(substeps));
      test::Machine m;
      m.model.step = test::direct_settings(integrator, 1.0 / 60.0, substeps);
      BodyDef drum = test::wheel("drum", {4.0, 0.0, 0.0}, 0.1, 1.0);
      drum.drive = DriveKind::speed;
      drum.drive_values = {-1.0};
      m.model.add(drum);
      auto winding = test::roll({0}, test::right);
      winding->stored_length = 1.0;
      CableDef rope = cable("rope", {attach(BodyId::world(), {0.0, 0.1, 0.0}), winding});
      rope.axial_stiffness = 1e5;
      rope.breaking_tension = 2000.0;
      m.cables.push_back(rope);
      Simulation s = test::start(m);
      for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
      ASSERT_EQ(s.cables->events().size(), 1U);
      // The strain is summed up by the trapezoidal rule, of v h / L in the first order: (v h / L)^2 /
      // 12 of 0.8 s.
      const double part = 0.1 / 60.0 / substeps / 4.0;
      EXPECT_NEAR(s.cables->events()[0].time, 40.0 * std::log1p(0.02), part * part + 1e-9);
    }
  }
}

TEST(Cut, ASnapshotFromBeforeRestoresTheCable) {
  test::Machine m = test::Atwood{}.machine();
  m.cables[0].cut_time = 0.1;
  Simulation s = test::start(m);
  const State before = s.world.state();
  while (s.world.state().time < 0.2) ASSERT_TRUE(s.world.step().ok());
  const std::uint64_t after = hash(s.world.state());
  EXPECT_TRUE(s.cable_reports()[0].cut);
  ASSERT_TRUE(s.world.restore(before).empty());
  EXPECT_FALSE(s.cable_reports()[0].cut);
  while (s.world.state().time < 0.2) ASSERT_TRUE(s.world.step().ok());
  EXPECT_EQ(hash(s.world.state()), after);
}

}  // namespace
}  // namespace sheave
