// Dry friction of joints that slide in several directions is against the motion, whatever pulls
// across it.
//
// A body of unit inertia moves at v0 along x, with a load F along z and friction M > F: v' = F e_z
// - M v / |v|. Across the motion nothing holds, so the motion turns towards the load. Reference:
// Runge-Kutta with steps of 1e-5 s. The direction of friction is that of the slip over a substep, or
// of its end, and so the error is of first order in it.
//
// What rests is held against a load of any direction up to M, and beyond it moves off at F - M along
// it, which every rule steps exactly.

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

/// Directions along the axes of a joint and between them.
const std::array<Vector3, 5> directions{Vector3(1.0, 0.0, 0.0), Vector3(1.0, 0.0, 1.0),
                                        Vector3(1.0, 1.0, 1.0), Vector3(-3.0, 1.0, 2.0),
                                        Vector3(0.2, -1.0, 0.0)};

/// What sweeps leave of a velocity that is reached in some tens of substeps.
constexpr double negligible = 1e-9;

TEST_P(JointFrictionDirection, BallJointTurnsFromRestAlongTheTorque) {
  constexpr double inertia = 0.1;
  constexpr double bound = 1.0;
  for (const Vector3& direction : directions) {
    for (const double torque : {0.99 * bound, 1.5 * bound}) {
      SCOPED_TRACE(::testing::Message() << direction.transpose() << ", torque " << torque);
      Model model;
      BodyDef body = unit_body();
      body.inertia = inertia * Vector3::Ones();
      body.torque = torque * direction.normalized();
      model.add(body);
      auto joint = std::make_shared<BallJoint>();
      joint->name = "ball";
      joint->body_b = BodyId{0};
      joint->friction = bound;
      model.joints.push_back(joint);
      model.step = step_settings(1.0 / 60.0, 50);
      World world = start(model);
      run(world, 0.5);
      const double rate = std::max(torque - bound, 0.0) / inertia * world.state().time;
      const Vector3 expected = rate * direction.normalized();
      EXPECT_NEAR((world.state().bodies[0].angular_velocity - expected).norm(), 0.0, negligible);
    }
  }
}

TEST_P(JointFrictionDirection, PlaneJointSlidesFromRestAlongTheForce) {
  constexpr double bound = 4.905;
  for (const Vector3& direction : directions) {
    const Vector3 along = Vector3(direction.x(), 0.0, direction.z()).normalized();
    for (const double force : {0.99 * bound, 6.0}) {
      SCOPED_TRACE(::testing::Message() << along.transpose() << ", force " << force);
      Model model;
      BodyDef body = unit_body();
      body.force = force * along;
      model.add(body);
      auto joint = std::make_shared<PlaneJoint>();
      joint->name = "plane";
      joint->body_b = BodyId{0};
      joint->normal = Vector3::UnitY();
      joint->friction = bound;
      model.joints.push_back(joint);
      model.step = step_settings(1.0 / 60.0, 50);
      World world = start(model);
      run(world, 0.5);
      const Vector3 expected = std::max(force - bound, 0.0) * world.state().time * along;
      EXPECT_NEAR((world.state().bodies[0].velocity - expected).norm(), 0.0, negligible);
    }
  }
}

// What turns comes to rest after J w / M, wherever it turns about, and stays there against a load
// from another direction.
TEST_P(JointFrictionDirection, BallJointComesToRest) {
  Model model;
  BodyDef body = unit_body();
  body.angular_velocity = Vector3(1.0, -2.0, 2.0);
  body.torque = Vector3(0.5, 0.0, 0.5);
  model.add(body);
  auto joint = std::make_shared<BallJoint>();
  joint->name = "ball";
  joint->body_b = BodyId{0};
  joint->friction = 4.0;
  model.joints.push_back(joint);
  model.step = step_settings(1.0 / 60.0, 50);
  World world = start(model);
  // At 3 rad/s with no more than 4 + 0.71 N m, and no less than 4 - 0.71 N m, of friction and load.
  run(world, 3.0 / 4.71 - 1.0 / 60.0);
  EXPECT_GT(world.state().bodies[0].angular_velocity.norm(), 0.0);
  run(world, 3.0 / 3.29 + 1.0 / 60.0);
  EXPECT_NEAR(world.state().bodies[0].angular_velocity.norm(), 0.0, negligible);
  const Quaternion before = world.state().bodies[0].orientation;
  run(world, 2.0);
  EXPECT_NEAR(world.state().bodies[0].orientation.angularDistance(before), 0.0, negligible);
}

INSTANTIATE_TEST_SUITE_P(All, JointFrictionDirection, ::testing::ValuesIn(combinations),
                         combination_name);

}  // namespace
}  // namespace sheave::test
