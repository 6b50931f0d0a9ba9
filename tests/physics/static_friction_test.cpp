// Static friction of rigid bodies that touch in several points. How these share what presses them is
// left open by statics, and friction with it, so as long as some distribution holds, all of them do:
// up to mu_s times the whole normal force. What lets go slides with mu from that moment on.

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

constexpr double degree = pi / 180.0;

/// What Row::softness lets what is held be moved by: 1e-7 of what the load would do in a substep, and
/// where a body stands on a few points that are far from others some times that.
double held_speed(const StepSettings& step) { return 1e-6 * g * step.dt / step.substeps; }

struct Pull {
  double static_friction = 0.3;
  double friction = 0.2;
  double mass = 4.0;
  Vector3 size{0.6, 0.2, 0.4};
  double height = 0.5;  ///< at which it is pulled, as a share of its own
  double angle = 0.0;   ///< in the plane [rad]
  int substeps = 4;
};

/// Pulls with `share` of what friction can hold; the box must stay or slide off.
void pull(const test::Method& method, const Pull& p, double share) {
  SCOPED_TRACE(test::name_of(method) + ", mu_s " + std::to_string(p.static_friction) + ", mass " +
               std::to_string(p.mass) + ", height " + std::to_string(p.height) + ", angle " +
               std::to_string(p.angle) + ", substeps " + std::to_string(p.substeps) + ", share " +
               std::to_string(share));
  Heap heap(method.solver, method.integrator);
  heap.model.step.substeps = p.substeps;
  heap.model.step.iterations = 50;
  heap.surface.friction = p.friction;
  heap.surface.static_friction = p.static_friction;
  heap.floor();
  const BodyId box = heap.put(test::box(p.size), {0.0, 0.5 * p.size.y(), 0.0}, p.mass);
  World world = heap.start();
  const Vector3 along(std::cos(p.angle), 0.0, std::sin(p.angle));
  const Vector3 point(0.0, (p.height - 0.5) * p.size.y(), 0.0);
  const double force = share * p.static_friction * p.mass * g;
  ASSERT_TRUE(world.set_force(box, {force * along, Vector3::Zero(), point}).empty());
  test::run(world, 0.2);
  const double time = world.state().time;
  const Vector3 velocity = world.velocity(box);
  if (share < 1.0) {
    EXPECT_LT(velocity.norm(), held_speed(heap.model.step));
    EXPECT_LT(world.angular_velocity(box).norm() * p.size.norm(), held_speed(heap.model.step));
    EXPECT_LT((world.position(box) - Vector3(0.0, 0.5 * p.size.y(), 0.0)).norm(), 1e-9);
    for (const ContactReport& contact : world.contacts()) EXPECT_TRUE(contact.sticks);
  } else {
    // From the first substep on. Rounds of friction leave 1e-5 of the pressures' part that statics
    // leaves open, and that of it which turns the box across its way.
    const double speed = (share * p.static_friction - p.friction) * g * time;
    EXPECT_LT((velocity - speed * along).norm(), 1e-5 * speed);
  }
}

TEST(StaticFriction, HoldsABoxUpToAllOfItsPressure) {
  for (const test::Method& method : test::methods) {
    for (const double share : {0.95, 0.999, 1.001}) {
      pull(method, {}, share);
      pull(method, {.static_friction = 0.5, .friction = 0.1}, share);
      pull(method, {.mass = 1e-3, .angle = 45.0 * degree, .substeps = 16}, share);
      pull(method, {.mass = 1e3, .size = {0.3, 0.25, 1.0}, .angle = 20.0 * degree}, share);
      pull(method, {.static_friction = 0.8, .friction = 0.7, .substeps = 1}, share);
      pull(method, {.size = {1.0, 0.02, 1.0}, .angle = 200.0 * degree}, share);
    }
  }
}

