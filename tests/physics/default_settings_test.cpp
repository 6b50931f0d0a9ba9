// Machines that say nothing about their step: jointed and driven ones, against statics and
// kinematics.
//
// Tolerances: the direct solver ends its rounds at 1e-10 of the machine's size, here 0.1 to 2 m,
// and a force is the stiffness w / h^2 of its row times that: 200 kg / (1/240 s)^2 x 1e-10 m = 1e-3
// N of 1962 N. Springs of the finger come to rest as e^(-t k / c) with c / k = 0.02 s, in 2 s to
// nothing.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "engine/joint_report.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::g;

std::shared_ptr<SpoolLink> wound_on(BodyId body, Winding winding, double radius, double stored) {
  auto link = std::make_shared<SpoolLink>();
  link->body = body;
  link->winding = winding;
  link->radius = radius;
  link->stored_length = stored;
  return link;
}

std::shared_ptr<PinholeLink> hole(BodyId body, const Vector3& point) {
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  return link;
}

std::shared_ptr<HingeJoint> hinge_at(std::string name, BodyId a, BodyId b, const Vector3& anchor) {
  auto joint = std::make_shared<HingeJoint>();
  joint->name = std::move(name);
  joint->body_a = a;
  joint->body_b = b;
  joint->anchor = anchor;
  return joint;
}

TEST(DefaultSettings, ADrivenDrumOnAHingeLiftsFortyTimesItsMass) {
  test::Machine machine;
  machine.model.gravity = test::down;
  BodyDef drum = test::wheel("drum", Vector3::Zero(), 0.2, 0.1);
  drum.mobility = Mobility::planar;
  drum.mass = 5.0;
  const BodyId on = machine.model.add(drum);
  const BodyId load = machine.model.add(test::weight("load", {0.2, -2.0, 0.0}, 200.0));
  auto axle = hinge_at("axle", BodyId::world(), on, Vector3::Zero());
  axle->angle.drive = CoordinateDrive::speed;
  axle->angle.drive_values = {2.0};
  machine.model.joints.push_back(axle);
  // It turns counter-clockwise and takes the cable up on its right.
  machine.cables.push_back(
      test::cable("rope", {wound_on(on, Winding::clockwise, 0.2, 1.0), attach(load)}));
  Simulation s = test::start(machine);
  test::run(s.world, 1.0);
  EXPECT_NEAR(s.world.angular_velocity(on).z(), 2.0, 1e-9);
  EXPECT_NEAR(s.world.position(load).y(), -2.0 + 0.2 * 2.0, 1e-9);
  EXPECT_NEAR(s.cable_reports()[0].spans[0].tension, 200.0 * g, 1e-3);
  const JointReport report = joint_reports(s.world).at(0);
  EXPECT_NEAR(report.coordinates[0].drive_force, 200.0 * g * 0.2, 1e-3);
  EXPECT_NEAR(report.force.y(), 205.0 * g, 1e-3);
  EXPECT_LT(report.error, 1e-9);
}

/// Two phalanges of 50 mm with springs in their hinges, and a tendon below them that a drum draws
/// in.
struct Finger {
  static constexpr double length = 0.05;
  static constexpr double below = -0.008;
  static constexpr double stiffness = 0.1;
  static constexpr double drum_radius = 0.01;
  static constexpr double turn = 1.0;
  BodyId proximal;
  BodyId distal;
  test::Machine machine;

  Finger() {
    Model& model = machine.model;
    model.gravity = Vector3::Zero();
    const auto phalanx = [&](const char* name, double x) {
      BodyDef body = test::lump(name, {x, 0.0, 0.0}, 0.02);
      body.mobility = Mobility::planar;
      body.shapes.clear();
      body.inertia = Vector3(1e-6, 5e-6, 5e-6);
      return model.add(body);
    };
    proximal = phalanx("proximal", 0.5 * length);
    distal = phalanx("distal", 1.5 * length);
    for (const auto& joint : {hinge_at("knuckle", BodyId::world(), proximal, Vector3::Zero()),
                              hinge_at("middle", proximal, distal, {length, 0.0, 0.0})}) {
      joint->angle.stiffness = stiffness;
      joint->angle.damping = 0.02 * stiffness;
      model.joints.push_back(joint);
    }
    BodyDef drum = test::wheel("drum", {-0.06, below - drum_radius, 0.0}, drum_radius, 1e-6);
    drum.drive = DriveKind::angle;
    drum.drive_times = {0.0, 1.0};
    drum.drive_values = {0.0, turn};
    const BodyId on = model.add(drum);
    // Over the drum's top; counter-clockwise it draws in.
    machine.cables.push_back(test::cable(
        "tendon", {wound_on(on, Winding::clockwise, drum_radius, 0.05),
                   hole(BodyId::world(), {-0.02, below, 0.0}), hole(proximal, {0.0, below, 0.0}),
                   attach(distal, {0.0, below, 0.0})}));
  }
};

TEST(DefaultSettings, ATendonFingerBendsAsItsSpringsRequire) {
  const Finger finger;
  Simulation s = test::start(finger.machine);
  const double unwound = s.cable_reports()[0].spans[0].length +
                         s.cable_reports()[0].spans[1].length +
                         s.cable_reports()[0].spans[2].length;
  test::run(s.world, 3.0);
  const CableReport tendon = s.cable_reports()[0];
  double free_length = 0.0;
  for (const SpanReport& span : tendon.spans) {
    free_length += span.length;
    EXPECT_NEAR(span.tension, tendon.spans[0].tension, 1e-9 * span.tension);
  }
  // Rigid: what the drum has drawn in is missing outside, and the hinges are closed.
  EXPECT_NEAR(free_length, unwound - Finger::turn * Finger::drum_radius, 1e-9);
  const std::vector<JointReport> joints = joint_reports(s.world);
  for (const JointReport& joint : joints) EXPECT_LT(joint.error, 1e-9) << joint.name;
  // Statics: about each hinge the tendon's moment on what is beyond it is the spring's.
  const auto moment_about = [&](const Vector3& hinge_point, const SpanReport& last) {
    const Vector3 pull = tendon.spans[0].tension * (last.start - last.end).normalized();
    return (last.end - hinge_point).cross(pull).z();
  };
  const Vector3 middle = s.world.position(finger.proximal) +
                         s.world.orientation(finger.proximal) * Vector3(0.5 * Finger::length, 0, 0);
  const double knuckle_angle = joints[0].coordinates[0].value;
  const double middle_angle = joints[1].coordinates[0].value;
  EXPECT_LT(knuckle_angle, -0.1);
  EXPECT_LT(middle_angle, -0.1);
  EXPECT_NEAR(moment_about(Vector3::Zero(), tendon.spans[1]), Finger::stiffness * knuckle_angle,
              1e-6 * Finger::stiffness);
  EXPECT_NEAR(moment_about(middle, tendon.spans[2]), Finger::stiffness * middle_angle,
              1e-6 * Finger::stiffness);
}

}  // namespace
}  // namespace sheave
