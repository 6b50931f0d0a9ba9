// What the joint types let bodies do, in closed form, with every solver and integrator.
//
// Under constant forces velocities of both integrators are exact; angles that follow from positions
// of driven bodies are as good as the solver: 1e-10 of the scene with `direct`, what the sweeps
// leave with Gauss-Seidel.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/joint_report.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/universal.h"
#include "engine/math/turn_between.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

class JointTypes : public test::ForEveryCombination {
 protected:
  JointTypes() { model_.step = step_settings(1.0 / 240.0, direct() ? 30 : 300); }
  static bool direct() { return GetParam().solver == SolverKind::direct; }
  /// A joint of this type between two bodies.
  template <class Joint>
  std::shared_ptr<Joint> join(const char* name, BodyId a, BodyId b) {
    auto joint = std::make_shared<Joint>();
    joint->name = name;
    joint->body_a = a;
    joint->body_b = b;
    model_.joints.push_back(joint);
    return joint;
  }
  Model model_;
};

// Shafts along x and along e = (cos b, sin b, 0). The input's fork points along z at time 0, so
// after the angle p it is a = z cos p - y sin p; the output's is b = z x e cos q + z sin q, and a .
// b = 0 says tan q = cos b tan p.
TEST_P(JointTypes, CardanJointTurnsUnevenly) {
  const double bend = 0.5;
  const Vector3 out(std::cos(bend), std::sin(bend), 0.0);
  BodyDef input = test::lump("input", Vector3::Zero(), 1.0);
  input.mobility = Mobility::kinematic;
  input.mass.reset();
  input.inertia.reset();
  input.angular_velocity = {3.0, 0.0, 0.0};
  const BodyId a = model_.add(input);
  const BodyId b = model_.add(test::lump("output", Vector3::Zero(), 1.0));
  auto hinge = join<HingeJoint>("bearing", BodyId::world(), b);
  hinge->axis = out;
  auto cross = join<UniversalJoint>("cardan", a, b);
  cross->axis_a = Vector3::UnitZ();
  cross->axis_b = Vector3::UnitZ().cross(out);
  World world = test::start(model_);
  for (int i = 1; i <= 480; ++i) {
    ASSERT_TRUE(world.step().ok());
    const double p = 3.0 * i / 240.0;
    const double q = joint_reports(world)[0].coordinates[0].value;
    // q has as many turns as p.
    const double expected =
        p + std::atan2((std::cos(bend) - 1.0) * std::sin(p) * std::cos(p),
                       std::cos(p) * std::cos(p) + std::cos(bend) * std::sin(p) * std::sin(p));
    ASSERT_NEAR(q, expected, direct() ? 1e-8 : 1e-5) << i;
  }
}

TEST_P(JointTypes, GearsShareTorqueByTheSquareOfTheRatio) {
  BodyDef pinion = test::wheel("pinion", Vector3::Zero(), 0.1, 0.02);
  pinion.torque = {0.0, 0.0, 0.7};
  const BodyId a = model_.add(pinion);
  const BodyId b = model_.add(test::wheel("wheel", {0.6, 0.0, 0.0}, 0.5, 0.5));
  auto gear = join<GearJoint>("gear", a, b);
  gear->ratio = -0.2;
  World world = test::start(model_);
  test::run(world, 3.0);
  const double acceleration = 0.7 / (0.02 + 0.2 * 0.2 * 0.5);
  EXPECT_NEAR(world.angular_velocity(a).z(), 3.0 * acceleration, 1e-8);
  EXPECT_NEAR(world.angular_velocity(b).z(), -0.2 * 3.0 * acceleration, 1e-8);
  const JointReport report = joint_reports(world)[0];
  EXPECT_NEAR(report.torque.z(), -0.2 * acceleration * 0.5, 1e-8);
  // Many turns, and no tooth skipped.
  EXPECT_GT(report.coordinates[0].value, 20.0 * pi);
  EXPECT_NEAR(report.coordinates[1].value, -0.2 * report.coordinates[0].value, 1e-8);
}

TEST_P(JointTypes, BacklashIsCrossedFreely) {
  BodyDef pinion = test::wheel("pinion", Vector3::Zero(), 0.1, 0.02);
  pinion.angular_velocity = {0.0, 0.0, 1.0};
  const BodyId a = model_.add(pinion);
  const BodyId b = model_.add(test::wheel("wheel", {0.6, 0.0, 0.0}, 0.5, 0.5));
  auto gear = join<GearJoint>("gear", a, b);
  gear->ratio = -0.2;
  gear->backlash = 0.1;
  World world = test::start(model_);
  // Half of the play is 0.25 rad of the pinion.
  test::run(world, 0.24);
  EXPECT_EQ(world.angular_velocity(b).z(), 0.0);
  test::run(world, 0.5);
  // An inelastic impact: I1 w1 = (I1 + n^2 I2) w1' with the ratio n.
  const double after = 0.02 / (0.02 + 0.04 * 0.5);
  EXPECT_NEAR(world.angular_velocity(b).z(), -0.2 * after, 1e-9);
  EXPECT_NEAR(joint_reports(world)[0].coordinates[1].value,
              -0.2 * joint_reports(world)[0].coordinates[0].value + 0.05, 1e-8);
}

