// What a machine that nothing holds keeps: its momentum and its angular momentum, as far as the
// integrator does.
//
// Rows push bodies with equal and opposite forces along one line, so momentum is kept to rounding.
// With `rattle` the line is that of the bodies where the force acts, at the start and at the end:
// angular momentum is kept, too. `xpbd` lets the forces of the end act on bodies that are at the
// start: the arm between them has turned by w h meanwhile, which leaves a torque of first order,
// and so the angular momentum drifts with the step.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joints/ball.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

/// Three lumps in space, joined by ball joints, that tumble and fold.
Model floating_machine(IntegratorKind integrator, double h) {
  Model model;
  model.gravity.setZero();
  model.step = test::settings(h, 1, 30);
  model.step.solver = SolverKind::direct;
  model.step.integrator = integrator;
  // Each turns on its own, and its centre moves so that the joints stay closed.
  const std::vector<Vector3> turning{{0.5, 1.0, 3.0}, {0.5, -1.0, 2.0}, {1.0, 0.5, -2.0}};
  Vector3 joint_velocity = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    BodyDef part = test::lump("part" + std::to_string(i), {0.6 * i, 0.0, 0.0}, 1.0);
    part.angular_velocity = turning[k];
    const Vector3 half = turning[k].cross(Vector3(0.3, 0.0, 0.0));
    part.velocity = joint_velocity + half;
    joint_velocity += 2.0 * half;
    const BodyId id = model.add(part);
    if (i == 0) continue;
    auto ball = std::make_shared<BallJoint>();
    ball->name = "joint" + std::to_string(i);
    ball->body_a = {i - 1};
    ball->body_b = id;
    ball->anchor = {0.6 * i - 0.3, 0.0, 0.0};
    model.joints.push_back(ball);
  }
  return model;
}

Vector3 total_momentum(const World& world) {
  Vector3 sum = Vector3::Zero();
  for (const BodyState& body : world.state().bodies) sum += body.velocity;
  return sum;
}

Vector3 total_angular_momentum(const World& world) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < world.state().bodies.size(); ++i) {
    const BodyState& body = world.state().bodies[i];
    const Vector3 own = body.orientation.conjugate() * body.angular_velocity;
    sum += body.position.cross(body.velocity) +
           body.orientation * (world.bodies()[static_cast<int>(i)].inertia * own);
  }
  return sum;
}

/// Relative change of the angular momentum in 1 s; that of the momentum must be rounding.
double angular_drift(IntegratorKind integrator, double h) {
  World world = test::start(floating_machine(integrator, h));
  const Vector3 momentum = total_momentum(world);
  const Vector3 angular = total_angular_momentum(world);
  test::run(world, 1.0);
  EXPECT_LE((total_momentum(world) - momentum).norm(), 1e-9 * (1.0 + momentum.norm()));
  return (total_angular_momentum(world) - angular).norm() / angular.norm();
}

TEST(FreeFloating, XpbdLosesAngularMomentumInFirstOrder) {
  const double coarse = angular_drift(IntegratorKind::xpbd, 1.0 / 240.0);
  const double fine = angular_drift(IntegratorKind::xpbd, 1.0 / 480.0);
  RecordProperty("per_second_at_60_hz",
                 std::to_string(angular_drift(IntegratorKind::xpbd, 1.0 / 60.0)));
  EXPECT_GT(coarse, 1e-4) << "there is something to see";
  const double order = std::log2(coarse / fine);
  EXPECT_GE(order, 0.85);
  EXPECT_LE(order, 1.15);
}

TEST(FreeFloating, RattleKeepsAngularMomentum) {
  // To what the solver leaves: 1e-10 of the scene per substep between the points where a force and
  // its reaction act.
  for (const double h : {1.0 / 60.0, 1.0 / 240.0}) {
    EXPECT_LE(angular_drift(IntegratorKind::rattle, h), 1e-7) << h;
  }
}

}  // namespace
}  // namespace sheave
