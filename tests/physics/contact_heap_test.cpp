// What must hold for any heap of bodies, and contacts beside cables.

#include <gtest/gtest.h>

#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
#include "tests/support/effort.h"
#include "tests/support/heaps.h"
#include "tests/support/random.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

std::shared_ptr<const Shape> random_shape(test::Random& random) {
  const double size = random.between(0.1, 0.3);
  switch (random.below(5)) {
    case 0:
      return test::ball(size);
    case 1:
      return test::box({size, 1.5 * size, 2.0 * size});
    case 2:
      return test::make<Capsule>([&](Capsule& c) { c.radius = 0.5 * size, c.length = size; });
    case 3:
      return test::make<Cylinder>([&](Cylinder& c) { c.radius = size, c.length = size; });
    default:
      return test::polygon(test::ring(6, size, 0.0), size);
  }
}

TEST(ContactHeap, EnergyNeverRisesWithoutFriction) {
  for (const test::Method& method : test::methods) {
    for (int seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(test::name_of(method) + ", seed " + std::to_string(seed));
      test::Random random(static_cast<std::uint64_t>(seed) + 1);
      Heap heap(method.solver, method.integrator);
      heap.model.step = test::settings(1.0 / 240.0, 4, 20);
      heap.model.step.solver = method.solver;
      heap.model.step.integrator = method.integrator;
      heap.surface.restitution = 0.5 * (seed % 3);
      heap.floor();
      for (int i = 0; i < 8; ++i) {
        heap.put(random_shape(random), Vector3(0.0, 0.5 + 0.7 * i, 0.0) + random.vector(0.1));
        heap.last().orientation = random.orientation().normalized();
        heap.last().angular_velocity = random.vector(3.0);
      }
      World world = heap.start();
      const double start = world.energy().total();
      double highest = start;
      for (int i = 0; i < test::long_run(960); ++i) {
        ASSERT_TRUE(world.step().ok());
        highest = std::max(highest, world.energy().total());
      }
      // `xpbd` keeps mean velocities, which are g h / 2 too small while a body falls and too large
      // when it has bounced: an energy of m g h v, and v is sqrt(2 E / m) for all bodies together
      // at the most. (What an impact that turns a body within a substep makes of the energy is of
      // second order in the turn, and more than that with substeps of 1/480 s and restitution 1.)
      const double h = 1.0 / 960.0;
      double mass = 0.0;
      for (const BodyDef& body : heap.model.bodies) mass += body.mass.value_or(0.0);
      EXPECT_LE(highest - start, g * h * std::sqrt(2.0 * start * mass));
    }
  }
}

TEST(ContactHeap, AFastBallDoesNotPassAThinWall) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.step.substeps = 1;
    heap.model.gravity.setZero();
    BodyDef wall;
    wall.name = "wall";
    wall.mobility = Mobility::fixed;
    wall.shapes.push_back({test::box({0.01, 4.0, 4.0})});
    heap.add(wall);
    // 5 m in a substep, through a wall of 1 cm.
    const BodyId ball = heap.put(test::ball(0.02), {-3.0, 0.1, 0.2});
    heap.last().velocity = {300.0, 0.0, 0.0};
    World world = heap.start();
    test::run(world, 0.5);
    EXPECT_NEAR(world.position(ball).x(), -0.025, 1e-6);
  }
}

TEST(ContactHeap, ABodyOnACableRestsOnTheFloorAndTheCableIsSlack) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.friction = 0.5;
    heap.floor();
    const BodyId box = heap.put(test::box({0.4, 0.4, 0.4}), {0.0, 0.25, 0.0}, 2.0);
    test::Machine machine{heap.model, {}};
    CableDef rope = test::cable("rope", {test::attach(BodyId::world(), {0.0, 3.0, 0.0}),
                                         test::attach(box, {0.0, 0.45, 0.0})});
    rope.rest_lengths = {2.65};
    machine.cables.push_back(rope);
    Simulation s = test::start(machine);
    test::run(s.world, 3.0);
    EXPECT_NEAR(s.world.position(box).y(), 0.2, 1e-6);
    EXPECT_NEAR(s.cable_reports()[0].spans[0].tension, 0.0, 1e-9);
    double force = 0.0;
    for (const ContactReport& contact : s.world.contacts()) force += contact.normal_force;
    EXPECT_NEAR(force, 2.0 * g, 1e-5);
  }
}

TEST(ContactHeap, ATrainOfWheelsStaysExactBesideAStack) {
  const auto speed = [](bool stack) {
    test::Machine machine = test::wheel_train(63, 1.0, 2.0, 0.5, 0.125);
    machine.model.step = test::settings(1.0 / 60.0, 1, 10);
    machine.model.step.solver = SolverKind::direct;
    if (stack) {
      Heap heap;
      heap.model = machine.model;
      heap.surface.friction = 0.5;
      BodyDef table;
      table.name = "table";
      table.mobility = Mobility::fixed;
      table.position = {0.0, -100.0, 0.0};
      table.shapes.push_back({test::box({4.0, 1.0, 4.0})});
      heap.add(table);
      for (int i = 0; i < 5; ++i) {
        heap.put(test::box(Vector3::Constant(0.2)), {0.0, -99.4 + 0.2 * i, 0.0});
      }
      machine.model = heap.model;
    }
    Simulation s = test::start(machine);
    test::run(s.world, 1.0);
    return s.world.velocity({64}).y();
  };
  const double alone = speed(false);
  EXPECT_GT(std::abs(alone), 0.05);
  EXPECT_NEAR(speed(true), alone, 1e-6 * std::abs(alone));
}

TEST(ContactHeap, ACylinderRollsAtTwoThirds) {
  Heap heap(SolverKind::direct);
  const double angle = 0.3;
  heap.surface.friction = 0.8;
  heap.incline(angle).floor();
  const BodyId roll = heap.put(
      test::make<Cylinder>([](Cylinder& c) { c.radius = 0.2, c.length = 0.5; }), {0.0, 0.2, 0.0});
  World world = heap.start();
  test::run(world, 2.0);
  const double expected = 2.0 / 3.0 * g * std::sin(angle) * 2.0;
  EXPECT_NEAR(world.velocity(roll).x(), expected, 1e-3 * expected);
}

TEST(ContactHeap, ACompliantContactSinksByForceTimesCompliance) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.surface.compliance = 1e-4;
    heap.floor();
    heap.surface.compliance = 0.0;
    const double sunk = 0.1 - 5.0 * g * 1e-4;
    const BodyId ball = heap.put(test::ball(0.1), {0.0, sunk, 0.0}, 5.0);
    World world = heap.start();
    test::run(world, 5.0);
    EXPECT_NEAR(world.position(ball).y(), sunk, 1e-6);
    EXPECT_NEAR(world.energy().elastic, 0.5 * 25.0 * g * g * 1e-4, 1e-5);
  }
}

}  // namespace
}  // namespace sheave
