// Dry friction of joints that slide in several directions is against the motion, whatever pulls
// across it.
//
// A body of unit inertia moves at v0 along x, with a load F along z and friction M > F: v' = F e_z
// - M v / |v|. Across the motion nothing holds, so the motion turns towards the load. Reference:
// Runge-Kutta with steps of 1e-5 s. The direction of friction is that of the start of a substep,
// and so the error is of first order in it.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/joints/ball.h"
#include "engine/joints/plane.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::test {
namespace {

constexpr double friction = 4.905;
constexpr double across = 3.0;
constexpr double first_speed = 3.0;
constexpr double duration = 0.4;

/// v along x and z after the duration.
Vector3 turned_motion() {
  const auto acceleration = [](const Vector3& v) -> Vector3 {
    return Vector3(0.0, 0.0, across) - friction * v.normalized();
  };
  Vector3 v(first_speed, 0.0, 0.0);
  constexpr int steps = 40000;
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector3 k1 = acceleration(v);
    const Vector3 k2 = acceleration(v + 0.5 * h * k1);
    const Vector3 k3 = acceleration(v + 0.5 * h * k2);
    const Vector3 k4 = acceleration(v + h * k3);
    v += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return v;
}

class JointFrictionDirection : public ForEveryCombination {
 protected:
  /// What is wrong with the velocity, of translation or rotation, after the duration.
  static double error_of(const Model& drawn, double h, bool turning) {
    Model model = drawn;
    model.step = step_settings(h, 100);
    World world = start(model);
    run(world, duration);
    const BodyState& body = world.state().bodies[0];
    return ((turning ? body.angular_velocity : body.velocity) - turned_motion()).norm();
  }
  static void expect_first_order(const Model& model, bool turning) {
    const double coarse = error_of(model, 1.0 / 400.0, turning);
    const double fine = error_of(model, 1.0 / 800.0, turning);
    EXPECT_LT(coarse, 0.005);
    EXPECT_NEAR(coarse / fine, 2.0, 0.2);
  }
};

BodyDef unit_body() {
  BodyDef body;
  body.name = "body";
  body.mass = 1.0;
  body.inertia = Vector3::Ones();
  return body;
}

TEST_P(JointFrictionDirection, PlaneJointSlidesTowardsALoadAcrossItsMotion) {
  Model model;
  BodyDef body = unit_body();
  body.velocity.x() = first_speed;
  body.force.z() = across;
  model.add(body);
  auto joint = std::make_shared<PlaneJoint>();
  joint->name = "plane";
  joint->body_b = BodyId{0};
  joint->normal = Vector3::UnitY();
  joint->friction = friction;
  model.joints.push_back(joint);
  expect_first_order(model, false);
}

TEST_P(JointFrictionDirection, BallJointTurnsTowardsATorqueAcrossItsMotion) {
  Model model;
  BodyDef body = unit_body();
  body.angular_velocity.x() = first_speed;
  body.torque.z() = across;
  model.add(body);
  auto joint = std::make_shared<BallJoint>();
  joint->name = "ball";
  joint->body_b = BodyId{0};
  joint->friction = friction;
  model.joints.push_back(joint);
  expect_first_order(model, true);
}

INSTANTIATE_TEST_SUITE_P(all, JointFrictionDirection, ::testing::ValuesIn(combinations),
                         combination_name);

}  // namespace
}  // namespace sheave::test
