// Compliant contacts are springs 1 / a with dampers of the ratio z that `restitution` asks for beside
// them: of a point that yields by w, omega = sqrt(w / a), and what swings dies away as exp(-z omega t).

#include <cmath>

#include <gtest/gtest.h>

#include "engine/contacts/contact_finder.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

TEST(CompliantContact, HasTheDampingOfItsRestitution) {
  // A spring with a damper that let go where both together push no more: of x'' + 2 z x' + x = 0, x(0)
  // = 0, x'(0) = -1, the speed when 2 z x' + x is 0 again, by small steps.
  for (const double restitution : {0.2, 0.5, 0.8, 0.97}) {
    const double z = damping_ratio_of(restitution);
    double x = 0.0;
    double v = -1.0;
    constexpr double h = 1e-4;
    while (-x - 2.0 * z * v >= 0.0) {
      const double force = -x - 2.0 * z * v;
      const double middle = v + 0.5 * h * force;
      const double later = -(x + 0.5 * h * v) - 2.0 * z * middle;
      x += h * middle;
      v += h * later;
    }
    EXPECT_NEAR(v, restitution, 2e-4);  // a step before or after
  }
  EXPECT_EQ(damping_ratio_of(0.0), 1.0);
  EXPECT_EQ(damping_ratio_of(0.1), 1.0);  // less than e^-2, which is what critical damping leaves
  EXPECT_LT(damping_ratio_of(1.0), 1e-12);
}

// A ball that meets a spring at 1 m/s without gravity.
TEST(CompliantContact, ThrowsBackWithItsRestitution) {
  constexpr double compliance = 1e-4;
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    for (const double restitution : {0.3, 0.7, 1.0}) {
      double before = 0.0;
      for (const int parts : {10, 20, 100, 200}) {  // steps of omega h = 1 / parts
        SCOPED_TRACE(test::name_of({SolverKind::direct, integrator}) + ", restitution " +
                     std::to_string(restitution) + ", parts " + std::to_string(parts));
        Heap heap(SolverKind::direct, integrator);
        heap.model.gravity = Vector3::Zero();
        heap.model.step = test::direct_settings(integrator, std::sqrt(compliance) / parts);
        heap.surface.restitution = restitution;
        heap.floor();
        heap.surface.compliance = compliance;
        const BodyId ball = heap.put(test::ball(0.1), {0.0, 0.1001, 0.0});
        heap.last().velocity = {0.0, -1.0, 0.0};
        World world = heap.start();
        for (int i = 0; i < 5 * parts; ++i) ASSERT_TRUE(world.step().ok());
        const double off = std::abs(world.velocity(ball).y() - restitution);
        // `rattle`: of second order, as the damper acts for the part of the substep in which the ball
        // presses. `xpbd`: implicit Euler takes pi omega h / 2 of the speed of a swing without a
        // damper.
        const bool rattle = integrator == IntegratorKind::rattle;
        EXPECT_LT(off, rattle ? 0.15 / (parts * parts) + 1e-9 : 2.5 / parts);
        if (!rattle && before > 1e-3) {
          EXPECT_LT(off, 0.7 * before);
        }
        before = off;
      }
    }
  }
}

// Also the substeps in which a contact begins and ceases to press keep its energy: their force is the
// discrete gradient of the energy (engine/solvers/row_system.h).
TEST(CompliantContact, GivesBackTheWholeEnergyWithinAnyStep) {
  constexpr double compliance = 1e-4;
  for (const double swing : {0.05, 0.4, 1.0, 2.5, 10.0}) {
    const double h = swing * std::sqrt(compliance);
    for (const double share : {0.1, 0.4, 0.9}) {  // of a substep, at which the ball arrives
      SCOPED_TRACE("omega h " + std::to_string(swing) + ", share " + std::to_string(share));
      Heap heap(SolverKind::direct, IntegratorKind::rattle);
      heap.model.step = test::direct_settings(IntegratorKind::rattle, h);
      heap.surface.restitution = 1.0;
      heap.floor();
      heap.surface.compliance = compliance;
      // Faster by far than the weight makes it in a substep.
      const double speed = 100.0 * g * h + 1.0;
      const double height = (share + 1.0) * h * speed;
      const BodyId ball = heap.put(test::ball(0.1), {0.0, 0.1 + height, 0.0});
      heap.last().velocity = {0.0, -speed, 0.0};
      World world = heap.start();
      const double before = world.energy().total();
      const auto swings = static_cast<int>(4.0 / swing) + 8;
      for (int i = 0; i < swings; ++i) ASSERT_TRUE(world.step().ok());
      EXPECT_GT(world.velocity(ball).y(), 0.9 * speed);
      // Rounds end at residuals far below 1e-10 m of compressions of some centimetres.
      EXPECT_NEAR(world.energy().total(), before, 1e-9 * speed * speed);
    }
  }
}

