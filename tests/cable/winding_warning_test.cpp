// Windings that cannot be meant, or look as if they were entered the wrong way round
// (cable/cable_compile_windings.cpp).

#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/math/turn_between.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::roll;

std::vector<cable_parts::WindingWarning> warnings_of(const test::Machine& machine) {
  return test::start(machine).cables->winding_warnings();
}

TEST(WindingWarning, NamesTheLinkAtWhichTheCableCrossesItself) {
  test::Machine m = test::Atwood{}.machine();
  EXPECT_TRUE(warnings_of(m).empty());
  m.cables[0].links[1] = roll({0}, left);
  const auto warnings = warnings_of(m);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].cable, "rope");
  EXPECT_EQ(warnings[0].link, 1);
  EXPECT_EQ(warnings[0].body, "wheel");
  EXPECT_EQ(warnings[0].better, Winding::clockwise);
  // Whole turns are meant.
  auto turn = roll({0}, left);
  turn->turns = 1;
  m.cables[0].links[1] = turn;
  EXPECT_TRUE(warnings_of(m).empty());
}

TEST(WindingWarning, IsSilentWithoutAFalseWinding) {
  EXPECT_TRUE(warnings_of(test::wheel_train(7, 1.0, 2.0, 0.2, 0.01)).empty());
  EXPECT_TRUE(warnings_of(test::Tackle{.strands = 4}.machine()).empty());
  test::Machine crossed = test::belt(0.3, 0.2, 1.0, 0.03, 0.01);
  crossed.cables[0].links[1] = roll({1}, right);
  EXPECT_TRUE(warnings_of(crossed).empty());
  // A weight beside the wheel: more than half a turn round it, without crossing.
  test::Machine m;
  const BodyId wheel = m.model.add(test::wheel("wheel", Vector3::Zero(), 0.3, 0.1));
  const BodyId weight = m.model.add(test::weight("weight", {0.3, -1.0, 0.0}, 1.0));
  m.cables.push_back(cable(
      "rope", {attach(BodyId::world(), {-2.0, -0.4, 0.0}), roll(wheel, right), attach(weight)}));
  EXPECT_TRUE(warnings_of(m).empty());
}

/// A cable from a point of the world to a weight that passes above a wheel of 0.3 m; if they are
/// not in one plane, the wheel's axle leans, too.
test::Machine passed_by(const std::shared_ptr<RollingLink>& link, double aside) {
  test::Machine m;
  BodyDef wheel = test::wheel("idler", Vector3::Zero(), 0.3, 0.1);
  if (aside != 0.0) {
    wheel.axis = Vector3(0.1, 0.2, 1.0);
    wheel.orientation = turn_between(Vector3::UnitZ(), wheel.axis->normalized());
  }
  link->body = m.model.add(wheel);
  const BodyId weight = m.model.add(test::weight("weight", {2.0, 0.5, -aside}, 1.0));
  m.cables.push_back(
      cable("rope", {attach(BodyId::world(), {-2.0, 0.5, aside}), link, attach(weight)}));
  return m;
}

// The wheel lies beneath the cable, as its winding says, and the cable does not reach it: between
// its tangents lie 349 degrees. Before, it began with 1.8 m of cable on the wheel, without a word.
TEST(GhostTurn, IsRefusedInOnePlaneAndInSpace) {
  for (const double aside : {0.0, 0.2}) {
    const test::Machine m = passed_by(roll({}, right), aside);
    const auto made = Simulation::create(m.model, m.cables);
    ASSERT_FALSE(made.ok()) << aside;
    ASSERT_EQ(made.errors().size(), 1U);
    EXPECT_EQ(made.errors()[0].path, "/cables/0/links/1");
    for (const char* word : {"idler", "lifted", "turns", "winding", "rope"}) {
      EXPECT_NE(made.errors()[0].message.find(word), std::string::npos) << word;
    }
    auto lifted = roll({}, right);
    lifted->lifted = true;
    const test::Machine off = passed_by(lifted, aside);
    EXPECT_TRUE(Simulation::create(off.model, off.cables).ok()) << aside;
  }
}

// Laid round the wheel once it lies there for a turn less the angle by which it is bent away from
// it. From the centre each point is atan(4) off the vertical and its tangent acos(r / d) off that.
TEST(GhostTurn, IsAllowedIfTheLinkHasTurns) {
  auto turn = roll({}, right);
  turn->turns = 1;
  Simulation s = test::start(passed_by(turn, 0.0));
  const double away = 2.0 * (std::acos(0.3 / std::hypot(2.0, 0.5)) - std::atan(4.0));
  EXPECT_NEAR(s.cable_reports()[0].links[1].stored_length, 0.3 * (4.0 * pi - away), 1e-12);
}

// A band round three quarters of a drum, whose ends cross: wound as it is meant to be. Before, it
// was told to be the wrong winding.
TEST(GhostTurn, DoesNotForbidABandRoundThreeQuartersOfADrum) {
  for (const double free : {0.3, 1.0, 20.0}) {
    test::Machine m;
    const BodyId drum = m.model.add(test::wheel("drum", Vector3::Zero(), 0.25, 0.1));
    m.cables.push_back(cable("band", {attach(BodyId::world(), {0.25, -free, 0.0}), roll(drum, left),
                                      attach(BodyId::world(), {free, -0.25, 0.0})}));
    EXPECT_TRUE(warnings_of(m).empty()) << free;
    EXPECT_NEAR(test::start(m).cable_reports()[0].links[1].stored_length, 0.25 * 1.5 * pi, 1e-12);
  }
}

// Crossed belts round wheels that nearly touch lie on them for almost a turn: with the centres at
// the distance d for pi + 2 asin(2 r / d).
TEST(GhostTurn, DoesNotForbidACrossedBelt) {
  test::Machine crossed = test::belt(0.3, 0.3, 0.605, 0.03, 0.01);
  crossed.cables[0].links[1] = roll({1}, right);
  const double wrap = pi + 2.0 * std::asin(0.6 / 0.605);
  EXPECT_GT(wrap, 5.9);
  EXPECT_NEAR(test::start(crossed).cable_reports()[0].links[0].stored_length, 0.3 * wrap, 1e-12);
}

}  // namespace
}  // namespace sheave