TEST(StaticFriction, HoldsATurnedBoxInShortSubsteps) {
  // Within a substep of 65 us friction of 0.05 moves a body by 2e-9 m, and a slip has a rounding error
  // of some 1e-15 m. Softness lets corners give by 1e-12 of the size of the scene of some metres.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {16, 64, 256}) {
      for (const double yaw : {0.0, 30.0, 45.0}) {
        for (const auto& [fixed, sliding] : {std::pair(0.5, 0.1), {0.05, 0.01}}) {
          for (const double share : {0.3, 0.5, 0.9}) {
            SCOPED_TRACE(std::to_string(substeps) + " substeps, yaw " + std::to_string(yaw) +
                         ", mu_s " + std::to_string(fixed) + ", share " + std::to_string(share));
            Heap heap(SolverKind::direct, integrator);
            heap.model.step.substeps = substeps;
            heap.model.step.iterations = 50;
            heap.surface.friction = sliding;
            heap.surface.static_friction = fixed;
            heap.floor();
            const BodyId box = heap.put(test::box({2.4, 0.2, 1.6}), {0.0, 0.1, 0.0}, 4.0);
            heap.model.bodies[static_cast<std::size_t>(box.index)].orientation =
                Quaternion(Eigen::AngleAxisd(yaw * degree, Vector3::UnitY()));
            World world = heap.start();
            ASSERT_TRUE(world
                            .set_force(box, {{share * fixed * 4.0 * g, 0.0, 0.0},
                                             Vector3::Zero(),
                                             Vector3::Zero()})
                            .empty());
            test::run(world, 0.1);
            const Vector3 place = world.position(box);
            EXPECT_LT(std::hypot(place.x(), place.z()), 3e-11);
            for (const ContactReport& contact : world.contacts()) EXPECT_TRUE(contact.sticks);
          }
        }
      }
    }
  }
}

// A pull above the floor loads the front corners and unloads the rear ones, until, at b / (2 mu_s),
// it tips the box.
TEST(StaticFriction, HoldsForAnyPointOfPull) {
  for (const test::Method& method : test::methods) {
    for (const double height : {0.0, 0.5, 1.0}) {
      for (const double share : {0.999, 1.001}) {
        pull(method, {.static_friction = 0.5, .friction = 0.1, .height = height}, share);
        pull(method,
             {.static_friction = 0.6, .friction = 0.4, .size = {0.4, 0.3, 0.4}, .height = height},
             share);
      }
    }
  }
}

TEST(StaticFriction, HoldsOnASlopeUpToItsAngle) {
  for (const test::Method& method : test::methods) {
    for (const double share : {0.999, 1.001}) {
      SCOPED_TRACE(test::name_of(method) + ", share " + std::to_string(share));
      Heap heap(method.solver, method.integrator);
      heap.surface.friction = 0.3;
      heap.surface.static_friction = 0.7;
      const double angle = std::atan(share * 0.7);
      heap.incline(angle).floor();
      const BodyId box = heap.put(test::box({0.5, 0.4, 0.3}), {0.0, 0.2, 0.0});
      World world = heap.start();
      test::run(world, 0.5);
      const double speed =
          share < 1.0 ? 0.0 : g * (std::sin(angle) - 0.3 * std::cos(angle)) * world.state().time;
      EXPECT_NEAR(world.velocity(box).x(), speed, held_speed(heap.model.step) + 1e-6 * speed);
    }
  }
}

// A table of which each leg is a contact of its own, and the legs in front have nearly all the
// weight: what stands there holds what stands behind.
TEST(StaticFriction, HoldsATableOnFourLegs) {
  for (const test::Method& method : test::methods) {
    for (const double share : {0.999, 1.001}) {
      SCOPED_TRACE(test::name_of(method) + ", share " + std::to_string(share));
      Heap heap(method.solver, method.integrator);
      heap.model.step.iterations = 50;
      heap.surface.friction = 0.2;
      heap.surface.static_friction = 0.5;
      heap.floor();
      BodyDef table;
      table.name = "table";
      table.mass = 20.0;
      table.inertia = Vector3(2.0, 3.0, 2.0);
      table.position = {0.0, 0.3, 0.0};  // of its centre of mass
      for (const double x : {-0.5, 0.5}) {
        for (const double z : {-0.3, 0.3}) {
          table.shapes.push_back({test::box({0.1, 0.6, 0.1}), {x, 0.0, z}});
        }
      }
      const BodyId body = heap.add(table);
      World world = heap.start();
      const double force = share * 0.5 * 20.0 * g;
      const Vector3 point(0.0, 0.5, 0.0);
      ASSERT_TRUE(world.set_force(body, {{force, 0.0, 0.0}, Vector3::Zero(), point}).empty());
      test::run(world, 0.2);
      const double speed = share < 1.0 ? 0.0 : (share * 0.5 - 0.2) * g * world.state().time;
      EXPECT_NEAR(world.velocity(body).x(), speed, held_speed(heap.model.step) + 1e-5 * speed);
    }
  }
}

