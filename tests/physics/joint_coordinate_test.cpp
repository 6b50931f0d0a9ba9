// Springs, dampers, dry friction, stops and drives along a joint's coordinate, against closed
// forms.
//
// A flywheel of I = 0.06 kg m2 on a hinge, a sledge of 2 kg on a slider. For constant forces both
// integrators have exact velocities; what is exact is compared within 1e-9, or, for Gauss-Seidel,
// within what 100 sweeps over six rows leave.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/slider.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

constexpr double inertia = 0.06;
constexpr double sledge_mass = 2.0;

class JointCoordinates : public test::ForEveryCombination {
 protected:
  /// A flywheel on a hinge with this along its angle, turning with `speed`.
  World flywheel(const JointCoordinate& angle, double speed, double h = 1.0 / 240.0) {
    Model model;
    model.step = step_settings(h, 50);
    BodyDef body = test::lump("wheel", Vector3::Zero(), 1.0);
    body.inertia = Vector3(0.04, 0.05, inertia);
    body.angular_velocity = {0.0, 0.0, speed};
    model.add(body);
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = "hinge";
    hinge->body_b = wheel;
    hinge->angle = angle;
    model.joints.push_back(hinge);
    return test::start(model);
  }
  /// A sledge on a level slider, or on one that rises by `slope` [rad].
  World sledge(const JointCoordinate& travel, double speed, double slope = 0.0,
               double h = 1.0 / 240.0) {
    Model model;
    model.gravity = test::down;
    model.step = step_settings(h, 50);
    const Vector3 axis{std::cos(slope), std::sin(slope), 0.0};
    BodyDef body = test::lump("sledge", Vector3::Zero(), sledge_mass);
    body.velocity = speed * axis;
    model.add(body);
    auto slider = std::make_shared<SliderJoint>();
    slider->name = "slider";
    slider->body_b = wheel;
    slider->axis = axis;
    slider->travel = travel;
    model.joints.push_back(slider);
    return test::start(model);
  }
  static JointCoordinateReport coordinate(const World& world) {
    return joint_reports(world).at(0).coordinates.at(0);
  }
  static constexpr BodyId wheel{0};
};

JointCoordinate drive(CoordinateDrive kind, double value) {
  JointCoordinate coordinate;
  coordinate.drive = kind;
  coordinate.drive_values = {value};
  return coordinate;
}

TEST_P(JointCoordinates, CountWholeTurns) {
  // 5 turns per substep.
  World world = flywheel({}, 10.0 * pi * 240.0);
  test::run(world, 1.0);
  EXPECT_NEAR(coordinate(world).value, 2400.0 * pi, 1e-8);
  EXPECT_NEAR(coordinate(world).rate, 2400.0 * pi, 1e-8);
}

TEST_P(JointCoordinates, SpringOscillatesAtItsFrequency) {
  // The angle after n periods of the method itself: implicit Euler multiplies the amplitude by 1 /
  // sqrt(1 + (w h)^2) per step and advances the phase by atan(w h); the midpoint rule by 2 atan(w h
  // / 2), without loss.
  JointCoordinate spring;
  spring.stiffness = 6.0;
  spring.rest = 0.3;
  World world = flywheel(spring, 0.0);
  const double h = 1.0 / 240.0;
  const double w = std::sqrt(spring.stiffness / inertia);
  const int steps = 240;
  test::run(world, 1.0);
  double expected = 0.0;
  if (GetParam().rattle()) {
    expected = 0.3 * (1.0 - std::cos(steps * 2.0 * std::atan(0.5 * w * h)));
  } else {
    // x' = x + h v', v' = v - h w^2 x': v starts from 0, so x_n = rest (1 - Re((1 - i w h)^-n)).
    const double decay = std::pow(1.0 + w * w * h * h, -0.5 * steps);
    expected = 0.3 * (1.0 - decay * std::cos(steps * std::atan(w * h)));
  }
  EXPECT_NEAR(coordinate(world).value, expected, 1e-8);
}

TEST_P(JointCoordinates, DamperSlowsExponentially) {
  JointCoordinate damper;
  damper.damping = 0.12;
  World world = flywheel(damper, 5.0);
  test::run(world, 1.0);
  // Per step by 1 / (1 + b h / I), or by (1 - b h / 2 I) / (1 + b h / 2 I); both tend to exp(-b t /
  // I).
  const double x = 0.12 / inertia / 240.0;
  const double factor = GetParam().rattle() ? (1.0 - 0.5 * x) / (1.0 + 0.5 * x) : 1.0 / (1.0 + x);
  EXPECT_NEAR(coordinate(world).rate, 5.0 * std::pow(factor, 240), 1e-8);
  EXPECT_NEAR(coordinate(world).rate, 5.0 * std::exp(-2.0), GetParam().rattle() ? 1e-4 : 1e-2);
}

