// Drives that turn what cannot turn so are refused, with the names of both bodies.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/joints/hinge.h"
#include "engine/joints/universal.h"
#include "engine/model.h"
#include "engine/world.h"

namespace sheave {
namespace {

BodyDef body_of(Mobility mobility, const Vector3& axis) {
  BodyDef body;
  body.name = "door";
  body.mobility = mobility;
  body.mass = 1.0;
  body.inertia = Vector3::Ones();
  if (mobility != Mobility::free) body.axis = axis;
  return body;
}

HingeJoint driven_about(const Vector3& axis) {
  HingeJoint hinge;
  hinge.name = "hinge";
  hinge.body_b = {0};
  hinge.axis = axis;
  hinge.angle.drive = CoordinateDrive::speed;
  hinge.angle.drive_values = {1.0};
  return hinge;
}

template <class Joint>
Errors errors_of(const BodyDef& body, const Joint& joint) {
  Model model;
  model.add(body);
  model.joints.push_back(std::make_shared<Joint>(joint));
  return World::check(model);
}

TEST(DriveReach, ABodyInAPlaneTurnsAboutItsNormalAlone) {
  const BodyDef planar = body_of(Mobility::planar, Vector3::UnitZ());
  EXPECT_TRUE(errors_of(planar, driven_about({0, 0, -2})).empty());
  const Errors errors = errors_of(planar, driven_about({1, 0, 0}));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].path, "/joints/0/drive");
  EXPECT_EQ(
      errors[0].message,
      "joint \"hinge\": its drive turns bodies about (1, 0, 0), but \"world\" cannot turn and "
      "\"door\" turns about (0, 0, 1) alone; join bodies that can, or give a drive_limit, at "
      "which the drive stalls");
  EXPECT_TRUE(
      errors_of(body_of(Mobility::free, Vector3::UnitZ()), driven_about({1, 0, 0})).empty());
}

TEST(DriveReach, ASliderDoesNotTurn) {
  const BodyDef slider = body_of(Mobility::slider, Vector3::UnitZ());
  EXPECT_EQ(errors_of(slider, driven_about({0, 0, 1})).size(), 1U);
}

TEST(DriveReach, ALeaningAxisIsLockedByTheHinge) {
  const BodyDef planar = body_of(Mobility::planar, Vector3::UnitZ());
  HingeJoint leaning = driven_about({0.1, 0, 1});
  EXPECT_EQ(errors_of(planar, leaning).size(), 1U);
  leaning.angular_compliance = 1e-6;
  EXPECT_TRUE(errors_of(planar, leaning).empty()) << "the locks give";
}

TEST(DriveReach, ADriveThatHoldsNeedsNoMotion) {
  const BodyDef slider = body_of(Mobility::slider, Vector3::UnitZ());
  HingeJoint hinge = driven_about({0, 0, 1});
  hinge.angle.drive_values = {0.0};
  EXPECT_TRUE(errors_of(slider, hinge).empty());
  hinge.angle.drive = CoordinateDrive::position;
  EXPECT_TRUE(errors_of(slider, hinge).empty());
  hinge.angle.drive_amplitude = 0.1;
  hinge.angle.drive_frequency = 1.0;
  EXPECT_EQ(errors_of(slider, hinge).size(), 1U);
}

TEST(DriveReach, ADriveWithALimitOrAForceNeedsNoMotion) {
  const BodyDef slider = body_of(Mobility::slider, Vector3::UnitZ());
  HingeJoint hinge = driven_about({0, 0, 1});
  hinge.angle.drive_limit = 1.0;
  EXPECT_TRUE(errors_of(slider, hinge).empty());
  hinge.angle.drive_limit.reset();
  hinge.angle.drive = CoordinateDrive::force;
  EXPECT_TRUE(errors_of(slider, hinge).empty());
}

TEST(DriveReach, BodiesThatTurnAboutTwoAxesTurnAboutAnyAxisBetweenThem) {
  Model model;
  model.add(body_of(Mobility::planar, Vector3::UnitZ()));
  model.add(body_of(Mobility::planar, Vector3::UnitX()));
  model.bodies[1].name = "flap";
  const auto count = [&](const Vector3& axis) {
    HingeJoint hinge = driven_about(axis);
    hinge.body_a = {1};
    model.joints = {std::make_shared<HingeJoint>(hinge)};
    return World::check(model).size();
  };
  EXPECT_EQ(count({1, 0, 1}), 0U);
  EXPECT_EQ(count({0, 1, 0}), 1U);
}

TEST(DriveReach, ACardanJointNeedsATurnAboutItsAxis) {
  UniversalJoint joint;
  joint.name = "joint";
  joint.body_b = {0};
  joint.axis_a = {1, 0, 0};
  joint.axis_b = {0, 0, 1};
  joint.angle_b.drive = CoordinateDrive::speed;
  joint.angle_b.drive_values = {1.0};
  const BodyDef planar = body_of(Mobility::planar, Vector3::UnitZ());
  EXPECT_TRUE(errors_of(planar, joint).empty());
  joint.angle_a = std::exchange(joint.angle_b, {});
  const Errors errors = errors_of(planar, joint);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].path, "/joints/0/angle_a_drive");
}

TEST(DriveReach, ARotorOnATurningBodyTurnsAboutAnyAxis) {
  Model model;
  model.add(body_of(Mobility::planar, Vector3::UnitZ()));
  BodyDef wheel = body_of(Mobility::rotor, Vector3::UnitX());
  wheel.name = "wheel";
  wheel.mount = BodyId{0};
  model.add(wheel);
  HingeJoint hinge = driven_about({0, 1, 0});
  hinge.body_b = {1};
  model.joints = {std::make_shared<HingeJoint>(hinge)};
  EXPECT_TRUE(World::check(model).empty());
  model.bodies[0].mobility = Mobility::slider;
  EXPECT_EQ(World::check(model).size(), 1U);
}

}  // namespace
}  // namespace sheave
