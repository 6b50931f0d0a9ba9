// Motors on housings that move: what turns the rotor turns its carrier the other way.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/math/turn_between.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

using test::g;
using test::start;

constexpr double spin_inertia = 0.3;     // J of the rotor [kg m2]
constexpr double carrier_inertia = 0.8;  // of the carrier about z [kg m2]
constexpr double rotor_mass = 2.0;

/// A carrier that is free in the plane, with a rotor on it; nothing else acts.
Model floating() {
  Model model;
  model.gravity.setZero();
  BodyDef carrier;
  carrier.name = "carrier";
  carrier.mobility = Mobility::planar;
  carrier.mass = 5.0;
  carrier.inertia = Vector3(0.7, 0.9, carrier_inertia);
  model.bodies.push_back(carrier);
  model.bodies.push_back(
      test::sheave("rotor", BodyId{0}, {0.4, 0.1, 0.0}, 0.2, rotor_mass, spin_inertia));
  return model;
}

/// Moment of inertia of carrier and rotor without the rotor's own spin, about their common centre.
double lumped_inertia() {
  const double reduced = 5.0 * rotor_mass / (5.0 + rotor_mass);
  return carrier_inertia + reduced * (0.4 * 0.4 + 0.1 * 0.1);
}

void drive(BodyDef& body, DriveKind kind, std::vector<double> times, std::vector<double> values,
           Interpolation interpolation = Interpolation::linear) {
  body.drive = kind;
  body.drive_times = std::move(times);
  body.drive_values = std::move(values);
  body.drive_interpolation = interpolation;
}

using MountedDrives = test::ForEveryCombination;

TEST_P(MountedDrives, ATorqueActsOnRotorAndCarrierAlike) {
  Model model = floating();
  model.step = step_settings(0.01, 50);
  drive(model.bodies[1], DriveKind::torque, {}, {0.3});
  World world = start(model);
  test::run(world, 1.0);
  EXPECT_NEAR(world.angular_velocity(BodyId{1}).z(), 0.3 / spin_inertia, 1e-12);
  EXPECT_NEAR(world.angular_velocity(BodyId{0}).z(), -0.3 / lumped_inertia(), 1e-12);
}

// At rest together, so J (W + w) + I W = 0 for ever, with w the speed against the carrier and W the
// carrier's.
TEST_P(MountedDrives, ASpeedIsRelativeToTheCarrier) {
  Model model = floating();
  model.step = step_settings(0.01, 50);
  drive(model.bodies[1], DriveKind::speed, {0.0, 0.5, 1.0}, {0.0, 6.0, 6.0});
  World world = start(model);
  test::run(world, 1.0);
  const double carrier = -spin_inertia * 6.0 / (spin_inertia + lumped_inertia());
  EXPECT_NEAR(world.angular_velocity(BodyId{0}).z(), carrier, 1e-10);
  EXPECT_NEAR(world.angular_velocity(BodyId{1}).z(), carrier + 6.0, 1e-10);
  EXPECT_NEAR(world.state().bodies[1].angle, 4.5, 1e-10) << "turned against the carrier";
}

TEST_P(MountedDrives, AnAngleIsRelativeToTheCarrier) {
  Model model = floating();
  model.step = step_settings(0.01, 50);
  drive(model.bodies[1], DriveKind::angle, {0.0, 1.0}, {5.0, 8.0}, Interpolation::clamped);
  World world = start(model);
  test::run(world, 2.0);
  // Whatever the way there, the carrier has turned by the share of its inertia.
  EXPECT_NEAR(world.state().bodies[1].angle, 3.0, 1e-10);
  EXPECT_NEAR(world.state().bodies[0].angle,
              -3.0 * spin_inertia / (spin_inertia + lumped_inertia()), 1e-10);
  EXPECT_NEAR(world.angular_velocity(BodyId{0}).z(), 0.0, 1e-10);
}