TEST_P(JointCoordinates, DryFrictionDeceleratesEvenlyAndThenHolds) {
  JointCoordinate friction;
  friction.friction = 0.3;
  World world = flywheel(friction, 5.0);
  test::run(world, 0.5);
  EXPECT_NEAR(coordinate(world).rate, 5.0 - 0.5 * 0.3 / inertia, 1e-8);
  test::run(world, 2.0);
  EXPECT_NEAR(coordinate(world).rate, 0.0, 1e-9);
  const double stopped = coordinate(world).value;
  // v^2 I / 2 M, but for the substep in which it stops and xpbd's first order.
  EXPECT_NEAR(stopped, 2.5, 5.0 / 240.0);
  test::run(world, 10.0);
  EXPECT_NEAR(coordinate(world).value, stopped, 1e-9);
}

TEST_P(JointCoordinates, DryFrictionHoldsOnASlopeUpToItsForce) {
  const double slope = 0.3;
  const double pull = sledge_mass * test::g * std::sin(slope);
  JointCoordinate friction;
  friction.friction = 1.01 * pull;
  World holding = sledge(friction, 0.0, slope);
  test::run(holding, 5.0);
  EXPECT_NEAR(coordinate(holding).value, 0.0, 1e-9);
  friction.friction = 0.99 * pull;
  World sliding = sledge(friction, 0.0, slope);
  test::run(sliding, 5.0);
  EXPECT_NEAR(coordinate(sliding).rate, -5.0 * 0.01 * pull / sledge_mass, 1e-7);
}

TEST_P(JointCoordinates, StopsHoldWithoutOvershoot) {
  JointCoordinate stops;
  stops.lower = -0.2;
  stops.upper = 0.5;
  World world = sledge(stops, 3.0);
  double farthest = 0.0;
  for (int i = 0; i < 480; ++i) {
    ASSERT_TRUE(world.step().ok());
    farthest = std::max(farthest, coordinate(world).value);
  }
  EXPECT_LE(farthest, 0.5 + 1e-9);
  EXPECT_NEAR(coordinate(world).value, 0.5, 1e-9);  // an inelastic impact
  EXPECT_NEAR(coordinate(world).rate, 0.0, 1e-9);
  World down = sledge(stops, 0.0, 0.3);
  test::run(down, 2.0);
  EXPECT_NEAR(coordinate(down).value, -0.2, 1e-9);
  // Its axis rises to the right, and so does what the stop does; the guide bears the rest of the
  // weight.
  EXPECT_NEAR(joint_reports(down)[0].force.y(), sledge_mass * test::g, 1e-4);
}

TEST_P(JointCoordinates, ElasticStopGivesByComplianceTimesForce) {
  JointCoordinate stop;
  stop.lower = -0.1;
  stop.limit_compliance = 1e-3;
  stop.damping = 30.0;
  World world = sledge(stop, 0.0, 0.3);
  test::run(world, 20.0);
  EXPECT_NEAR(coordinate(world).value, -0.1 - 1e-3 * sledge_mass * test::g * std::sin(0.3), 1e-8);
}

TEST_P(JointCoordinates, SpeedDriveWithALimitRampsUpAndStaysThere) {
  JointCoordinate motor = drive(CoordinateDrive::speed, 4.0);
  motor.drive_limit = 0.12;
  World world = flywheel(motor, 0.0);
  double fastest = 0.0;
  for (int i = 1; i <= 240 * 4; ++i) {
    ASSERT_TRUE(world.step().ok());
    const double rate = coordinate(world).rate;
    fastest = std::max(fastest, rate);
    if (i == 240) {
      EXPECT_NEAR(rate, 0.12 / inertia, 1e-8);
      EXPECT_NEAR(coordinate(world).drive_force, 0.12, 1e-8);
    }
  }
  EXPECT_LE(fastest, 4.0 + 1e-9);
  EXPECT_NEAR(coordinate(world).rate, 4.0, 1e-9);
  EXPECT_NEAR(coordinate(world).drive_force, 0.0, 1e-7);
}

TEST_P(JointCoordinates, PositionDriveFollowsASine) {
  JointCoordinate motor;
  motor.drive = CoordinateDrive::position;
  motor.drive_amplitude = 0.4;
  motor.drive_frequency = 0.5;
  World world = flywheel(motor, 0.0);
  for (int i = 1; i <= 480; ++i) {
    ASSERT_TRUE(world.step().ok());
    ASSERT_NEAR(coordinate(world).value, 0.4 * std::sin(pi * i / 240.0), 1e-9);
    if (GetParam().rattle()) {
      ASSERT_NEAR(coordinate(world).rate, 0.4 * pi * std::cos(pi * i / 240.0), 1e-8);
    }
  }
}

TEST_P(JointCoordinates, SoftPositionDriveGivesUnderLoad) {
  JointCoordinate lift = drive(CoordinateDrive::position, 0.25);
  lift.drive_compliance = 2e-3;
  lift.damping = 40.0;
  World world = sledge(lift, 0.0, 0.3);
  test::run(world, 20.0);
  EXPECT_NEAR(coordinate(world).value, 0.25 - 2e-3 * sledge_mass * test::g * std::sin(0.3), 1e-8);
  EXPECT_NEAR(coordinate(world).drive_force, sledge_mass * test::g * std::sin(0.3), 1e-6);
}

