// What joints bear, at rest: reaction forces and torques against statics, and how far they give.
//
// A body of 3 kg with its centre 0.4 m beside the joint is held against gravity. On it act m g
// upwards at the joint and the torque 0.4 m x m g about it.
//
// Tolerances. With `direct` a static scene is solved to 1e-10 of its size (the tolerance of its
// rounds), which here is about 1 m and at h = 1/60 s, with the stiffness 1 / (w h^2) of a row, an
// error of 1e-10 m m / h^2 = 1e-6 N of 30 N. Gauss-Seidel gets there linearly; 400 sweeps are far
// more than the few rows need.

#include <gtest/gtest.h>

#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

constexpr double held_mass = 3.0;
constexpr double arm = 0.4;
constexpr double weight = held_mass * test::g;

class JointForce : public test::ForEveryCombination {
 protected:
  /// The report after 1 s of a joint that holds the body with its centre at `center`.
  JointReport hold(const std::shared_ptr<JointDef>& joint, const Vector3& center) {
    Model model;
    model.gravity = test::down;
    model.step = step_settings(1.0 / 60.0, GetParam().solver == SolverKind::direct ? 20 : 400);
    const BodyId body = model.add(test::lump("body", center, held_mass));
    joint->name = "joint";
    joint->body_b = body;
    model.joints.push_back(joint);
    World world = test::start(model);
    test::run(world, 1.0);
    moved = (world.position(body) - center).norm();
    turned = world.orientation(body).vec().norm();
    return joint_reports(world).at(0);
  }
  void expect_held(const JointReport& report, const Vector3& torque) const {
    const bool direct = GetParam().solver == SolverKind::direct;
    EXPECT_LT((report.force - Vector3(0.0, weight, 0.0)).norm(), direct ? 1e-6 : 1e-4);
    EXPECT_LT((report.torque - torque).norm(), direct ? 1e-6 : 1e-4);
    EXPECT_LT(moved, direct ? 1e-9 : 1e-6);
    EXPECT_LT(turned, direct ? 1e-9 : 1e-6);
  }

  double moved = 0.0;
  double turned = 0.0;
};

const Vector3 beside{arm, 0.0, 0.0};
const Vector3 bearing_torque{0.0, 0.0, arm* weight};

/// A rigid drive that stays where it is.
JointCoordinate held() {
  JointCoordinate coordinate;
  coordinate.drive = CoordinateDrive::position;
  coordinate.drive_values = {0.0};
  return coordinate;
}

TEST_P(JointForce, OfAWeld) {
  expect_held(hold(std::make_shared<FixedJoint>(), beside), bearing_torque);
}

TEST_P(JointForce, OfAHingeAcrossTheLoad) {
  auto joint = std::make_shared<HingeJoint>();
  joint->axis = Vector3::UnitX();
  expect_held(hold(joint, beside), bearing_torque);
}

TEST_P(JointForce, OfAHingeThatIsDriven) {
  auto joint = std::make_shared<HingeJoint>();
  joint->angle = held();
  const JointReport report = hold(joint, beside);
  expect_held(report, bearing_torque);
  EXPECT_NEAR(report.coordinates.at(0).drive_force, arm * weight, 1e-4);
}

TEST_P(JointForce, OfASliderThatIsDrivenUpright) {
  auto joint = std::make_shared<SliderJoint>();
  joint->axis = Vector3::UnitY();
  joint->travel = held();
  const JointReport report = hold(joint, beside);
  expect_held(report, bearing_torque);
  EXPECT_NEAR(report.coordinates.at(0).drive_force, weight, 1e-4);
}

TEST_P(JointForce, OfASliderAcross) {
  auto joint = std::make_shared<SliderJoint>();
  joint->axis = Vector3::UnitZ();
  expect_held(hold(joint, beside), bearing_torque);
}

TEST_P(JointForce, OfACylindricalJointAcross) {
  auto joint = std::make_shared<CylindricalJoint>();
  joint->axis = Vector3::UnitX();
  expect_held(hold(joint, beside), bearing_torque);
}

TEST_P(JointForce, OfAUniversalJointThatIsDriven) {
  auto joint = std::make_shared<UniversalJoint>();
  joint->axis_a = Vector3::UnitY();
  joint->axis_b = Vector3::UnitZ();
  joint->angle_b = held();
  const JointReport report = hold(joint, beside);
  expect_held(report, bearing_torque);
  EXPECT_NEAR(report.coordinates.at(1).drive_force, arm * weight, 1e-4);
}

TEST_P(JointForce, OfAPlane) {
  auto joint = std::make_shared<PlaneJoint>();
  joint->normal = Vector3::UnitY();
  expect_held(hold(joint, beside), bearing_torque);
}

TEST_P(JointForce, OfABallJointBelowWhichABodyHangs) {
  expect_held(hold(std::make_shared<BallJoint>(), {0.0, -arm, 0.0}), Vector3::Zero());
}

TEST_P(JointForce, OfARodFromWhichABodyHangs) {
  auto joint = std::make_shared<DistanceJoint>();
  joint->anchor_a = {0.0, 1.0, 0.0};
  expect_held(hold(joint, {0.0, -arm, 0.0}), Vector3::Zero());
}

