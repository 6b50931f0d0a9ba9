// Windings that look as if they were entered the wrong way round
// (cable/cable_compile_windings.cpp).

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::left;
using test::right;
using test::roll;

std::vector<CableSystem::WindingWarning> warnings_of(const test::Machine& machine) {
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

TEST(WindingWarning, IsSilentWhereNothingOrSomethingElseCrosses) {
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

}  // namespace
}  // namespace sheave