// Two balls that meet in space exchange their velocities along the line of their centres.
TEST(CompliantContact, ExchangesTheVelocitiesOfTwoBalls) {
  constexpr double compliance = 1e-4;
  for (const double swing : {0.1, 0.7, 3.0}) {
    SCOPED_TRACE("omega h " + std::to_string(swing));
    const double h = swing * std::sqrt(compliance);
    Heap heap(SolverKind::direct, IntegratorKind::rattle);
    heap.model.gravity = Vector3::Zero();
    heap.model.step = test::direct_settings(IntegratorKind::rattle, h);
    heap.surface.restitution = 1.0;
    heap.surface.compliance = compliance;
    const Vector3 line = Vector3(1.0, 2.0, -2.0) / 3.0;
    const BodyId near = heap.put(test::ball(0.1), Vector3::Zero());
    heap.last().velocity = 0.5 * line;
    const BodyId far = heap.put(test::ball(0.1), 0.2 * line + 0.033 * line);
    heap.last().velocity = -2.0 * line;
    World world = heap.start();
    for (int i = 0; i < static_cast<int>(0.05 / h) + 8; ++i) ASSERT_TRUE(world.step().ok());
    EXPECT_LT((world.velocity(near) + 2.0 * line).norm(), 1e-7);
    EXPECT_LT((world.velocity(far) - 0.5 * line).norm(), 1e-7);
  }
}

// A ball that rests on a spring and has been pushed: from 1/100 of a radian of its swing in a substep
// to a hundred swings. A critically damped swing is (1 + omega t) e^(-omega t), so its energy stays
// below some times (1 + z omega t)^2 e^(-2 z omega t), and it never grows.
TEST(CompliantContact, SwingsDecayForAnyStep) {
  for (const double restitution : {0.0, 0.5, 0.9}) {
    const double z = damping_ratio_of(restitution);
    for (const double swing : {0.01, 0.3, 2.0, 20.0, 600.0}) {
      SCOPED_TRACE("restitution " + std::to_string(restitution) + ", omega h " +
                   std::to_string(swing));
      constexpr double compliance = 1e-5;
      constexpr double mass = 10.0;
      const double omega = 1.0 / std::sqrt(mass * compliance);
      Heap heap(SolverKind::direct, IntegratorKind::rattle);
      heap.model.step = test::direct_settings(IntegratorKind::rattle, swing / omega);
      heap.surface.restitution = restitution;
      heap.floor();
      heap.surface.compliance = compliance;
      const double sunk = mass * g * compliance;
      const BodyId ball = heap.put(test::ball(0.1), {0.0, 0.1 - sunk, 0.0}, mass);
      heap.last().velocity = {0.0, 0.3 * sunk * omega, 0.0};  // does not leave the spring
      World world = heap.start();
      const double first = 0.5 * mass * heap.last().velocity.squaredNorm();
      const auto energy = [&] {
        const double off = world.position(ball).y() - 0.1 + sunk;
        return 0.5 * mass * world.velocity(ball).squaredNorm() + 0.5 * off * off / compliance;
      };
      double before = first;
      double last = first;
      const int steps = static_cast<int>(std::ceil(3.0 / (z * swing))) + 12;
      for (int i = 0; i < steps; ++i) {
        ASSERT_TRUE(world.step().ok());
        before = last;
        last = energy();
        // Rounds end at 1e-10 of the scene, 3e-7 of the swing, of which energy has the square.
        EXPECT_LE(last, before * (1.0 + 1e-9) + 1e-12 * first);
      }
      const double gone = z * swing * steps;
      const double left = (1.0 + gone) * (1.0 + gone) * std::exp(-2.0 * gone);
      EXPECT_LT(last, (4.0 * left + 1e-9) * first);
      // The force is that of a way and a speed that have the energy of before; the swing began with
      // 0.3 of the weight.
      double force = 0.0;
      for (const ContactReport& contact : world.contacts()) force += contact.normal_force;
      EXPECT_NEAR(force, mass * g, (std::sqrt(before / first) + 1e-6) * mass * g);
    }
  }
}

