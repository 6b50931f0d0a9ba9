// Edits of running machines with knots without mass.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/live.h"

namespace sheave {
namespace {

/// A load of 10 kg on a Y of ropes, which swings in the plane of the ropes.
test::Machine swinging() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  BodyDef point;
  point.name = "knot";
  point.mobility = Mobility::knot;
  point.position = {0.0, -4.0, 0.0};
  m.model.add(point);
  BodyDef load = test::lump("load", {0.0, -6.0, 0.0}, 10.0);
  load.velocity = {0.3, 0.0, 0.0};
  m.model.add(load);
  for (const double x : {-3.0, 3.0}) {
    m.cables.push_back(
        test::cable(x < 0.0 ? "left" : "right",
                    {test::attach(BodyId::world(), {x, 0.0, 0.0}), test::attach({0})}));
  }
  m.cables.push_back(test::cable("lower", {test::attach({0}), test::attach({1})}));
  return m;
}

// An edit elsewhere changes nothing in the motion.
TEST(KnotEdit, TheMotionGoesOn) {
  LiveWorld edited = test::live(swinging());
  LiveWorld left = test::live(swinging());
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(edited.step().ok() && left.step().ok());
  test::edit(edited, [](Edit& edit) { edit.add(test::lump("far", {9.0, 0.0, 0.0}, 1.0)); });
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(edited.step().ok() && left.step().ok());
  for (const std::size_t body : {0, 1}) {
    EXPECT_NEAR((edited.state().bodies[body].position - left.state().bodies[body].position).norm(),
                0.0, 1e-11);
  }
}

// Without its right rope the load hangs on the left and the lower one, in one line of 7 m.
TEST(KnotEdit, ARopeIsRemovedAndAnotherIsTied) {
  LiveWorld world = test::live(swinging());
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
  const CableHandle right = world.cable("right").value();
  test::edit(world, [&](Edit& edit) { edit.remove(right); });
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step().ok());
  const Vector3 support{-3.0, 0.0, 0.0};
  EXPECT_NEAR((world.state().bodies[1].position - support).norm(), 7.0, 1e-9);
  EXPECT_NEAR((world.state().bodies[0].position - support).norm(), 5.0, 1e-9);
  test::edit(world, [](Edit& edit) {
    edit.add(
        test::cable("stay", {test::attach(BodyId::world(), {4.0, 0.0, 0.0}), test::attach({0})}));
  });
  const double length = (world.state().bodies[0].position - Vector3(4.0, 0.0, 0.0)).norm();
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(world.step().ok());
    EXPECT_LE((world.state().bodies[0].position - Vector3(4.0, 0.0, 0.0)).norm(), length + 1e-9);
  }
  EXPECT_TRUE(world.simulation().certificate()->clean());
}

// A knot with one rope is refused, and nothing changes.
TEST(KnotEdit, AKnotKeepsTwoRopes) {
  LiveWorld world = test::live(swinging());
  ASSERT_TRUE(world.step().ok());
  const CableHandle right = world.cable("right").value();
  const CableHandle left = world.cable("left").value();
  const auto done = world.edit([&](Edit& edit) {
    edit.remove(right);
    edit.remove(left);
  });
  ASSERT_FALSE(done);
  EXPECT_NE(test::text(done.errors()).find("a knot joins 2 to 4"), std::string::npos)
      << test::text(done.errors());
  ASSERT_TRUE(world.step().ok());
}

}  // namespace
}  // namespace sheave
