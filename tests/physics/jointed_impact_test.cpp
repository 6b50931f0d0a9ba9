// Impacts of bodies that joints hold: the impulse passes on at once.
//
// With the unit normal n, the velocities v- before and v+ after an impact obey v+ = -e v- at the
// point of contact, and rigid joints keep their velocity 0. For two point masses m on a massless rod
// along d, an impulse P along n at the first changes the velocities by
//   dv1 = P / m (n - (d . n) / 2 d),   dv2 = P / m (d . n) / 2 d,
// so that with equal velocities -v n before, P = (1 + e) m v / (1 - (d . n)^2 / 2).

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "engine/index.h"
#include "engine/joints/distance.h"
#include "tests/support/heaps.h"

namespace sheave::jointed_impact {
namespace {

using test::Heap;

constexpr double radius = 0.1;
constexpr double rod = 0.5;
constexpr double drop = 0.45;  // so that the impact has 3 m/s at g = 10

/// Two balls on a rod at `angle` to the vertical, of which the lower one falls onto a floor.
struct Dumbbell {
  Dumbbell(const test::Method& method, int substeps, double angle, double restitution)
      : heap(method.solver, method.integrator), direction(std::sin(angle), std::cos(angle), 0.0) {
    heap.model.gravity = {0.0, -10.0, 0.0};
    heap.model.step.dt = 1.0 / 60.0;
    heap.model.step.substeps = substeps;
    heap.surface.restitution = restitution;
    heap.surface.friction = 0.0;
    heap.floor();
    const Vector3 low{0.0, radius + drop, 0.0};
    lower = heap.put(test::ball(radius), low);
    upper = heap.put(test::ball(radius), low + rod * direction);
    auto joint = std::make_shared<DistanceJoint>();
    joint->name = "rod";
    joint->body_a = lower;
    joint->body_b = upper;
    joint->anchor_a = low;
    joint->anchor_b = low + rod * direction;
    heap.model.joints.push_back(joint);
  }
  Heap heap;
  Vector3 direction;
  BodyId lower;
  BodyId upper;
};

TEST(JointedImpact, AnUprightRodBouncesAsOneBody) {
  for (const test::Method& method : test::methods) {
    for (const int substeps : {1, 4, 16, 64}) {
      for (const double restitution : {0.5, 1.0}) {
        SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(substeps) + " substeps");
        Dumbbell m(method, substeps, 0.0, restitution);
        World world = m.heap.start();
        // After 0.3 s it lands with 3 m/s; 0.1 s later it flies with 3 e - 1 m/s.
        test::run(world, 0.4);
        const double expected = 3.0 * restitution - 1.0;
        // The substep of the impact is done by `xpbd`, whose velocity lags by half a substep.
        const double tolerance = 10.0 / 60.0 / substeps + 1e-6;
        EXPECT_NEAR(world.velocity(m.lower).y(), expected, tolerance);
        EXPECT_NEAR(world.velocity(m.upper).y(), expected, tolerance);
        EXPECT_NEAR((world.position(m.upper) - world.position(m.lower)).norm(), rod, 1e-8);
      }
    }
  }
}

TEST(JointedImpact, ALeaningRodTurnsByTheLawOfImpulses) {
  for (const test::Method& method : test::methods) {
    for (const double angle : {-0.6, 0.3, 1.2}) {
      for (const double restitution : {0.5, 1.0}) {
        SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(angle));
        constexpr int substeps = 64;
        Dumbbell m(method, substeps, angle, restitution);
        World world = m.heap.start();
        // 18 steps of 1/60 s; the impact is at 0.3 s, so that one more step has it behind it.
        test::run(world, 19.0 / 60.0);
        constexpr double speed = 3.0;
        const Vector3 n = Vector3::UnitY();
        const double along = m.direction.y();
        const double impulse = (1.0 + restitution) * speed / (1.0 - 0.5 * along * along);
        const Vector3 first = -speed * n + impulse * (n - 0.5 * along * m.direction);
        const Vector3 second = -speed * n + impulse * 0.5 * along * m.direction;
        // Gravity goes on for 1/60 s, and the rod turns: its centripetal acceleration is w^2 l / 2,
        // with w l the velocity of one ball about the other.
        const double turning = (first - second).norm();
        const double tolerance = (10.0 + turning * turning / rod) / 60.0 + 0.01;
        EXPECT_LT((world.velocity(m.lower) - first).norm(), tolerance);
        EXPECT_LT((world.velocity(m.upper) - second).norm(), tolerance);
        // The sum of the momenta is that of impulse and weight. With the substep h, the moment of the
        // impact is off by h, so weights by 2 m g h and the speed by g h; the impulse by (1 + e) m g
        // h / (1 - 1/2) at most; a velocity of `xpbd` is that of h / 2 before: 70 h in all.
        EXPECT_NEAR(world.velocity(m.lower).y() + world.velocity(m.upper).y(),
                    (first + second).y() - 20.0 / 60.0, 70.0 / 60.0 / substeps);
      }
    }
  }
}

TEST(JointedImpact, WithoutLossKeepsTheEnergyOfChains) {
  for (const test::Method& method : test::methods) {
    for (const int count : {2, 5}) {
      SCOPED_TRACE(test::name_of(method) + ", " + std::to_string(count) + " balls");
      Heap heap(method.solver, method.integrator);
      heap.model.gravity = {0.0, -10.0, 0.0};
      heap.model.step.dt = 1.0 / 240.0;
      heap.model.step.substeps = 16;
      heap.surface.restitution = 1.0;
      heap.surface.friction = 0.0;
      heap.floor();
      BodyId last;
      Vector3 place{0.0, radius + 0.2, 0.0};
      for (int i = 0; i < count; ++i) {
        const BodyId ball = heap.put(test::ball(radius), place);
        if (i > 0) {
          auto joint = std::make_shared<DistanceJoint>();
          joint->name = "rod " + std::to_string(i);
          joint->body_a = last;
          joint->body_b = ball;
          joint->anchor_a = heap.model.bodies[at(last.index)].position;
          joint->anchor_b = place;
          heap.model.joints.push_back(joint);
        }
        last = ball;
        place += Vector3{0.4 * std::sin(0.5 + 0.3 * i), 0.4 * std::cos(0.5 + 0.3 * i), 0.0};
      }
      World world = heap.start();
      const double energy = world.energy().total();
      test::run(world, 0.6);
      // Each impact is off by the work of gravity and of turning in one substep of `xpbd`: 3e-3 of
      // the energy at 1/3840 s (measured to fall with the substep).
      EXPECT_NEAR(world.energy().total(), energy, 0.02 * energy);
    }
  }
}

}  // namespace
}  // namespace sheave::jointed_impact