TEST_P(JointForce, IsTheOppositeOnTheOtherBody) {
  // The same weld with the bodies exchanged: it bears the world, which hangs on it with the weight.
  Model model;
  model.gravity = test::down;
  model.step = step_settings(1.0 / 60.0, 100);
  const BodyId body = model.add(test::lump("body", {0.0, -arm, 0.0}, held_mass));
  auto joint = std::make_shared<FixedJoint>();
  joint->name = "joint";
  joint->body_a = body;
  joint->body_b = BodyId::world();
  model.joints.push_back(joint);
  World world = test::start(model);
  test::run(world, 0.5);
  EXPECT_LT((joint_reports(world).at(0).force + Vector3(0.0, weight, 0.0)).norm(), 1e-4);
}

TEST_P(JointForce, DeflectsBearingsByComplianceTimesForce) {
  auto joint = std::make_shared<FixedJoint>();
  joint->compliance = 1e-4;
  joint->angular_compliance = 1e-3;
  Model model;
  model.gravity = test::down;
  model.step = step_settings(1.0 / 240.0, 100);
  BodyDef lump = test::lump("body", beside, held_mass);
  // Oscillations die away: frequencies are 58 and 82 rad/s, decays by 20 / 3 and 1 / 0.27 per
  // second.
  lump.damping = 40.0;
  lump.angular_damping = 2.0;
  const BodyId body = model.add(lump);
  joint->name = "joint";
  joint->body_b = body;
  model.joints.push_back(joint);
  World world = test::start(model);
  test::run(world, 6.0);
  // The joint frame of B sinks by c m g and turns by c' 0.4 m x m g; the angle is small, sin and
  // tan alike to 1e-4.
  const double angle = 1e-3 * arm * weight;
  EXPECT_NEAR(2.0 * world.orientation(body).z(), -angle, 1e-4 * angle);
  EXPECT_NEAR(world.point(body, {-arm, 0.0, 0.0}).y(), -1e-4 * weight, 1e-4 * 1e-4 * weight);
}

INSTANTIATE_TEST_SUITE_P(Combinations, JointForce, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

// A weight on a breakable rod whose load grows: a force drive pulls with 10 N/s on top of m g.
TEST(JointBreaking, HappensAtTheLimitAndLeavesTheBodyFree) {
  for (const test::Combination combination : test::combinations) {
    Model model;
    model.gravity = test::down;
    model.step = test::settings(1.0 / 240.0, 1, 20);
    model.step.solver = combination.solver;
    model.step.integrator = combination.integrator;
    const BodyId body = model.add(test::weight("body", {0.0, -1.0, 0.0}, held_mass));
    auto rod = std::make_shared<DistanceJoint>();
    rod->name = "rod";
    rod->body_b = body;
    rod->anchor_b = {0.0, -1.0, 0.0};
    rod->breaking_force = weight + 5.0;
    auto pull = std::make_shared<SliderJoint>();
    pull->name = "pull";
    pull->body_b = body;
    pull->anchor = rod->anchor_b;
    pull->axis = -Vector3::UnitY();
    pull->travel.drive = CoordinateDrive::force;
    pull->travel.drive_times = {0.0, 1.0};
    pull->travel.drive_values = {0.0, 10.0};
    model.joints = {rod, pull};
    World world = test::start(model);
    test::run(world, 0.45);
    EXPECT_NEAR(joint_reports(world)[0].force.y(), weight + 4.5, 0.05);
    test::run(world, 1.0);
    const std::vector<JointReport> reports = joint_reports(world);
    ASSERT_TRUE(reports[0].broken_at.has_value());
    // The mean force of a substep exceeds the limit in the one after 0.5 s.
    EXPECT_NEAR(*reports[0].broken_at, 0.5, 2.0 / 240.0);
    EXPECT_EQ(reports[0].force, Vector3::Zero());
    EXPECT_FALSE(reports[1].broken_at.has_value());
    // m v = integral of m g + 10 t from the break on.
    const double from = *reports[0].broken_at;
    const double impulse = weight * (1.0 - from) + 5.0 * (1.0 - from * from);
    EXPECT_NEAR(-world.velocity(body).y(), impulse / held_mass, 1e-9);
  }
}

TEST(JointBreaking, IsPartOfTheState) {
  Model model;
  model.gravity = test::down;
  model.step = test::settings(0.01, 1, 20);
  const BodyId body = model.add(test::lump("body", {0.0, -1.0, 0.0}, held_mass));
  auto rod = std::make_shared<DistanceJoint>();
  rod->name = "rod";
  rod->body_b = body;
  rod->anchor_b = {0.0, -1.0, 0.0};
  rod->breaking_force = 0.5 * weight;
  model.joints = {rod};
  World world = test::start(model);
  const State whole = world.state();
  test::run(world, 0.1);
  EXPECT_TRUE(joint_reports(world)[0].broken_at.has_value());
  const State broken = world.state();
  test::run(world, 0.2);
  const std::uint64_t end = hash(world.state());
  ASSERT_TRUE(world.restore(broken).empty());
  test::run(world, 0.2);
  EXPECT_EQ(hash(world.state()), end);
  ASSERT_TRUE(world.restore(whole).empty());
  EXPECT_FALSE(joint_reports(world)[0].broken_at.has_value());
}

}  // namespace
}  // namespace sheave