TEST_P(JointTypes, RackFallsAgainstItsPinion) {
  model_.gravity = test::down;
  const double radius = 0.2;
  const BodyId a = model_.add(test::wheel("pinion", Vector3::Zero(), radius, 0.05));
  const BodyId b = model_.add(test::weight("rack", {radius, 0.0, 0.0}, 3.0));
  auto rack = join<RackJoint>("rack", a, b);
  rack->direction = Vector3::UnitY();
  rack->anchor = {radius, 0.0, 0.0};
  rack->radius = radius;
  World world = test::start(model_);
  test::run(world, 1.0);
  const double acceleration = -3.0 * test::g / (3.0 + 0.05 / (radius * radius));
  EXPECT_NEAR(world.velocity(b).y(), acceleration, 1e-8);
  EXPECT_NEAR(world.angular_velocity(a).z(), acceleration / radius, 1e-7);
  EXPECT_NEAR(joint_reports(world)[0].force.y(), 3.0 * (acceleration + test::g), 1e-6);
}

// A nut that a spindle of pitch p lifts: m v dv + I w dw = (T w - m g v) dt with v = w p / 2 pi.
TEST_P(JointTypes, ScrewLiftsWithItsPitch) {
  model_.gravity = test::down;
  const double lead = 0.02 / (2.0 * pi);
  BodyDef spindle = test::wheel("spindle", Vector3::Zero(), 0.05, 1e-4);
  spindle.axis = Vector3::UnitY();
  spindle.orientation = turn_between(Vector3::UnitZ(), Vector3::UnitY());
  spindle.torque = {0.0, 0.5, 0.0};
  const BodyId a = model_.add(spindle);
  const BodyId b = model_.add(test::weight("nut", Vector3::Zero(), 100.0));
  auto screw = join<RackJoint>("screw", a, b);
  screw->axis = Vector3::UnitY();
  screw->direction = Vector3::UnitY();
  screw->radius = lead;
  World world = test::start(model_);
  test::run(world, 0.5);
  const double acceleration = (0.5 / lead - 100.0 * test::g) / (100.0 + 1e-4 / (lead * lead));
  EXPECT_NEAR(world.velocity(b).y(), 0.5 * acceleration, 1e-8 * std::abs(acceleration) + 1e-8);
}

// Sun (20 teeth), planet (15) and a ring (50) that stands still: the carrier turns at 20 / 70 of
// the sun.
TEST_P(JointTypes, PlanetsCarryTheirCarrier) {
  const BodyId sun = model_.add(test::wheel("sun", Vector3::Zero(), 0.2, 0.01));
  BodyDef ring = test::wheel("ring", Vector3::Zero(), 0.5, 1.0);
  ring.mobility = Mobility::fixed;
  ring.axis.reset();
  const BodyId fixed = model_.add(ring);
  BodyDef carrier = test::wheel("carrier", Vector3::Zero(), 0.35, 0.2);
  const BodyId arm = model_.add(carrier);
  BodyDef small = test::lump("planet", {0.35, 0.0, 0.0}, 0.5);
  small.mobility = Mobility::planar;
  const BodyId planet = model_.add(small);
  auto pin = join<HingeJoint>("pin", arm, planet);
  pin->anchor = {0.35, 0.0, 0.0};
  auto inner = join<GearJoint>("inner", sun, planet);
  inner->ratio = -20.0 / 15.0;
  inner->carrier = arm;
  auto outer = join<GearJoint>("outer", planet, fixed);
  outer->ratio = 15.0 / 50.0;
  outer->carrier = arm;
  auto motor = join<HingeJoint>("motor", BodyId::world(), sun);
  motor->angle.drive = CoordinateDrive::speed;
  motor->angle.drive_values = {7.0};
  World world = test::start(model_);
  test::run(world, 3.0);
  const double tolerance = direct() ? 1e-7 : 1e-3;
  EXPECT_NEAR(world.angular_velocity(sun).z(), 7.0, tolerance);
  EXPECT_NEAR(world.angular_velocity(arm).z(), 2.0, tolerance);
  // (w_planet - w_arm) = -20/15 (w_sun - w_arm).
  EXPECT_NEAR(world.angular_velocity(planet).z(), 2.0 - 20.0 / 15.0 * 5.0, 10.0 * tolerance);
  EXPECT_NEAR(joint_reports(world)[0].coordinates[0].value, -20.0 / 15.0 * 5.0 * 3.0,
              10.0 * tolerance);
}

