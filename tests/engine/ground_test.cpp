// Resting on the floor.

#include <numeric>

#include <gtest/gtest.h>

#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
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

// What is round has its centre, or its axis, above where it touches: a frictionless floor cannot
// turn it, however fast it spins when the floor stops it, and it comes to lie at its radius.
class GroundUnderRoundBodies : public testing::TestWithParam<IntegratorKind> {};

TEST_P(GroundUnderRoundBodies, LeavesTheirSpinAlone) {
  const auto ball = std::make_shared<Sphere>();
  ball->radius = 0.1;
  const auto rod = std::make_shared<Capsule>();
  rod->radius = 0.1;
  rod->length = 0.4;
  const auto roll = std::make_shared<Cylinder>();
  roll->radius = 0.1;
  roll->length = 0.4;
  for (const std::shared_ptr<const Shape>& shape :
       {std::shared_ptr<const Shape>(ball), std::shared_ptr<const Shape>(rod),
        std::shared_ptr<const Shape>(roll)}) {
    Model model;
    model.gravity = test::down;
    model.step = test::settings(0.01, 2, 50);
    model.step.solver = SolverKind::direct;
    model.step.integrator = GetParam();
    model.ground.emplace();
    BodyDef body;
    body.name = "round";
    body.mass = 1.0;
    body.position = {0, 0.6, 0};
    body.angular_velocity = {0, 0, 7.0};
    body.shapes.push_back({shape});
    model.add(body);
    World world = test::start(model);
    test::run(world, 1.0);
    EXPECT_NEAR(world.position({0}).y(), 0.1, 1e-9) << shape->type();
    EXPECT_NEAR(world.velocity({0}).norm(), 0.0, 1e-9) << shape->type();
    EXPECT_NEAR(world.angular_velocity({0}).z(), 7.0, 1e-9) << shape->type();
  }
}

// A cylinder that lands on the edge of its rim, with its axis tilted by a: the impulse p stops the
// point there, at the arm x across the floor's normal, v - p / m = w x:
//   p = m v / (1 + m x^2 / I),  w = p x / I,  x = L/2 cos a - R sin a.
TEST_P(GroundUnderRoundBodies, TurnThemAcrossTheirAxis) {
  constexpr double tilt = 0.3;
  constexpr double radius = 0.1;
  constexpr double length = 0.4;
  Model model;
  model.step = test::settings(1e-4, 1, 50);
  model.step.solver = SolverKind::direct;
  model.step.integrator = GetParam();
  model.ground.emplace();
  const auto roll = std::make_shared<Cylinder>();
  roll->radius = radius;
  roll->length = length;
  BodyDef body;
  body.name = "roll";
  body.mass = 2.0;
  body.inertia = Vector3(0.03, 0.03, 0.01);
  // The axis in the plane of x and y, tilted against x.
  body.orientation = rotation_by({0, 0, tilt}) * rotation_by({0, 0.5 * pi, 0});
  body.velocity = {0, -1.0, 0};
  const double lowest = 0.5 * length * std::sin(tilt) + radius * std::cos(tilt);
  body.position = {0, lowest + 0.02, 0};
  body.shapes.push_back({roll});
  model.add(body);
  World world = test::start(model);
  test::run(world, 0.0201);
  const double arm = 0.5 * length * std::cos(tilt) - radius * std::sin(tilt);
  const double impulse = 2.0 / (1.0 + 2.0 * arm * arm / 0.03);
  // In the substep of the impact it turns by w h at most, with w = 5 rad/s: 5e-4 of the figures.
  EXPECT_NEAR(std::abs(world.angular_velocity({0}).z()), impulse * arm / 0.03, 5e-4 * 5.0);
  EXPECT_NEAR(world.velocity({0}).y(), -1.0 + impulse / 2.0, 5e-4);
  EXPECT_NEAR(world.angular_velocity({0}).x(), 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Integrators, GroundUnderRoundBodies,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle),
                         [](const auto& info) {
                           return std::string(
                               integrator_names[static_cast<std::size_t>(info.param)]);
                         });

TEST(Ground, DoesNotHoldABodyThatLeaves) {
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

TEST_P(GroundForAll, HasNoRowsForDistantBodiesAndStopsFastOnes) {
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

TEST(Ground, ActsOnTheCarrierOfAMountedWheel) {
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
