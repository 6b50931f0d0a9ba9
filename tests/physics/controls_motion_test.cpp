// Kinematic bodies that are led while a world runs, against motions in tables and closed forms.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::down;
using test::g;
using test::right;
using test::roll;

void lead(World& world, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step().ok());
}

/// A weight that hangs on a kinematic body.
test::Machine hanging(bool oscillates) {
  test::Machine machine;
  machine.model.gravity = down;
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  hand.position = {0.0, 2.0, 0.0};
  if (oscillates) {
    hand.oscillation = {0.05, 0.2, 0.0};
    hand.oscillation_frequency = 0.8;
  }
  const BodyId top = machine.model.add(hand);
  const BodyId load = machine.model.add(test::lump("load", Vector3::Zero(), 3.0));
  machine.cables.push_back(cable("rope", {attach(top), attach(load)}));
  return machine;
}

// Targets with velocities, step by step, are a cubic between points of the oscillation: off it by
// x'''' dt^4 / 384 and, in the acceleration, x'''' dt^2 / 12, which is what the tension sees.
TEST(ControlsMotion, ALoadOnATargetFeelsTheVelocityOfTheTarget) {
  const double w = 2.0 * pi * 0.8;
  double previous = 0.0;
  for (const double dt : {0.02, 0.01}) {
    test::Machine machine = hanging(true);
    machine.model.step = test::direct_settings(IntegratorKind::rattle, dt, 4);
    Simulation table = test::start(machine);
    machine = hanging(false);
    machine.model.step = test::direct_settings(IntegratorKind::rattle, dt, 4);
    // The velocity at the start comes from the definition; the hand is at rest, so the first target
    // sets it off.
    Simulation led = test::start(machine);
    double worst = 0.0;
    const int steps = static_cast<int>(std::lround(2.0 / dt));
    for (int i = 0; i < steps; ++i) {
      const BodyState goal = table.world.bodies().kinematic_state(0, (i + 1) * dt);
      MotionTarget target;
      target.position = goal.position;
      target.velocity = goal.velocity;
      ASSERT_TRUE(led.world.set_motion({0}, target).empty());
      lead(table.world, 1);
      lead(led.world, 1);
      ASSERT_NEAR((led.world.position({0}) - goal.position).norm(), 0.0, 1e-12);
      ASSERT_NEAR((led.world.velocity({0}) - goal.velocity).norm(), 0.0, 1e-10);
      if (i < steps / 4) continue;
      const double a = table.cable_reports()[0].spans[0].tension;
      const double b = led.cable_reports()[0].spans[0].tension;
      worst = std::max(worst, std::abs(a - b));
    }
    // The start from rest within a step leaves a swing of its own: 0.05 x w dt / 2 sideways, and no
    // more than that in tension.
    const double acceleration = 0.2 * std::pow(w, 4.0) * dt * dt / 12.0;
    EXPECT_LT(worst, 3.0 * acceleration + 3.0 * g * 0.05 * w * dt);
    if (previous > 0.0) {
      EXPECT_LT(worst, 0.6 * previous);
    }
    previous = worst;
  }
}

TEST(ControlsMotion, GoesStraightAndStopsWithoutAVelocity) {
  test::Machine machine = hanging(false);
  machine.model.step = test::direct_settings(IntegratorKind::xpbd, 0.01, 2);
  Simulation s = test::start(machine);
  const Quaternion turned_by = rotation_by({0.3, -0.4, 0.5});
  MotionTarget target;
  target.position = {1.0, 3.0, 0.5};
  target.orientation = turned_by;
  target.over = 0.1;
  ASSERT_TRUE(s.world.set_motion({0}, target).empty());
  lead(s.world, 5);
  EXPECT_NEAR((s.world.position({0}) - Vector3(0.5, 2.5, 0.25)).norm(), 0.0, 1e-13);
  EXPECT_NEAR((s.world.velocity({0}) - Vector3(10.0, 10.0, 5.0)).norm(), 0.0, 1e-10);
  EXPECT_NEAR((s.world.angular_velocity({0}) - Vector3(3.0, -4.0, 5.0)).norm(), 0.0, 1e-10);
  lead(s.world, 6);
  EXPECT_NEAR((s.world.position({0}) - target.position).norm(), 0.0, 1e-13);
  EXPECT_NEAR(s.world.velocity({0}).norm(), 0.0, 1e-15);
  EXPECT_NEAR((s.world.orientation({0}).coeffs() - turned_by.coeffs()).norm(), 0.0, 1e-13);
}