TEST_P(JointTypes, CylindricalJointSlidesAndTurnsIndependently) {
  model_.gravity = test::down;
  BodyDef sleeve = test::lump("sleeve", {0.3, 0.0, 0.0}, 2.0);
  sleeve.inertia = Vector3(0.1, 0.1, 0.1);
  // About the axis through the origin, without tipping it.
  sleeve.angular_velocity = {0.0, 2.0, 0.0};
  sleeve.velocity = sleeve.angular_velocity.cross(sleeve.position);
  const BodyId b = model_.add(sleeve);
  auto joint = join<CylindricalJoint>("guide", BodyId::world(), b);
  joint->axis = Vector3::UnitY();
  World world = test::start(model_);
  const double start = world.energy().total();
  test::run(world, 1.0);
  const JointReport report = joint_reports(world)[0];
  EXPECT_NEAR(report.coordinates[0].rate, -test::g, 1e-8);
  if (GetParam().rattle()) {
    EXPECT_NEAR(report.coordinates[1].rate, 2.0, 1e-8);
    EXPECT_NEAR(world.energy().total(), start, 1e-7);
  } else {
    // xpbd slows what circles as 1 / sqrt(1 + 2 w^2 h t), here all but the part 0.1 of the inertia
    // 0.28.
    EXPECT_NEAR(report.coordinates[1].rate, 2.0, 2.0 * 4.0 / 240.0);
  }
}

TEST_P(JointTypes, PlaneLetsAPuckSlideAndSpinStraight) {
  BodyDef puck = test::lump("puck", Vector3::Zero(), 1.0);
  const Vector3 normal = Vector3(1.0, 2.0, 2.0) / 3.0;
  puck.orientation = turn_between(Vector3::UnitZ(), normal);
  puck.angular_velocity = 3.0 * normal;
  puck.velocity = Vector3(2.0, -1.0, 0.0);  // in the plane
  puck.force = 5.0 * normal;                // and held in it
  const BodyId b = model_.add(puck);
  auto joint = join<PlaneJoint>("table", BodyId::world(), b);
  joint->normal = normal;
  World world = test::start(model_);
  test::run(world, 2.0);
  EXPECT_LT((world.position(b) - 2.0 * puck.velocity).norm(), 1e-7);
  EXPECT_NEAR(joint_reports(world)[0].coordinates[0].value, 6.0, 1e-7);
  EXPECT_LT((joint_reports(world)[0].force + 5.0 * normal).norm(), 1e-5);
}

// Two welded bodies turn like one: about the common centre at constant rate, and the weld bears m
// w^2 r.
TEST_P(JointTypes, WeldedBodiesSpinAsOne) {
  model_.step.dt = 1.0 / 960.0;
  const auto half = [](const char* name, double x) {
    BodyDef body = test::lump(name, {x, 0.0, 0.0}, 2.0);
    body.angular_velocity = {0.0, 0.0, 4.0};
    body.velocity = {0.0, 4.0 * x, 0.0};
    return body;
  };
  const BodyId a = model_.add(half("left", -0.5));
  const BodyId b = model_.add(half("right", 0.5));
  join<FixedJoint>("weld", a, b);
  World world = test::start(model_);
  test::run(world, 1.0);
  EXPECT_LT((world.position(a) + world.position(b)).norm(), 1e-7);
  EXPECT_NEAR((world.position(a) - world.position(b)).norm(), 1.0, direct() ? 1e-8 : 1e-5);
  const double force = joint_reports(world)[0].force.norm();
  if (GetParam().rattle()) {
    EXPECT_NEAR(world.angular_velocity(b).z(), 4.0, 1e-6);
    EXPECT_NEAR(force, 2.0 * 16.0 * 0.5,
                2e-3);  // (w h)^2 / 4 of it at the middle of the step, and the chord
  }
}

// A winch: a rotor with a speed drive on its bearing, and a weight on a cable. What the drive can
// do decides.
TEST_P(JointTypes, SpeedDriveStallsAgainstAHeavyLoad) {
  for (const double limit : {30.0, 10.0}) {
    test::Machine machine;
    Model& model = machine.model;
    model.gravity = test::down;
    model.step = step_settings(1.0 / 240.0, direct() ? 30 : 300);
    const BodyId drum = model.add(test::wheel("drum", Vector3::Zero(), 0.2, 0.3));
    const BodyId load = model.add(test::weight("load", {0.2, -8.0, 0.0}, 10.0));
    auto motor = std::make_shared<HingeJoint>();
    motor->name = "motor";
    motor->body_b = drum;
    motor->angle.drive = CoordinateDrive::speed;
    motor->angle.drive_values = {2.5};
    motor->angle.drive_limit = limit;
    model.joints.push_back(motor);
    auto wound = test::roll(drum, test::right);
    wound->stored_length = 5.0;
    machine.cables.push_back(test::cable("rope", {wound, test::attach(load)}));
    Simulation simulation = test::start(machine);
    test::run(simulation.world, 0.5);
    const double weight = 10.0 * test::g * 0.2;
    const double inertia = 0.3 + 10.0 * 0.2 * 0.2;
    const double free_speed = 0.5 * (limit - weight) / inertia;
    EXPECT_NEAR(simulation.world.angular_velocity(drum).z(), std::min(2.5, free_speed), 1e-5);
    EXPECT_NEAR(joint_reports(simulation.world)[0].coordinates[0].drive_force,
                limit > weight ? weight : limit, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Combinations, JointTypes, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

}  // namespace
}  // namespace sheave
