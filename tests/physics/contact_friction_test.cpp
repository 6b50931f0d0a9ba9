// Bodies on a floor with Coulomb friction, against the mechanics of rigid bodies.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

constexpr double degree = pi / 180.0;

/// Sweeps of Gauss-Seidel that share a load among four corners to 1e-6 of it: `xpbd` begins with
/// the forces of the last substep, `rattle` with none.
void sweep_enough(const test::Method& method, Heap& heap) {
  if (method.solver == SolverKind::gauss_seidel && method.integrator == IntegratorKind::rattle) {
    heap.model.step.iterations = 100;
  }
}

TEST(ContactFriction, ABoxOnTheFloorRestsForAMinute) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.friction = 0.5;
    heap.floor();
    const BodyId box = heap.put(test::box({1.0, 0.5, 0.8}), {0.0, 0.25, 0.0}, 3.0);
    World world = heap.start();
    test::run(world, 60.0);
    EXPECT_LT((world.position(box) - Vector3(0.0, 0.25, 0.0)).norm(), 1e-6);
    EXPECT_LT(world.orientation(box).vec().norm(), 1e-6);
    double force = 0.0;
    for (const ContactReport& contact : world.contacts()) force += contact.normal_force;
    EXPECT_NEAR(force, 3.0 * g, 1e-6);
  }
}

TEST(ContactFriction, ABoxSlidesJustBeyondTheFrictionAngle) {
  const double friction = 0.4;
  const double limit = std::atan(friction);
  for (const test::Method& method : test::methods) {
    for (const double beyond : {-0.5, 0.5, 10.0}) {
      SCOPED_TRACE(test::name_of(method) + ", degrees beyond: " + std::to_string(beyond));
      Heap heap(method.solver, method.integrator);
      heap.surface.friction = friction;
      sweep_enough(method, heap);
      const double angle = limit + beyond * degree;
      heap.incline(angle).floor();
      const BodyId box = heap.put(test::box({1.0, 0.4, 1.0}), {0.0, 0.2, 0.0});
      World world = heap.start();
      test::run(world, 1.0);
      const double speed = world.velocity(box).x();
      const double acceleration = g * (std::sin(angle) - friction * std::cos(angle));
      if (beyond < 0.0) {
        EXPECT_LT(std::abs(speed), 1e-9);
        EXPECT_LT(std::abs(world.position(box).x()), 1e-7);
      } else {
        EXPECT_NEAR(speed, acceleration, 1e-3 * acceleration);
      }
      EXPECT_NEAR(world.velocity(box).z(), 0.0, 1e-6);  // what sweeps leave
    }
  }
}

TEST(ContactFriction, ABoxSlidesAlongTheForceInAnyDirection) {
  // From rest, F - mu m g along F. The box's inertia is so large that what lies between the forces
  // tips it by nothing.
  const double friction = 0.5;
  for (const test::Method& method : test::methods) {
    for (const double angle : {0.0, 10.0, 22.5, 45.0, 80.0, 90.0, 200.0}) {
      for (const double force : {4.8, 6.0}) {
        SCOPED_TRACE(test::name_of(method) + ", degrees: " + std::to_string(angle));
        Heap heap(method.solver, method.integrator);
        heap.surface.friction = friction;
        sweep_enough(method, heap);
        heap.floor();
        const BodyId box = heap.put(test::box({0.3, 0.02, 0.3}), {0.0, 0.01, 0.0});
        const Vector3 along(std::cos(angle * degree), 0.0, std::sin(angle * degree));
        heap.last().force = force * along;
        World world = heap.start();
        test::run(world, 0.5);
        const double gained = std::max(force - friction * g, 0.0) * world.state().time;
        EXPECT_NEAR((world.velocity(box) - gained * along).norm(), 0.0, 1e-4);
      }
    }
  }
}

TEST(ContactFriction, TheFrictionOfAnImpactIsTheCoefficientTimesItsImpulse) {
  // A box hits the floor while it slides. As long as it does, friction is mu times the normal force
  // at every moment, those of the impact among them, so v_x falls by mu times what the floor adds
  // to v_y, whatever the box does and however its time is cut into steps: of a substep of `rattle`
  // both halves have their own.
  const double friction = 0.3;
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.friction = friction;
    sweep_enough(method, heap);
    heap.floor();
    const BodyId box = heap.put(test::box({1.0, 0.2, 0.6}), {0.0, 0.103, 0.0}, 2.0);
    heap.last().velocity = {3.0, -1.0, 0.0};
    World world = heap.start();
    for (int i = 0; i < 6; ++i) {
      ASSERT_TRUE(world.step().ok());
      const double given = world.velocity(box).y() + 1.0 + g * world.state().time;
      EXPECT_NEAR(world.velocity(box).x(), 3.0 - friction * given, 1e-6);
    }
    EXPECT_NEAR(world.velocity(box).y(), 0.0, 0.5);
  }
}

TEST(ContactFriction, ABallRolls) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.friction = 0.5;
    const double angle = 20.0 * degree;
    heap.incline(angle).floor();
    const BodyId ball = heap.put(test::ball(0.3), {0.0, 0.3, 0.0});
    World world = heap.start();
    test::run(world, 2.0);
    const double expected = 5.0 / 7.0 * g * std::sin(angle) * 2.0;
    EXPECT_NEAR(world.velocity(ball).x(), expected, 1e-4 * expected);
    EXPECT_NEAR(world.angular_velocity(ball).z(), -expected / 0.3, 1e-3 * expected / 0.3);
    EXPECT_NEAR(world.position(ball).y(), 0.3, 1e-9);
  }
}

