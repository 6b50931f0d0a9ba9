// Impacts of colliders.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

/// Greatest heights [m] of the ball above its place on the floor, bounce after bounce.
std::vector<double> heights(World& world, BodyId ball, double radius, double time) {
  std::vector<double> result;
  double highest = 0.0;
  bool falling = true;
  while (world.state().time < time) {
    EXPECT_TRUE(world.step().ok());
    const double height = world.position(ball).y() - radius;
    const bool falls = world.velocity(ball).y() < 0.0;
    if (!falls && falling) highest = 0.0;
    highest = std::max(highest, height);
    if (falls && !falling) result.push_back(highest);
    falling = falls;
  }
  return result;
}

TEST(ContactBounce, HeightsFallByTheSquareOfTheRestitution) {
  for (const test::Method& method : test::methods) {
    for (const double restitution : {0.0, 0.5, 0.8, 1.0}) {
      SCOPED_TRACE(test::name_of(method) + ", restitution " + std::to_string(restitution));
      Heap heap(method.solver, method.integrator);
      heap.model.step.dt = 1.0 / 240.0;
      heap.model.step.substeps = 1;
      heap.surface.restitution = restitution;
      heap.floor();
      const BodyId ball = heap.put(test::ball(0.1), {0.0, 1.1, 0.0});
      World world = heap.start();
      const std::vector<double> found = heights(world, ball, 0.1, 6.0);
      if (restitution == 0.0) {
        EXPECT_NEAR(world.position(ball).y(), 0.1, 1e-9);
        for (const double height : found) EXPECT_LT(height, 1e-9);
        continue;
      }
      ASSERT_GE(found.size(), 4U);
      double expected = 1.0;
      for (std::size_t i = 0; i < 4; ++i) {
        expected *= restitution * restitution;
        // Heights below what gravity makes of two substeps are not told apart.
        EXPECT_NEAR(found[i], expected, 0.01 * expected) << "bounce " << i;
      }
    }
  }
}

TEST(ContactBounce, EqualBallsExchangeTheirVelocities) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.gravity.setZero();
    heap.surface.restitution = 1.0;
    const BodyId first = heap.put(test::ball(0.1), {0.0, 0.0, 0.0});
    heap.last().velocity = {2.0, 0.0, 0.0};
    const BodyId second = heap.put(test::ball(0.1), {1.0, 0.0, 0.0});
    World world = heap.start();
    test::run(world, 1.0);
    // Row::softness leaves 1e-9 of an impact.
    constexpr double tolerance = 1e-7;
    EXPECT_NEAR(world.velocity(first).norm(), 0.0, tolerance);
    EXPECT_NEAR(world.velocity(second).x(), 2.0, tolerance);
    // And where they would be if the impact had been told to the moment: 0.4 s after the start.
    EXPECT_NEAR(world.position(first).x(), 0.8, tolerance);
    EXPECT_NEAR(world.position(second).x(), 1.0 + 2.0 * 0.6, tolerance);
  }
}

}  // namespace
}  // namespace sheave
