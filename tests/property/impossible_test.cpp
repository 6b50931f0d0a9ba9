#include "tests/property/impossible.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::test {
namespace {

Machine hanging() {
  Machine m;
  m.model.gravity = down;
  m.model.add(lump("load", {0, -1, 0}, 1.0));
  m.cables.push_back(cable("rope", {attach(BodyId::world()), attach({0})}));
  return m;
}

TEST(Impossible, DoesNotIncludeAHangingLoad) { EXPECT_FALSE(asks_the_impossible(hanging())); }

TEST(Impossible, IncludesARigidCableToAPrescribedBody) {
  Machine m = hanging();
  BodyDef& body = m.model.bodies[0];
  body.mobility = Mobility::kinematic;
  body.mass.reset();
  body.inertia.reset();
  EXPECT_TRUE(asks_the_impossible(m));
  m.cables[0].compliance = 1e-3;
  EXPECT_FALSE(asks_the_impossible(m));
}

TEST(Impossible, IncludesTwoLinksAtOnePlace) {
  Machine m = hanging();
  m.cables[0] = cable("rope", {attach(BodyId::world(), {0, -1, 0}), attach({0})});
  EXPECT_TRUE(asks_the_impossible(m));
}

TEST(Impossible, IncludesABodyThatBeginsInTheGround) {
  Machine m = hanging();
  m.model.ground.emplace();
  m.model.ground->point = {0, -1.14, 0};
  EXPECT_FALSE(asks_the_impossible(m));
  m.model.ground->point = {0, -1.0, 0};
  EXPECT_TRUE(asks_the_impossible(m));
}

// A rope over a free wheel to what moves as it is told draws the wheel straight, and leaves it: from
// there on the two that hold it ask for more rope than there is, which they have not at the start.
TEST(Impossible, IncludesARopeThatHasLeftItsFreeWheel) {
  Machine m;
  m.model.gravity = down;
  const BodyId load = m.model.add(lump("load", {0.5, -0.3, 0}, 1.0));
  const auto wheel = roll(load, left);
  wheel->radius = 0.1;
  BodyDef led = lump("led", {1, 0, 0}, 1.0);
  led.mobility = Mobility::kinematic;
  led.mass.reset();
  led.inertia.reset();
  led.velocity = {1, 0, 0};
  const BodyId end = m.model.add(led);
  m.cables.push_back(cable("rope", {attach(BodyId::world()), wheel, attach(end)}));
  m.model.step.dt = 0.01;
  m.model.step.solver = SolverKind::direct;
  Simulation s = start(m);
  EXPECT_FALSE(can_ask_the_impossible(m, s));
  for (int i = 0; i < 100 && s.cable_reports()[0].links[1].touched; ++i) {
    ASSERT_TRUE(s.world.step().ok());
  }
  ASSERT_FALSE(s.cable_reports()[0].links[1].touched);
  EXPECT_TRUE(can_ask_the_impossible(m, s));
}

}  // namespace
}  // namespace sheave::test
