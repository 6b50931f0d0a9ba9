// Cables that are cut or break: a piece with a free end pulls at nothing.

#include <cmath>

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
    // It breaks where 3 cos a - 1 = 1.8. XPBD's damping, of order h, and the mean over a substep
    // shift that.
    const Vector3 x = s.world.position({0});
    EXPECT_NEAR(-x.y() / x.norm(), 2.8 / 3.0, 2e-3);
    const Vector3 v = s.world.velocity({0});
    ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR((s.world.velocity({0}) - v - 0.0005 * test::down).norm(), 0.0, 1e-12) << "free";
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