// The angular velocity that is told is how the orientation changes, also where the axis does.
TEST(ControlsMotion, SpinIsTheRateOfTheOrientation) {
  Model model;
  model.step = test::direct_settings(IntegratorKind::xpbd, 1e-3);
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  model.add(hand);
  World world = test::start(model);
  MotionTarget target;
  target.orientation = rotation_by({0.6, -1.0, 0.8});
  target.velocity = Vector3{0.1, 0.0, 0.0};
  target.angular_velocity = Vector3{-1.0, 2.0, 0.5};
  target.over = 0.5;
  ASSERT_TRUE(world.set_motion({0}, target).empty());
  for (int i = 0; i < 600; ++i) {
    const Quaternion before = world.orientation({0});
    const Vector3 spin_before = world.angular_velocity({0});
    lead(world, 1);
    const Quaternion change = world.orientation({0}) * before.conjugate();
    const Vector3 mean = 0.5 * (spin_before + world.angular_velocity({0}));
    // The trapezium's rule: w'' dt^2 / 12 with w'' of some 1e2, but for the step at which the spin
    // begins to be steady.
    if (i > 0 && i != 500) {
      ASSERT_NEAR((2e3 * change.vec() - mean).norm(), 0.0, 2e-4) << i;
    }
    if (i == 499) {
      EXPECT_NEAR((world.angular_velocity({0}) - *target.angular_velocity).norm(), 0.0, 1e-12);
      EXPECT_NEAR((world.orientation({0}).coeffs() - target.orientation->coeffs()).norm(), 0.0,
                  1e-12);
    }
  }
  // On it goes.
  EXPECT_NEAR((world.angular_velocity({0}) - *target.angular_velocity).norm(), 0.0, 1e-15);
  EXPECT_NEAR(world.position({0}).x(), 0.01, 1e-12);
}

TEST(ControlsMotion, AClearedBodyReturnsWithoutAJump) {
  test::Machine machine = hanging(true);
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  Simulation s = test::start(machine);
  MotionTarget target;
  target.position = Vector3{0.0, 2.0, 0.0} + 0.3 * Vector3{0.05, 0.2, 0.0};
  target.over = 0.2;
  ASSERT_TRUE(s.world.set_motion({0}, target).empty());
  lead(s.world, 30);
  ASSERT_TRUE(s.world.clear_motion({0}, 0.3).empty());
  Vector3 last = s.world.position({0});
  for (int i = 0; i < 40; ++i) {
    lead(s.world, 1);
    EXPECT_LT((s.world.position({0}) - last).norm(), 0.03);
    last = s.world.position({0});
  }
  const BodyState expected = s.world.bodies().kinematic_state(0, s.world.state().time);
  EXPECT_EQ(s.world.state().bodies[0].position, expected.position);
  EXPECT_EQ(s.world.state().bodies[0].velocity, expected.velocity);
}

// A wheel that is led round winds cable as its rim does.
TEST(ControlsMotion, ATurningDrumWindsItsCable) {
  test::Machine machine;
  machine.model.gravity = down;
  BodyDef drum = test::wheel("drum", {0.0, 4.0, 0.0}, 0.25, 0.05);
  drum.mobility = Mobility::kinematic;
  drum.mass.reset();
  drum.inertia.reset();
  drum.spin_inertia.reset();
  drum.axis = Vector3::UnitZ();
  const BodyId on = machine.model.add(drum);
  const BodyId load = machine.model.add(test::weight("load", {0.25, 0.0, 0.0}, 3.0));
  auto spool = roll(on, right);
  spool->stored_length = 5.0;
  machine.cables.push_back(cable("rope", {spool, attach(load)}));
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01, 2);
  Simulation s = test::start(machine);
  const double y0 = s.world.position({1}).y();
  double angle = 0.0;
  for (int i = 0; i < 100; ++i) {
    angle += 0.03;
    MotionTarget target;
    target.position = {0.0, 4.0, 0.0};
    target.orientation = rotation_by({0.0, 0.0, angle});
    target.velocity = Vector3::Zero();
    target.angular_velocity = Vector3{0.0, 0.0, 3.0};
    ASSERT_TRUE(s.world.set_motion({0}, target).empty());
    lead(s.world, 1);
  }
  EXPECT_NEAR(s.world.position({1}).y() - y0, 0.25 * 3.0, 1e-9);
}

}  // namespace
}  // namespace sheave
