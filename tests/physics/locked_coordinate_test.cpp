// Coordinates of joints that other joints lock: what acts along them is borne by locks, and nothing
// moves.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "engine/joint_report.h"
#include "engine/joints/plane.h"
#include "engine/joints/universal.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

class LockedCoordinate : public testing::TestWithParam<IntegratorKind> {};

// A body in a plane carries a rotor in another one. The body may turn about n2 alone, the rotor
// about n1 alone, and about the axle against each other, which are three directions that are all
// but in one plane: nothing turns, though a torque tries. It is for a friction row and locks, which
// tell the same but for 0.2 % of their gradients, to share between them. Both slide along u = n1 x
// n2, at g . u.
TEST_P(LockedCoordinate, FrictionOfARotorBetweenTwoPlanes) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(GetParam(), 0.003);
  const BodyId body = machine.model.add(test::lump("body", Vector3::Zero(), 1.5));
  const BodyId rotor =
      machine.model.add(test::sheave("rotor", body, Vector3::Zero(), 0.3, 1.5, 0.0635));
  const auto hold = [&](const char* name, BodyId held, const Vector3& at, const Vector3& normal) {
    auto plane = std::make_shared<PlaneJoint>();
    plane->name = name;
    plane->body_b = held;
    plane->anchor = at;
    plane->normal = normal;
    machine.model.joints.push_back(plane);
    return plane;
  };
  const Vector3 n1(-0.2683, 0.5431, -0.9832);
  const Vector3 n2(0.4749, -0.9504, 0.8774);
  const auto rough = hold("rough", rotor, {-0.41, -0.06, 0.05}, n1);
  rough->angle.friction = 1.5;
  rough->angle.drive = CoordinateDrive::force;
  rough->angle.drive_values = {2.1};
  hold("smooth", body, {-0.65, -0.04, 0.29}, n2);
  Simulation s = test::start(machine);
  for (int i = 0; i < 100; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.unconverged + report.statistics.cut_substeps, 0) << i;
    EXPECT_TRUE(s.certificate()->clean(1e-5)) << s.certificate()->worst()->sentence();
  }
  const double t = s.world.state().time;
  const Vector3 u = n1.cross(n2).normalized();
  const Vector3 a = u * u.dot(test::down);
  EXPECT_NEAR((s.world.velocity(body) - a * t).norm(), 0.0, 1e-9);
  EXPECT_NEAR(s.world.angular_velocity(rotor).norm(), 0.0, 1e-9);
}

// A body that turns when it begins, though two universal joints and a rail leave it no way: it
// stops at once, and what it holds from there on is the torque of a drive that gives. The rows that
// hold it depend on each other exactly where it is, and all but do where it would be if it went on.
TEST_P(LockedCoordinate, BodyThatCannotMoveAndBeginsTurning) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(GetParam(), 0.002);
  BodyDef prism = test::lump("prism", {1.35, 1.37, 0.0}, 0.6);
  prism.angular_velocity = {0.0, 0.0, 2.65};
  const BodyId turning = machine.model.add(prism);
  BodyDef carriage = test::weight("carriage", Vector3::Zero(), 1.6);
  carriage.axis = Vector3(-0.135, 0.991, 0.0);
  const BodyId rail = machine.model.add(carriage);
  const auto join = [&](BodyId a, BodyId b, const Vector3& at, const Vector3& across) {
    auto universal = std::make_shared<UniversalJoint>();
    universal->name = a.is_world() ? "first" : "second";
    universal->body_a = a;
    universal->body_b = b;
    universal->anchor = at;
    universal->axis_a = Vector3::UnitZ();
    universal->axis_b = across;
    machine.model.joints.push_back(universal);
    return universal;
  };
  join(BodyId::world(), turning, {1.4, 1.25, 0.0}, {0.87, 0.25, 0.0});
  const auto driven = join(turning, rail, {5.46, -0.35, 0.0}, {-0.58, 0.23, 0.0});
  driven->angle_a.drive = CoordinateDrive::position;
  driven->angle_a.drive_times = {0.0, 0.2};
  driven->angle_a.drive_values = {0.0, 0.5};
  driven->angle_a.drive_compliance = 1e-3;
  Simulation s = test::start(machine);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const Certificate certificate = *s.certificate();
    EXPECT_TRUE(certificate.clean(1e-5)) << certificate.worst()->sentence();
    EXPECT_LT(s.world.angular_velocity(turning).norm(), 1e-6);
  }
  // `rattle` tells the mean over the substep.
  const double lag = GetParam() == IntegratorKind::rattle ? 0.001 : 0.0;
  const double asked = 0.5 * (s.world.state().time - lag) / 0.2;
  EXPECT_NEAR(joint_reports(s.world)[1].coordinates[0].drive_force, asked / 1e-3, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Integrators, LockedCoordinate,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle));

}  // namespace
}  // namespace sheave
