#include "render/cable_path.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sheave::render {
namespace {

/// A cable from a point down on the left over a wheel (radius 1 at the origin, clockwise: over the
/// top) to a point down on the right, with `turns` whole turns more than the half turn.
CableReport over_a_wheel(int turns) {
  CableReport cable;
  cable.links.resize(3);
  cable.links[0].center = cable.links[0].entry = cable.links[0].exit = {-1, -2, 0};
  LinkReport& wheel = cable.links[1];
  wheel.radius = 1.0;
  wheel.winding = -1;
  wheel.entry = {-1, 0, 0};
  wheel.exit = {1, 0, 0};
  wheel.wrap_angle = pi + 2.0 * pi * turns;
  wheel.stored_length = wheel.wrap_angle;
  cable.links[2].center = cable.links[2].entry = cable.links[2].exit = {1, -2, 0};
  cable.spans.resize(2);
  cable.spans[0] = {{-1, -2, 0}, {-1, 0, 0}, 2.0, 2.0, 10.0};
  cable.spans[1] = {{1, 0, 0}, {1, -2, 0}, 2.0, 2.0, 5.0};
  return cable;
}

double length_of(const Tube& tube) {
  double sum = 0.0;
  for (std::size_t i = 1; i < tube.points.size(); ++i) {
    sum += (tube.points[i].position - tube.points[i - 1].position).norm();
  }
  return sum;
}

TEST(CablePath, RunsRoundTheRightSideOfTheWheel) {
  const CableStyle style{.radius = 0.02, .tension_max = 10.0};
  const std::vector<Tube> tubes = cable_tubes(over_a_wheel(0), style);
  ASSERT_EQ(tubes.size(), 1U);
  double highest = -1e9;
  for (const TubePoint& p : tubes[0].points) {
    highest = std::max(highest, p.position.y());
    EXPECT_GE(p.position.norm(), 1.0 - 1e-12);
    EXPECT_EQ(p.position.z(), 0.0);
  }
  EXPECT_NEAR(highest, 1.0, 1e-2);
  EXPECT_NEAR(length_of(tubes[0]), 4.0 + pi, 2e-3);
  EXPECT_EQ(tubes[0].points.front().color, sample(ColorMap::tension, 1.0));
  EXPECT_EQ(tubes[0].points.back().color, sample(ColorMap::tension, 0.5));
}

TEST(CablePath, APointHasNoWindingsAtAnyDeflection) {
  CableReport cable = over_a_wheel(0);
  LinkReport& hole = cable.links[1];
  hole.radius = hole.stored_length = 0.0;
  hole.winding = 0;
  hole.center = hole.entry = hole.exit = cable.spans[0].end = cable.spans[1].start = {0, 1, 0};
  hole.wrap_angle = 2.0;
  const CableStyle style{.radius = 0.02, .tension_max = 10.0, .winding_room = {0, 0.5, 0}};
  const std::vector<Tube> tubes = cable_tubes(cable, style);
  ASSERT_EQ(tubes.size(), 2U);
  for (const Tube& tube : tubes) EXPECT_NEAR(length_of(tube), std::sqrt(10.0), 1e-12);
}

TEST(CablePath, SeveralTurnsLieSideBySide) {
  CableStyle style{.radius = 0.02, .tension_max = 10.0, .winding_room = {0, 0.5, 0}};
  const std::vector<Tube> tubes = cable_tubes(over_a_wheel(3), style);
  ASSERT_EQ(tubes.size(), 1U);
  EXPECT_NEAR(length_of(tubes[0]), 4.0 + 7.0 * pi, 0.05);
  // A point and the one a turn later are at least a diameter apart.
  const double shift = tubes[0].points.back().position.z() - tubes[0].points.front().position.z();
  EXPECT_EQ(shift, 0.0);  // attachments stay where they are
  double lowest = 0.0;
  double highest = 0.0;
  for (const TubePoint& p : tubes[0].points) {
    lowest = std::min(lowest, p.position.z());
    highest = std::max(highest, p.position.z());
  }
  EXPECT_GE((highest - lowest) / 3.5, 2.0 * style.radius);
  EXPECT_LE(highest - lowest, 0.5);
}

TEST(CablePath, CountsTurnsFromTheStoredLength) {
  for (int turns = 0; turns < 5; ++turns) {
    const CableReport cable = over_a_wheel(turns);
    EXPECT_NEAR(wound_angle(cable.links[1], false), pi + 2.0 * pi * turns, 1e-12);
  }
  // Geometry decides the fraction of a turn, also where the stored length has drifted.
  LinkReport wheel = over_a_wheel(1).links[1];
  wheel.wrap_angle += 0.3;
  EXPECT_NEAR(wound_angle(wheel, false), 3.0 * pi, 1e-12);
  wheel.exit = wheel.entry;
  wheel.wrap_angle = 1e-3;
  EXPECT_NEAR(wound_angle(wheel, false), 0.0, 1e-12);
  wheel.wrap_angle = 7.5;
  EXPECT_EQ(wound_angle(wheel, true), 7.5);
}

TEST(CablePath, VeryManyTurnsStayDrawable) {
  CableReport cable = over_a_wheel(100000);
  const CableStyle style{.radius = 0.02, .tension_max = 10.0, .winding_room = {0, 0.5}};
  const std::vector<Tube> tubes = cable_tubes(cable, style);
  ASSERT_EQ(tubes.size(), 1U);
  EXPECT_LT(tubes[0].points.size(), 5000U);
  // It still ends at the exit.
  EXPECT_NEAR(tubes[0].points[tubes[0].points.size() - 3].position.x(), 1.0, 1e-3);
}

TEST(CablePath, SlackSpanHangsWithItsRestLength) {
  CableReport cable;
  cable.links.resize(2);
  cable.links[1].center = cable.links[1].entry = cable.links[1].exit = {1, 0, 0};
  cable.spans = {{{0, 0, 0}, {1, 0, 0}, 1.0, 1.5, 0.0}};
  CableStyle style{.radius = 0.01};
  EXPECT_TRUE(is_slack(cable.spans[0]));
  std::vector<Tube> tubes = cable_tubes(cable, style);
  ASSERT_EQ(tubes.size(), 1U);
  EXPECT_NEAR(length_of(tubes[0]), 1.5, 2e-3);
  EXPECT_EQ(tubes[0].points[5].color, slack_color);
  // A floor holds it up.
  style.floor = Plane{.point = {0, -0.2, 0}};
  tubes = cable_tubes(cable, style);
  for (const TubePoint& p : tubes[0].points) EXPECT_GE(p.position.y(), -0.19 - 1e-12);
  // With tension it is straight, even if the solver left it a little long.
  cable.spans[0].tension = 1.0;
  EXPECT_EQ(cable_tubes(cable, style)[0].points.size(), 2U);
}

TEST(CablePath, ClosedCableIsARing) {
  CableReport belt;
  belt.closed = true;
  belt.links.resize(2);
  for (int i = 0; i < 2; ++i) {
    LinkReport& wheel = belt.links[static_cast<std::size_t>(i)];
    const double x = 3.0 * i;
    wheel.center = {x, 0, 0};
    wheel.radius = 1.0;
    wheel.winding = 1;
    wheel.entry = {x, i == 0 ? 1.0 : -1.0, 0};
    wheel.exit = {x, i == 0 ? -1.0 : 1.0, 0};
    wheel.wrap_angle = pi;
  }
  belt.spans = {{{0, -1, 0}, {3, -1, 0}, 3, 3, 2.0}, {{3, 1, 0}, {0, 1, 0}, 3, 3, 1.0}};
  const CableStyle style{.radius = 0.02, .tension_max = 2.0};
  const std::vector<Tube> tubes = cable_tubes(belt, style);
  ASSERT_EQ(tubes.size(), 1U);
  EXPECT_TRUE(tubes[0].closed);
  EXPECT_NEAR(length_of(tubes[0]), 6.0 + 2.0 * pi, 1e-2);
}

TEST(CablePath, SpoolAtTheEndIsWoundFromItsStoredLength) {
  CableReport cable = over_a_wheel(0);
  cable.links.erase(cable.links.begin());
  cable.spans.erase(cable.spans.begin());
  cable.links[0].entry = cable.links[0].exit;
  cable.links[0].wrap_angle = 5.0 * pi;
  const CableStyle style{.radius = 0.02, .tension_max = 10.0, .winding_room = {0.4}};
  const std::vector<Tube> tubes = cable_tubes(cable, style);
  ASSERT_EQ(tubes.size(), 1U);
  EXPECT_NEAR(length_of(tubes[0]), 5.0 * pi + 2.0, 0.05);
}

}  // namespace
}  // namespace sheave::render
