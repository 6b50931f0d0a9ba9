// Drag of bodies: physical, and the same for any step.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

void for_each_setting(const std::function<void(test::Machine&, double)>& check, test::Machine m) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double h : {0.1, 0.01}) {
      m.model.step = test::settings(h, 1, 10);
      m.model.step.integrator = integrator;
      check(m, h);
    }
  }
}

TEST(Damping, AFallingWeightApproachesItsTerminalVelocity) {
  test::Machine m;
  m.model.gravity = test::down;
  BodyDef weight = test::weight("weight", {0.0, 0.0, 0.0}, 2.0);
  weight.damping = 3.0;
  m.model.add(weight);
  for_each_setting(
      [](const test::Machine& machine, double h) {
        Simulation s = test::start(machine);
        for (int i = 0; i < static_cast<int>(std::lround(1.0 / h)); ++i) {
          ASSERT_TRUE(s.world.step().ok());
        }
        const double expected = -2.0 * g / 3.0 * (1.0 - std::exp(-1.5));
        EXPECT_NEAR(s.world.velocity({0}).y(), expected, 1e-12);
      },
      m);
}

TEST(Damping, AWheelComesToRest) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  BodyDef wheel = test::wheel("wheel", Vector3::Zero(), 0.2, 0.5);
  wheel.angular_velocity = {0.0, 0.0, 10.0};
  wheel.angular_damping = 0.2;
  wheel.torque = {0.0, 0.0, 0.3};
  m.model.add(wheel);
  for_each_setting(
      [](const test::Machine& machine, double h) {
        Simulation s = test::start(machine);
        for (int i = 0; i < static_cast<int>(std::lround(2.0 / h)); ++i) {
          ASSERT_TRUE(s.world.step().ok());
        }
        const double expected = 1.5 + 8.5 * std::exp(-0.8);
        EXPECT_NEAR(s.world.angular_velocity({0}).z(), expected, 1e-12);
      },
      m);
}

TEST(Damping, ATumblingBodyLosesItsAngularMomentumInProportion) {
  // With equal moments w decays as e^(-c t / I); with different ones it is stable for any drag.
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  BodyDef body = test::lump("lump", Vector3::Zero(), 1.0);
  body.angular_velocity = {1.0, 3.0, 0.5};
  body.angular_damping = 0.05;
  m.model.add(body);
  for_each_setting(
      [](test::Machine machine, double h) {
        double energy = 1e9;
        Simulation s = test::start(machine);
        for (int i = 0; i < static_cast<int>(std::lround(1.0 / h)); ++i) {
          ASSERT_TRUE(s.world.step().ok());
          EXPECT_LT(s.world.energy().kinetic, energy);
          energy = s.world.energy().kinetic;
        }
        machine.model.bodies[0].inertia = Vector3::Constant(0.1);
        Simulation round = test::start(machine);
        for (int i = 0; i < static_cast<int>(std::lround(1.0 / h)); ++i) {
          ASSERT_TRUE(round.world.step().ok());
        }
        EXPECT_NEAR(round.world.angular_velocity({0}).y(), 3.0 * std::exp(-0.5), 1e-12);
      },
      m);
}

}  // namespace
}  // namespace sheave