TEST(ContactFriction, ASlidingBallEndsUpRollingAtFiveSeventhsOfItsSpeed) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.friction = 0.3;
    heap.floor();
    const BodyId ball = heap.put(test::ball(0.03), {0.0, 0.03, 0.0});
    heap.last().velocity = {3.0, 0.0, 4.0};
    World world = heap.start();
    // It rolls after 2 v / (7 mu g).
    test::run(world, 0.8);
    EXPECT_NEAR(world.velocity(ball).x(), 15.0 / 7.0, 2e-3);
    EXPECT_NEAR(world.velocity(ball).z(), 20.0 / 7.0, 2e-3);
    EXPECT_NEAR(world.angular_velocity(ball).z() * 0.03, -world.velocity(ball).x(), 1e-6);
  }
}

TEST(ContactFriction, ABoxTipsWhenItsWeightPassesItsEdge) {
  const double limit = std::atan(0.5);
  for (const test::Method& method : test::methods) {
    for (const double beyond : {-0.5, 0.5}) {
      SCOPED_TRACE(test::name_of(method) + ", degrees beyond: " + std::to_string(beyond));
      Heap heap(method.solver, method.integrator);
      heap.surface.friction = 2.0;
      sweep_enough(method, heap);
      heap.incline(limit + beyond * degree).floor();
      const BodyId box = heap.put(test::box({0.5, 1.0, 0.5}), {0.0, 0.5, 0.0});
      World world = heap.start();
      test::run(world, 2.0);
      const double turned = std::abs(world.orientation(box).z());
      if (beyond < 0.0) {
        EXPECT_LT(turned, 1e-6);
      } else {
        EXPECT_GT(turned, 0.1);
      }
    }
  }
}

// One box stands half a degree before it tips, with next to nothing on its upper corners: how little
// is for no rounding to decide. The other tips, lands flat and rocks: friction at a corner of a tall
// body unloads that corner.
TEST(ContactFriction, StaysWithinItsBoundWhereATallBoxTipsAndLands) {
  constexpr double friction = 2.0;
  for (const test::Method& method : test::methods) {
    if (method.solver != SolverKind::direct) continue;
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.step.substeps = 16;
    heap.surface.friction = friction;
    heap.incline(20.0 * degree).floor();
    heap.put(test::box({0.373884679484805, 1.0, 0.3}), {0.0, 0.5, -0.4});
    const BodyId narrow = heap.put(test::box({0.354118572530698, 1.0, 0.3}), {0.0, 0.5, 0.4});
    World world = heap.start();
    double most = 0.0;
    for (int i = 0; i < 150; ++i) {
      ASSERT_TRUE(world.step().ok());
      for (const ContactReport& contact : world.contacts()) {
        const double excess = contact.friction_force.norm() - friction * contact.normal_force;
        most = std::max(most, excess);
      }
    }
    // Rounds of friction end at 1e-10 of the scene, 1 m: a force of m 1e-10 m / h^2 is 1e-4 m g.
    EXPECT_LT(most, 1e-3);
    EXPECT_GT(std::abs(world.orientation(narrow).z()), 0.5);
  }
}

// Friction at its bound lets slip, however the normal force changes: a ball that lands sliding on a
// spring and rolls in the end is never pushed on. About a point of the floor its angular momentum
// stays what it was, so it rolls at 5/7 of its speed.
TEST(ContactFriction, DoesNotPullBackABodyThatSlippedOnASpring) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.step = test::settings(0.0015, 1, 100);
    heap.model.step.solver = method.solver;
    heap.model.step.integrator = method.integrator;
    heap.surface.friction = 0.7;
    heap.surface.compliance = 4e-7;
    heap.floor();
    constexpr double radius = 0.15;
    const BodyId ball = heap.put(test::ball(radius), {0.0, radius, 0.0}, 1.2);
    heap.last().velocity = {0.216, -0.04, 0.0};
    World world = heap.start();
    double least = 0.216;
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(world.step().ok());
      const double slip = world.velocity(ball).x() + radius * world.angular_velocity(ball).z();
      least = std::min(least, slip);
    }
    // Row::softness leaves 1e-7 of what friction stops.
    EXPECT_GT(least, -1e-6);
    EXPECT_NEAR(world.velocity(ball).x(), 5.0 / 7.0 * 0.216, 1e-6);
  }
}

// A box that lands flat begins to tip over its leading edge: in the second half of a substep of
// `rattle` nothing presses the trailing corners any more, and there is no friction there.
TEST(ContactFriction, IsZeroAtUnloadedCorners) {
  for (const test::Method& method : test::methods) {
    if (method.solver != SolverKind::direct) continue;
    SCOPED_TRACE(test::name_of(method));
    constexpr double friction = 0.372;
    Heap heap(method.solver, method.integrator);
    heap.model.step = test::direct_settings(method.integrator, 0.00333);
    heap.surface.friction = friction;
    heap.floor();
    heap.put(test::box({0.3, 0.3, 0.3}), {0.0, 0.15, 0.0}, 1.326);
    heap.last().velocity = {0.517, -0.732, 0.0};
    World world = heap.start();
    for (int i = 0; i < 30; ++i) {
      ASSERT_TRUE(world.step().ok());
      for (const ContactReport& contact : world.contacts()) {
        // As near as rounds of friction end: 1e-7 of the bound.
        ASSERT_LE(contact.friction_force.norm(), (1.0 + 1e-6) * friction * contact.normal_force)
            << i;
      }
    }
  }
}

}  // namespace
}  // namespace sheave
