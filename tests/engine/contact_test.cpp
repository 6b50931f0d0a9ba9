// Rows of contacts, what they cost a world without them, and their state.

#include <gtest/gtest.h>

#include "engine/constraint_batch.h"
#include "engine/shapes/cylinder.h"
#include "engine/step.h"
#include "tests/support/gradient_check.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::Heap;

Heap pile() {
  Heap heap;
  heap.surface.friction = 0.6;
  heap.surface.restitution = 0.3;
  heap.floor();
  heap.put(test::box({1.0, 0.4, 1.0}), {0.0, 0.2, 0.0});
  heap.put(test::ball(0.3), {0.1, 0.69, 0.1});
  heap.put(test::make<Cylinder>([](Cylinder& c) { c.radius = 0.2, c.length = 0.5; }),
           {0.95, 0.19, 0.0});
  heap.put(test::box({0.3, 0.3, 0.3}), {0.1, 1.15, 0.1});
  heap.last().velocity = {0.5, -0.3, 0.1};
  heap.last().angular_velocity = {1.0, -2.0, 0.5};
  return heap;
}

TEST(Contact, GradientsAreExact) {
  Heap heap = pile();
  World world = heap.start();
  Substep substep(world.bodies(), world.state(), 0.01, 1);
  ConstraintBatch& batch = *world.features()[0];
  batch.begin(substep, world.feature_state(0));
  test::displace(substep, 0.05, 0.2);
  const test::GradientCheck result = test::check_gradients(substep, batch);
  EXPECT_GT(result.compared, 100);
  EXPECT_GT(result.largest, 0.5);
  // Five-point differences leave some 1e-10 (tests/support/gradient_check.cpp).
  EXPECT_LT(result.error, 1e-8) << result.worst;
}

TEST(Contact, AWorldWithoutCollidersHasNoStageForThem) {
  Heap heap = pile();
  heap.model.colliders.clear();
  const World world = heap.start();
  EXPECT_TRUE(world.features().empty());
  for (const Stage& stage : world.stages()) {
    EXPECT_EQ(stage.name.find("contact"), std::string::npos) << stage.name;
  }
}

TEST(Contact, ARestoredStateContinuesBitForBit) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap = pile();
    heap.model.step.solver = method.solver;
    heap.model.step.integrator = method.integrator;
    World world = heap.start();
    test::run(world, 0.5);
    ASSERT_FALSE(world.contacts().empty());
    const State middle = world.state();
    test::run(world, 1.0);
    const std::uint64_t expected = hash(world.state());
    const auto bytes = state_from_bytes(to_bytes(middle));
    ASSERT_TRUE(bytes);
    World other = heap.start();
    ASSERT_TRUE(other.restore(*bytes).empty());
    test::run(other, 1.0);
    EXPECT_EQ(hash(other.state()), expected);
    ASSERT_TRUE(world.restore(middle).empty());
    test::run(world, 1.0);
    EXPECT_EQ(hash(world.state()), expected);
    State broken = middle;
    broken.features[0].integers[0] = 99;
    EXPECT_FALSE(world.restore(broken).empty());
    broken = middle;
    broken.features[0].reals.pop_back();
    EXPECT_FALSE(world.restore(broken).empty());
  }
}

// What n bodies in one place need grows with n^4, so it is refused before it is taken. One body may
// touch any number of small ones.
TEST(Contact, BodiesInOnePlaceAreNamed) {
  Heap heap(SolverKind::direct);
  for (int i = 0; i < 300; ++i) heap.put(test::box({0.5, 0.5, 0.5}), {1e-3 * i, 0.0, 0.0});
  World world = heap.start();
  const StepReport report = world.step();
  ASSERT_TRUE(report.divergence.has_value());
  EXPECT_NE(report.divergence->message.find("too many bodies touch each other"), std::string::npos);
  EXPECT_NE(report.divergence->message.find("\"body 0\""), std::string::npos);
  EXPECT_EQ(report.divergence->feature, "contacts");

  Heap tray(SolverKind::direct);
  tray.put(test::box({12.0, 0.1, 12.0}), {0.0, -0.05, 0.0}, 100.0);
  for (int i = 0; i < 100; ++i) tray.put(test::ball(0.3), {i % 10 - 5.0, 0.3, i / 10 - 5.0});
  World other = tray.start();
  EXPECT_TRUE(other.step().ok());
}

TEST(Contact, GroupsAndJointsKeepBodiesApart) {
  for (const bool apart : {false, true}) {
    Heap heap;
    heap.floor();
    heap.surface.groups = {"ghosts"};
    if (apart) heap.surface.ignores = {"ghosts"};
    heap.put(test::ball(0.5), {0.0, 0.5, 0.0});
    const BodyId upper = heap.put(test::ball(0.5), {0.0, 1.5, 0.0});
    World world = heap.start();
    test::run(world, 1.0);
    EXPECT_NEAR(world.position(upper).y(), apart ? 0.5 : 1.5, 1e-6);
  }
}

}  // namespace
}  // namespace sheave