// What is set while the world runs drives it as a table would.
TEST_P(MountedDrives, CanBeSet) {
  for (const DriveKind kind : {DriveKind::speed, DriveKind::angle}) {
    Model model = floating();
    model.step = step_settings(0.01, 50);
    drive(model.bodies[1], kind, {}, {0.0});
    World world = start(model);
    ASSERT_TRUE(world.set_drive(BodyId{1}, {6.0, 0.5}).empty());
    test::run(world, 1.0);
    const double share = spin_inertia / (spin_inertia + lumped_inertia());
    // A ramp to 6 rad/s in half a second and on, or 6 rad.
    const double turned = kind == DriveKind::speed ? 4.5 : 6.0;
    EXPECT_NEAR(world.state().bodies[1].angle, turned, 1e-10);
    EXPECT_NEAR(world.state().bodies[0].angle, -turned * share, 1e-10);
    const double speed = kind == DriveKind::speed ? 6.0 : 0.0;
    EXPECT_NEAR(world.angular_velocity(BodyId{0}).z(), -speed * share, 1e-10);
  }
}

// A slider locks the rotor to its carrier, whichever way it lies: one body that turns under a
// torque on both, which the joint passes on to the rotor. Of the five locks only those about the
// axle have anything to hold.
TEST_P(MountedDrives, AJointBetweenRotorAndCarrierLocksTheAxleAlone) {
  constexpr double torque = 0.3;
  for (const Mobility mobility : {Mobility::planar, Mobility::free}) {
    for (const int first : {0, 1}) {
      Model model = floating();
      model.step = step_settings(0.01, 50);
      model.bodies[0].mobility = mobility;
      model.bodies[0].orientation = rotation_by(0.3 * Vector3::UnitZ());
      model.bodies[0].torque = torque * Vector3::UnitZ();
      auto slider = std::make_shared<SliderJoint>();
      slider->name = "lock";
      slider->body_a = BodyId{first};
      slider->body_b = BodyId{1 - first};
      slider->anchor = {1.3, 0.2, 0.2};
      slider->axis = {-0.66, -0.77, -0.38};
      model.joints = {slider};
      World world = start(model);
      test::run(world, 1.0);
      const double of_carrier = world.angular_velocity(BodyId{0}).z();
      const double of_rotor = world.angular_velocity(BodyId{1}).z();
      EXPECT_NEAR(lumped_inertia() * of_carrier + spin_inertia * of_rotor, torque, 1e-9);
      EXPECT_NEAR(of_carrier, of_rotor, 1e-9);
      // Forces and torques of the locks share the load.
      const JointReport report = joint_reports(world)[0];
      EXPECT_LT(report.torque.norm() + report.force.norm(), 10.0 * torque);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MountedDrives, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

/// Angular momentum about the origin of a free carrier with one mounted rotor.
Vector3 angular_momentum(const World& world) {
  const BodyState& body = world.state().bodies[0];
  const BodyProperties& carrier = world.bodies()[0];
  const BodyProperties& rotor = world.bodies()[1];
  const Vector3 axle = body.orientation * rotor.axis;
  const Vector3 own = body.orientation.conjugate() * body.angular_velocity;
  return body.orientation * Vector3(carrier.inertia * own) +
         rotor.axis_inertia * axle * axle.dot(world.state().bodies[1].angular_velocity) +
         carrier.mass * body.position.cross(body.velocity);
}

/// A tumbling satellite with a flywheel across none of its axes.
Model satellite(DriveKind kind, double h) {
  Model model;
  model.gravity.setZero();
  model.step.dt = h;
  model.step.substeps = 1;
  model.step.iterations = 50;
  model.step.solver = SolverKind::direct;
  model.step.integrator = IntegratorKind::rattle;
  BodyDef body = test::lump("satellite", {0.5, -0.2, 0.1}, 4.0);
  body.velocity = {0.3, 0.1, -0.2};
  body.angular_velocity = {0.4, -1.1, 0.8};
  model.bodies.push_back(body);
  BodyDef wheel = test::sheave("wheel", BodyId{0}, {0.6, 0.0, 0.0}, 0.1, 1.0, 0.02);
  wheel.axis = Vector3(0.6, 0.48, 0.64);
  wheel.orientation = turn_between(Vector3::UnitZ(), *wheel.axis);
  drive(wheel, kind, {0.0, 0.5, 1.0, 2.0}, {0.0, 20.0, 5.0, -30.0}, Interpolation::cubic);
  if (kind == DriveKind::torque) wheel.drive_values = {0.0, 0.6, -0.4, 0.1};
  model.bodies.push_back(wheel);
  return model;
}

TEST(MountedDrive, KeepsTheAngularMomentumOfCarrierAndRotor) {
  for (const DriveKind kind : {DriveKind::speed, DriveKind::angle, DriveKind::torque}) {
    World world = start(satellite(kind, 0.005));
    const Vector3 before = angular_momentum(world);
    double changed = 0.0;
    const Vector3 spin = world.angular_velocity(BodyId{0});
    for (int i = 0; i < 400; ++i) {
      ASSERT_TRUE(world.step().ok());
      changed = std::max(changed, (angular_momentum(world) - before).norm());
    }
    // Rounding of 400 steps beside the 1.5 kg m2/s that rotor and carrier exchange.
    EXPECT_LT(changed, 1e-12) << drive_names[static_cast<std::size_t>(kind)];
    EXPECT_GT((world.angular_velocity(BodyId{0}) - spin).norm(), 0.1) << "the carrier feels it";
  }
}

/// A pendulum of 1 kg, 0.5 m long, that swings from 60 degrees with a rotor in its bob, which turns
/// by 3 s^2 - 2 s^3 times 4 rad in a second. Its angle at time 1.
double swung_angle(double h) {
  Model model;
  model.gravity = test::down;
  model.step.dt = h;
  model.step.substeps = 1;
  model.step.iterations = 50;
  model.step.solver = SolverKind::direct;
  model.step.integrator = IntegratorKind::rattle;
  const Vector3 bob(0.5 * std::sin(pi / 3.0), -0.5 * std::cos(pi / 3.0), 0.0);
  BodyDef carrier;
  carrier.name = "arm";
  carrier.mobility = Mobility::planar;
  carrier.position = bob;
  carrier.mass = 1.0;
  carrier.inertia = Vector3(0.02, 0.02, 0.02);
  model.bodies.push_back(carrier);
  BodyDef rotor = test::sheave("rotor", BodyId{0}, bob, 0.1, 1.0, 0.05);
  drive(rotor, DriveKind::angle, {0.0, 1.0}, {0.0, 4.0}, Interpolation::clamped);
  model.bodies.push_back(rotor);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "pivot";
  hinge->body_b = BodyId{0};
  hinge->anchor = Vector3::Zero();
  hinge->axis = Vector3::UnitZ();
  model.joints.push_back(hinge);
  World world = start(model);
  test::run(world, 1.0);
  return world.state().bodies[0].angle;
}

/// The same from (I + J) p'' = -M g l sin p - J c'', by Runge-Kutta.
double integrated_angle() {
  const double inertia = 0.02 + 2.0 * 0.25 + 0.05;
  const auto acceleration = [&](double t, double p) {
    return (-2.0 * g * 0.5 * std::sin(p) - 0.05 * 4.0 * (6.0 - 12.0 * t)) / inertia;
  };
  double p = pi / 3.0;
  double v = 0.0;
  const int steps = 20000;
  const double h = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const double a1 = acceleration(t, p);
    const double a2 = acceleration(t + 0.5 * h, p + 0.5 * h * v);
    const double a3 = acceleration(t + 0.5 * h, p + 0.5 * h * (v + 0.5 * h * a1));
    const double a4 = acceleration(t + h, p + h * (v + 0.5 * h * a2));
    p += h * v + h * h / 6.0 * (a1 + a2 + a3);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return p - pi / 3.0;
}

TEST(MountedDrive, OfACarrierThatSwingsConvergesToItsEquationOfMotion) {
  const double exact = integrated_angle();
  const double coarse = swung_angle(0.01) - exact;
  const double fine = swung_angle(0.005) - exact;
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2.0, 0.1);
  EXPECT_LT(std::abs(fine), 2e-4);
}

TEST(MountedDrive, PassesTheChecksOfARun) {
  for (const DriveKind kind : {DriveKind::speed, DriveKind::angle, DriveKind::torque}) {
    test::Machine machine;
    machine.model = satellite(kind, 0.002);
    Simulation simulation = start(machine);
    Certificate all;
    for (int i = 0; i < 500; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      all.merge(simulation.certificate().value());
    }
    EXPECT_TRUE(all.clean(1e-6)) << all.worst()->sentence();
  }
}

TEST(MountedDrive, OfAMasslessWheelIsRefused) {
  Model model = floating();
  model.bodies[1].spin_inertia = 0.0;
  drive(model.bodies[1], DriveKind::speed, {}, {1.0});
  const Result<World> world = World::create(model);
  ASSERT_FALSE(world);
  EXPECT_EQ(world.errors()[0].path, "/bodies/1/drive");
  EXPECT_THAT(world.errors()[0].message, testing::HasSubstr("give it a spin inertia"));
}

}  // namespace
}  // namespace sheave