// A box that begins where statics puts it has the energy of its springs, m g sag / 2, from the
// start: nothing moves, and no energy comes from anywhere.
TEST(CompliantContact, ABoxAtItsSagHasItsEnergyFromTheStart) {
  for (const test::Method& method : test::methods) {
    for (const double slope : {0.0, 0.3}) {
      SCOPED_TRACE(test::name_of(method) + ", slope " + std::to_string(slope));
      constexpr double compliance = 1e-4;  // of each of four corners
      constexpr double mass = 2.0;
      const double sag = 0.25 * mass * g * std::cos(slope) * compliance;
      Heap heap(method.solver, method.integrator);
      heap.incline(slope);
      heap.surface.friction = 0.6;
      heap.floor();
      heap.surface.compliance = compliance;
      // So low that friction does not tilt it beyond the linear range.
      const BodyId box = heap.put(test::box({0.3, 1e-3, 0.3}), {0.0, 5e-4 - sag, 0.0}, mass);
      World world = heap.start();
      const double elastic = world.energy().elastic;
      EXPECT_NEAR(elastic, 4.0 * 0.5 * sag * sag / compliance, 1e-9 * elastic);
      ASSERT_TRUE(world.step().ok());
      if (slope == 0.0) {
        EXPECT_NEAR(world.energy().elastic, elastic, 1e-6 * elastic);
        EXPECT_NEAR(world.position(box).y(), 5e-4 - sag, 1e-6 * sag);
      }
    }
  }
}

// A box that arrives on a soft floor aslant. The damper of a contact may take back force of the
// first half of a substep, and friction stays in the cone of both halves together.
TEST(CompliantContact, FrictionOfALandingIsInItsCone) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    for (const double compliance : {1e-6, 1e-4}) {
      for (const double h : {3e-3, 3e-4}) {
        SCOPED_TRACE(test::name_of({SolverKind::direct, integrator}) + ", compliance " +
                     std::to_string(1e6 * compliance) + ", h " + std::to_string(1e3 * h));
        Heap heap(SolverKind::direct, integrator);
        heap.model.step = test::direct_settings(integrator, h);
        heap.surface.friction = 0.46;
        heap.floor();
        heap.surface.compliance = compliance;
        heap.put(test::box({0.3, 0.3, 0.3}), {0.0, 0.1501, 0.0}, 1.3);
        heap.last().velocity = {0.95, -0.9, 0.2};
        heap.last().orientation = rotation_by({0.01, 0.0, 0.02});
        World world = heap.start();
        double friction = 0.0;
        for (int i = 0; i < 60; ++i) {
          ASSERT_TRUE(world.step().ok());
          for (const ContactReport& contact : world.contacts()) {
            friction += contact.friction_force.norm();
            EXPECT_LE(contact.friction_force.norm(),
                      heap.surface.friction * contact.normal_force * (1.0 + 1e-6) + 1e-9);
          }
        }
        EXPECT_GT(friction, 0.0);
      }
    }
  }
}

// Without restitution of its own a box between two fingers comes to rest: the forces are those of
// statics, and none of them swings.
TEST(CompliantContact, ABoxBetweenFingersComesToRest) {
  for (const test::Method& method : test::methods) {
    for (const double compliance : {1e-7, 1e-5, 1e-4}) {
      SCOPED_TRACE(test::name_of(method) + ", compliance " + std::to_string(1e6 * compliance));
      Heap heap(method.solver, method.integrator);
      heap.model.step.iterations = 50;
      heap.surface.friction = 0.6;
      heap.surface.compliance = compliance;
      constexpr double mass = 0.5;
      constexpr double press = 12.0;
      const BodyId box = heap.put(test::box({0.06, 0.08, 0.06}), Vector3::Zero(), mass);
      for (const double side : {-1.0, 1.0}) {
        heap.put(test::box({0.02, 0.04, 0.04}), {0.04 * side, 0.0, 0.0}, 0.2);
        heap.last().mobility = Mobility::slider;
        heap.last().axis = Vector3::UnitX();
        heap.last().force = {-side * press, 0.0, 0.0};
      }
      World world = heap.start();
      test::run(world, 2.0);
      for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(world.step().ok());
        Vector3 friction = Vector3::Zero();
        double normal = 0.0;
        for (const ContactReport& contact : world.contacts()) {
          friction += contact.body_a == box ? contact.friction_force : -contact.friction_force;
          normal += contact.normal_force;
        }
        EXPECT_NEAR(friction.y(), mass * g, 1e-4 * mass * g);
        EXPECT_NEAR(normal, 2.0 * press, 1e-4 * press);
      }
      EXPECT_LT(world.velocity(box).norm(), 1e-5);
    }
  }
}

}  // namespace
}  // namespace sheave
