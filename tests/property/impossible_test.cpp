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

TEST(Impossible, AHangingLoadIsNot) { EXPECT_FALSE(asks_the_impossible(hanging())); }

TEST(Impossible, ARigidCableToABodyThatMovesAsItIsToldIs) {
  Machine m = hanging();
  BodyDef& body = m.model.bodies[0];
  body.mobility = Mobility::kinematic;
  body.mass.reset();
  body.inertia.reset();
  EXPECT_TRUE(asks_the_impossible(m));
  m.cables[0].compliance = 1e-3;
  EXPECT_FALSE(asks_the_impossible(m));
}

TEST(Impossible, TwoLinksAtOnePlaceAre) {
  Machine m = hanging();
  m.cables[0] = cable("rope", {attach(BodyId::world(), {0, -1, 0}), attach({0})});
  EXPECT_TRUE(asks_the_impossible(m));
}

TEST(Impossible, ABodyThatBeginsInTheGroundIs) {
  Machine m = hanging();
  m.model.ground.emplace();
  m.model.ground->point = {0, -1.14, 0};
  EXPECT_FALSE(asks_the_impossible(m));
  m.model.ground->point = {0, -1.0, 0};
  EXPECT_TRUE(asks_the_impossible(m));
}

}  // namespace
}  // namespace sheave::test