// Two fingers press a box from both sides, above its middle, and carry it. They are no way off it
// across, where its weight would turn it about them and all of the friction is wanted for its weight.
TEST(StaticFriction, HoldsABoxBetweenFingers) {
  for (const test::Method& method : test::methods) {
    for (const double share : {0.999, 1.001}) {
      SCOPED_TRACE(test::name_of(method) + ", share " + std::to_string(share));
      Heap heap(method.solver, method.integrator);
      heap.model.step.iterations = 50;
      heap.surface.friction = 0.4;
      heap.surface.static_friction = 0.6;
      const double mass = 2.0;
      const BodyId box = heap.put(test::box({0.1, 0.1, 0.1}), Vector3::Zero(), mass);
      for (const double side : {-1.0, 1.0}) {
        heap.put(test::box({0.04, 0.04, 0.06}), {0.07 * side, 0.02, 0.0}, 0.3);
        heap.last().mobility = Mobility::slider;
        heap.last().axis = Vector3::UnitX();
        heap.last().force = {-side * mass * g / (2.0 * 0.6 * share), 0.0, 0.0};
      }
      World world = heap.start();
      test::run(world, 0.1);
      const double fall = share < 1.0 ? 0.0 : (1.0 - 0.4 / (0.6 * share)) * g * world.state().time;
      EXPECT_NEAR(world.velocity(box).y(), -fall, held_speed(heap.model.step) + 1e-4 * fall);
    }
  }
}

// A force that grows from substep to substep lets go in the one in which it is more than mu_s N, and
// from its beginning on what slides has mu N: x'' = (F - mu N) / m. Of a force that is constant
// within substeps that is exact; to F = r t it comes with the substep.
TEST(StaticFriction, LosesNoSubstepWhenItLetsGo) {
  constexpr double rate = 60.0;  // [N/s]
  constexpr double mass = 4.0;
  const double limit = 0.5 * mass * g;
  for (const test::Method& method : test::methods) {
    double before = 0.0;
    for (const int substeps : {1, 4, 16}) {
      SCOPED_TRACE(test::name_of(method) + ", substeps " + std::to_string(substeps));
      Heap heap(method.solver, method.integrator);
      heap.model.step.substeps = substeps;
      heap.surface.friction = 0.2;
      heap.surface.static_friction = 0.5;
      heap.floor();
      const BodyId box = heap.put(test::box({0.6, 0.2, 0.4}), {0.0, 0.1, 0.0}, mass);
      World world = heap.start();
      const double h = heap.model.step.dt / substeps;
      double speed = 0.0;
      for (int i = 0; i < 30; ++i) {
        const auto push = [&] {
          const double force = rate * (world.state().time + 0.5 * h);
          if (force > limit || speed > 0.0) speed += h * (force / mass - 0.2 * g);
          EXPECT_TRUE(world.set_force(box, {{force, 0.0, 0.0}}).empty());
        };
        ASSERT_TRUE(world.step({}, push).ok());
      }
      EXPECT_NEAR(world.velocity(box).x(), speed, 1e-6);
      const double time = world.state().time;
      const double start = limit / rate;
      const double exact =
          0.5 * rate / mass * (time * time - start * start) - 0.2 * g * (time - start);
      // Within half a substep of the moment, and so (mu_s - mu) g times that of the speed.
      EXPECT_LT(std::abs(speed - exact), 0.5 * h * 0.3 * g + 1e-9);
      before = speed;
    }
    EXPECT_GT(before, 0.1);
  }
}

}  // namespace
}  // namespace sheave