TEST_P(JointCoordinates, ForceDriveAcceleratesByForceOverMass) {
  JointCoordinate push = drive(CoordinateDrive::force, 0.0);
  push.drive_times = {0.0, 1.0};
  push.drive_values = {0.0, 6.0};
  World world = sledge(push, 0.0);
  test::run(world, 0.5);
  EXPECT_NEAR(coordinate(world).rate, 0.5 * 0.5 * 3.0 / sledge_mass, 1e-9);
  test::run(world, 2.0);
  EXPECT_NEAR(coordinate(world).rate, (3.0 + 6.0) / sledge_mass, 1e-9);
}

TEST_P(JointCoordinates, ActuatorLiftsAndDashpotLimitsTheFall) {
  Model model;
  model.gravity = test::down;
  model.step = step_settings(1.0 / 240.0, 50);
  const BodyId lifted = model.add(test::lump("lifted", {0.0, -2.0, 0.0}, sledge_mass));
  const BodyId falling = model.add(test::lump("falling", {3.0, -1.0, 0.0}, sledge_mass));
  const auto line = [&](const char* name, BodyId body) {
    auto joint = std::make_shared<DistanceJoint>();
    joint->name = name;
    joint->body_b = body;
    joint->anchor_b = model.bodies[static_cast<std::size_t>(body.index)].position;
    joint->anchor_a = Vector3(joint->anchor_b.x(), 0.0, 0.0);
    joint->limit = DistanceLimit::none;
    model.joints.push_back(joint);
    return joint;
  };
  line("actuator", lifted)->extension = drive(CoordinateDrive::speed, -0.5);
  line("dashpot", falling)->damping = 8.0;
  World world = test::start(model);
  test::run(world, 2.0);
  EXPECT_NEAR(world.position(lifted).y(), -1.0, 1e-9);
  EXPECT_NEAR(joint_reports(world)[0].force.y(), sledge_mass * test::g, 1e-5);
  // v tends to m g / b; after 2 s all but e^-8 of it.
  EXPECT_NEAR(-world.velocity(falling).y(), sledge_mass * test::g / 8.0,
              1e-3 * sledge_mass * test::g / 8.0);
}

/// Speed lost in 0.5 s by a ball joint's or a plane's dry friction, in any direction.
TEST_P(JointCoordinates, DryFrictionOfBallsAndPlanesIsTheSameInAllDirections) {
  for (const Vector3& way :
       {Vector3(1.0, 0.0, 0.0), Vector3(0.6, -0.64, 0.48), Vector3(-0.5, 0.5, std::sqrt(0.5))}) {
    Model model;
    model.step = step_settings(1.0 / 240.0, 50);
    BodyDef spinning = test::lump("spinning", Vector3::Zero(), 1.0);
    spinning.inertia = Vector3(inertia, inertia, inertia);
    spinning.angular_velocity = 5.0 * way;
    BodyDef puck = test::lump("puck", {3.0, 0.0, 0.0}, sledge_mass);
    puck.velocity = 2.0 * Vector3(way.x(), way.y(), 0.0).normalized();
    auto ball = std::make_shared<BallJoint>();
    ball->name = "ball";
    ball->body_b = model.add(spinning);
    ball->friction = 0.3;
    auto plane = std::make_shared<PlaneJoint>();
    plane->name = "plane";
    plane->body_b = model.add(puck);
    plane->anchor = puck.position;
    plane->friction = 1.5;
    model.joints = {ball, plane};
    World world = test::start(model);
    test::run(world, 0.5);
    EXPECT_LT((world.angular_velocity({0}) - (5.0 - 0.5 * 0.3 / inertia) * way).norm(), 1e-6);
    EXPECT_LT((world.velocity({1}) - (2.0 - 0.5 * 1.5 / sledge_mass) * 0.5 * puck.velocity).norm(),
              1e-6);
    test::run(world, 4.0);
    EXPECT_LT(world.angular_velocity({0}).norm(), 1e-9);
    EXPECT_LT(world.velocity({1}).norm(), 1e-9);
  }
}

TEST_P(JointCoordinates, SwingStopsAtItsLimit) {
  Model model;
  model.gravity = test::down;
  model.step = step_settings(1.0 / 240.0, 50);
  BodyDef arm = test::lump("arm", {0.5, 0.0, 0.0}, sledge_mass);
  arm.angular_damping = 2.0;
  auto ball = std::make_shared<BallJoint>();
  ball->name = "shoulder";
  ball->body_b = model.add(arm);
  ball->axis = Vector3::UnitX();
  ball->swing_limit = 0.4;
  model.joints = {ball};
  World world = test::start(model);
  test::run(world, 6.0);
  const JointReport report = joint_reports(world)[0];
  EXPECT_NEAR(report.coordinates[1].value, 0.4, 1e-7);
  EXPECT_NEAR(std::atan2(-world.position({0}).y(), world.position({0}).x()), 0.4, 1e-7);
  // The stop bears the torque of the weight.
  EXPECT_NEAR(report.torque.z(), 0.5 * std::cos(0.4) * sledge_mass * test::g, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Combinations, JointCoordinates, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

}  // namespace
}  // namespace sheave
