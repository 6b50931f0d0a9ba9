// Resting on the floor.

#include <numeric>

#include <gtest/gtest.h>

#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

using test::g;

TEST(Ground, CarriesTheWeightOfABoxAtRest) {
  Model model;
  model.gravity = test::down;
  model.step = test::settings(1.0 / 60.0, 2, 50);
  model.ground.emplace();
  BodyDef box = test::lump("box", {0.3, 0.25, -0.1}, 2.0);  // 0.1 m above the floor
  model.add(box);
  World world = test::start(model);
  test::run(world, 1.0);
  // Rigid and inelastic: after the impact it stands still.
  EXPECT_NEAR(world.position({0}).y(), 0.15, 1e-9);
  EXPECT_NEAR(world.velocity({0}).norm(), 0.0, 1e-9);
  const std::vector<double>& forces = world.feature_state(0).reals;
  EXPECT_NEAR(std::accumulate(forces.begin(), forces.end(), 0.0), 2.0 * g, 1e-6 * 2.0 * g);
  for (const double force : forces) EXPECT_GE(force, 0.0);
}

TEST(Ground, StopsASphereOnASlopeInTheNormalDirectionOnly) {
  // No friction: along the slope it accelerates with g sin(a) and does not turn.
  constexpr double angle = 0.3;
  Model model;
  model.gravity = test::down;
  model.step = test::settings(0.001, 1, 5);
  model.ground.emplace();
  model.ground->normal = Vector3(std::sin(angle), std::cos(angle), 0.0);
  BodyDef ball;
  ball.name = "ball";
  auto sphere = std::make_shared<Sphere>();
  sphere->radius = 0.1;
  ball.shapes.push_back({sphere});
  ball.mass = 1.0;
  ball.position = 0.1 * model.ground->normal;
  model.add(ball);
  World world = test::start(model);
  test::run(world, 1.0);
  const Vector3 downhill{std::cos(angle), -std::sin(angle), 0.0};
  EXPECT_NEAR(world.velocity({0}).dot(downhill), g * std::sin(angle), 1e-9 * g);
  EXPECT_NEAR(world.position({0}).dot(model.ground->normal), 0.1, 1e-9);
  EXPECT_NEAR(world.angular_velocity({0}).norm(), 0.0, 1e-12);
}

TEST(Ground, DoesNotHoldWhatLeaves) {
  Model model;
  model.gravity = test::down;
  model.step = test::settings(0.001, 1, 5);
  model.ground.emplace();
  BodyDef box = test::lump("box", {0.0, 0.15, 0.0}, 2.0);
  box.velocity = {0.0, 1.0, 0.0};
  model.add(box);
  World world = test::start(model);
  World free = test::start([&] {
    Model copy = model;
    copy.ground.reset();
    return copy;
  }());
  for (int i = 0; i < 150; ++i) {
    ASSERT_TRUE(world.step().ok());
    ASSERT_TRUE(free.step().ok());
    ASSERT_EQ(world.position({0}), free.position({0}));
  }
}

class GroundForAll : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(Combinations, GroundForAll, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

TEST_P(GroundForAll, HasNoRowsForWhatIsFarAndStopsWhatGetsThereWithinOneStep) {
  // At rest 2 m above the floor, then pulled down by 6e4 N: 8 m of fall in 1/60 s, which nothing
  // tells at the start.
  Model model;
  model.gravity = test::down;
  model.step = step_settings(1.0 / 60.0, 10);
  model.ground.emplace();
  for (const double x : {0.3, 5.3}) {
    BodyDef ball;
    ball.name = x < 1.0 ? "pulled" : "free";
    auto sphere = std::make_shared<Sphere>();
    sphere->radius = 0.15;
    ball.shapes.push_back({sphere});
    ball.mass = 2.0;
    ball.position = {x, 2.15, -0.1};
    model.add(ball);
  }
  model.bodies[0].force = {0.0, -6e4, 0.0};
  World world = test::start(model);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(world.step().ok());
    ASSERT_GE(world.position({0}).y(), 0.15 - 1e-9) << i;
  }
  EXPECT_NEAR(world.position({0}).y(), 0.15, 1e-9);
  // The other one has fallen freely.
  EXPECT_GT(world.position({1}).y(), 2.0);
}

TEST(Ground, IsFeltByTheCarrierOfAMountedWheel) {
  // A block on a wheel that touches the floor; the wheel may slip, so nothing turns.
  Model model;
  model.gravity = test::down;
  model.step = test::settings(0.01, 1, 20);
  model.ground.emplace();
  BodyDef block = test::lump("block", {0.0, 0.5, 0.0}, 2.0);
  block.mobility = Mobility::slider;
  block.axis = Vector3::UnitY();
  model.add(block);
  model.add(test::sheave("wheel", {0}, {0.0, 0.2, 0.0}, 0.2, 0.5, 0.01));
  World world = test::start(model);
  test::run(world, 1.0);
  EXPECT_NEAR(world.position({0}).y(), 0.5, 1e-9);
  const std::vector<double>& forces = world.feature_state(0).reals;
  EXPECT_NEAR(std::accumulate(forces.begin(), forces.end(), 0.0), 2.5 * g, 1e-6 * g);
}

}  // namespace
}  // namespace sheave
