// What is set while a world runs, against models that have the same from the start, and against
// closed forms.

#include "engine/controls.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::down;
using test::g;
using test::right;
using test::roll;

constexpr std::array both{IntegratorKind::xpbd, IntegratorKind::rattle};

void advance(World& world, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step().ok());
}

/// Whether two worlds are in the same place to the last bit, whatever is set in them.
bool same_motion(const State& a, const State& b) {
  State first = a;
  State second = b;
  first.controls = second.controls = {};
  return hash(first) == hash(second);
}

TEST(ControlsForce, EqualsABodyWithThatConstantForce) {
  for (const IntegratorKind integrator : both) {
    Model model;
    model.step = test::direct_settings(integrator, 0.01, 2);
    BodyDef lump = test::lump("lump", Vector3::Zero(), 2.0);
    lump.angular_velocity = {1.0, 2.0, 3.0};
    Model pushed = model;
    model.add(lump);
    lump.force = {1.0, -2.0, 0.5};
    lump.torque = {0.01, 0.02, -0.03};
    pushed.add(lump);
    World a = test::start(model);
    World b = test::start(pushed);
    ASSERT_TRUE(a.set_force({0}, {lump.force, lump.torque, {}, ForceFrame::world}).empty());
    advance(a, 50);
    advance(b, 50);
    EXPECT_TRUE(same_motion(a.state(), b.state()));
  }
}

// A flat body, pushed at a point by a force that turns with it: the torque is constant, so the
// angle is t^2 T / 2 J, and the velocity of the centre the integral of F / m in that direction.
TEST(ControlsForce, AtAPointThatTurnsWithTheBody) {
  const double inertia = 0.3;
  const double mass = 2.0;
  const Vector3 force{1.5, 0.5, 0.0};
  const Vector3 point{0.1, 0.4, 0.0};
  const double torque = point.x() * force.y() - point.y() * force.x();
  const auto angle = [&](double t) { return 0.5 * torque / inertia * t * t; };
  Vector3 velocity = Vector3::Zero();
  constexpr int parts = 10000;
  for (int i = 0; i < parts; ++i) {
    const double a = angle((i + 0.5) / parts);
    velocity += rotated(rotation_by({0.0, 0.0, a}), force) / mass / parts;
  }
  std::array<double, 2> errors{};
  for (const int k : {0, 1}) {
    Model model;
    model.step = test::direct_settings(IntegratorKind::rattle, k == 0 ? 0.01 : 0.005);
    BodyDef body;
    body.name = "plate";
    body.mobility = Mobility::planar;
    body.mass = mass;
    body.inertia = Vector3::Constant(inertia);
    model.add(body);
    World world = test::start(model);
    ASSERT_TRUE(world.set_force({0}, {force, Vector3::Zero(), point, ForceFrame::body}).empty());
    double work = 0.0;
    for (int i = 0; i < (k == 0 ? 100 : 200); ++i) {
      work += world.step().statistics.external_work;
    }
    EXPECT_NEAR(world.state().bodies[0].angle, angle(1.0), 1e-12);
    errors[static_cast<std::size_t>(k)] = (world.velocity({0}) - velocity).norm();
    // What it does is all the energy that there is: both by rules of second order.
    EXPECT_NEAR(work, world.energy().kinetic, 1e-4 * world.energy().kinetic);
  }
  EXPECT_LT(errors[0], 1e-4);
  // Of second order.
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.4);
}

// On a rotor whose axle a free block carries: the block gets the force and all of the torque but
// what spins the rotor.
TEST(ControlsForce, OnAMountedRotorMovesItsCarrier) {
  Model model;
  model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
  BodyDef block = test::lump("block", Vector3::Zero(), 4.0);
  const BodyId carrier = model.add(block);
  const BodyId rotor = model.add(test::sheave("rotor", carrier, {0.0, 0.0, 0.0}, 0.2, 1.0, 0.02));
  World world = test::start(model);
  const Vector3 force{3.0, 0.0, 0.0};
  ASSERT_TRUE(world.set_force(rotor, {.force = force, .point = Vector3{0.0, 0.2, 0.0}}).empty());
  advance(world, 10);
  const double t = 0.01;
  // Together they weigh 5 kg; about the axle, z, the rotor alone is turned, by -0.2 m x 3 N.
  EXPECT_NEAR(world.velocity(carrier).x(), 3.0 / 5.0 * t, 1e-9);
  EXPECT_NEAR(world.angular_velocity(rotor).z(), -0.6 / 0.02 * t, 1e-3 * 0.6 / 0.02 * t);
  EXPECT_NEAR(world.angular_velocity(carrier).z(), 0.0, 1e-12);
}

TEST(ControlsGravity, EqualsAModelWithThatGravity) {
  for (const IntegratorKind integrator : both) {
    test::Tackle tackle;
    tackle.strands = 4;
    test::Machine machine = tackle.machine();
    machine.model.step = test::direct_settings(integrator, 0.01, 2);
    Simulation a = test::start(machine);
    advance(a.world, 20);
    machine.model.gravity = {0.5, -3.0, 0.2};
    Simulation b = test::start(machine);
    ASSERT_TRUE(b.world.restore(a.world.state()).empty());
    ASSERT_TRUE(a.world.set_gravity(machine.model.gravity).empty());
    advance(a.world, 20);
    advance(b.world, 20);
    EXPECT_TRUE(same_motion(a.world.state(), b.world.state()));
    EXPECT_EQ(a.world.energy().total(), b.world.energy().total());
  }
}

/// A drum with a drive that lifts a weight.
test::Machine winch(DriveKind kind, std::vector<double> times, std::vector<double> values) {
  test::Machine machine;
  machine.model.gravity = down;
  BodyDef drum = test::wheel("drum", {0.0, 4.0, 0.0}, 0.25, 0.05);
  drum.drive = kind;
  drum.drive_times = std::move(times);
  drum.drive_values = std::move(values);
  const BodyId on = machine.model.add(drum);
  const BodyId load = machine.model.add(test::weight("load", {0.25, 0.0, 0.0}, 3.0));
  machine.cables.push_back(cable("rope", {roll(on, right), attach(load)}));
  auto spool = std::make_shared<RollingLink>();
  spool->body = on;
  spool->winding = right;
  spool->stored_length = 5.0;
  machine.cables[0].links[0] = spool;
  return machine;
}

TEST(ControlsDrive, AJumpEqualsAModelWithThatDrive) {
  for (const IntegratorKind integrator : both) {
    for (const auto& [kind, value] : {std::pair{DriveKind::speed, 1.0}, {DriveKind::torque, 9.0}}) {
      test::Machine machine = winch(kind, {}, {0.0});
      machine.model.step = test::direct_settings(integrator, 0.01, 2);
      Simulation a = test::start(machine);
      machine.model.bodies[0].drive_values = {value};
      Simulation b = test::start(machine);
      ASSERT_TRUE(a.world.set_drive({0}, {value, 0.0}).empty());
      advance(a.world, 30);
      advance(b.world, 30);
      if (kind == DriveKind::speed) {
        EXPECT_TRUE(same_motion(a.world.state(), b.world.state()));
      }
      // The integral of a torque over a substep is rounded in another order.
      EXPECT_NEAR(a.world.position({1}).y(), b.world.position({1}).y(), 1e-14);
      EXPECT_NEAR(a.world.velocity({1}).y(), b.world.velocity({1}).y(), 1e-13);
    }
  }
}

TEST(ControlsDrive, ARampEqualsATable) {
  for (const IntegratorKind integrator : both) {
    for (const DriveKind kind : {DriveKind::speed, DriveKind::angle, DriveKind::torque}) {
      const double lift = kind == DriveKind::torque ? 9.0 : 1.0;
      const double start = kind == DriveKind::torque ? 6.0 : 0.0;
      test::Machine machine = winch(kind, {}, {start});
      machine.model.step = test::direct_settings(integrator, 0.01, 2);
      Simulation a = test::start(machine);
      machine.model.bodies[0].drive_times = {0.0, 0.25};
      machine.model.bodies[0].drive_values = {start, lift};
      Simulation b = test::start(machine);
      ASSERT_TRUE(a.world.set_drive({0}, {lift, 0.25}).empty());
      double tension = 0.0;
      for (int i = 0; i < 20; ++i) {
        advance(a.world, 1);
        advance(b.world, 1);
        // The same functions of time, but for rounding.
        ASSERT_NEAR(a.world.position({1}).y(), b.world.position({1}).y(), 1e-12);
        ASSERT_NEAR(a.world.velocity({1}).y(), b.world.velocity({1}).y(), 1e-10);
        tension = a.cable_reports()[0].spans[0].tension;
        ASSERT_NEAR(tension, b.cable_reports()[0].spans[0].tension, 1e-7 * tension);
      }
      EXPECT_GT(tension, 1.0);
    }
  }
}

// A crane operator who asks for more speed every frame: with the speed's way there the load feels
// the acceleration, m (g + a), at every substep, and no blows.
TEST(ControlsDrive, ASpeedThatIsSetEveryStepIsAnAcceleration) {
  test::Machine machine = winch(DriveKind::speed, {}, {0.0});
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  Simulation s = test::start(machine);
  for (int i = 1; i <= 30; ++i) {
    ASSERT_TRUE(s.world.set_drive({0}, 2.0 * i / 60.0).empty());
    ASSERT_TRUE(s.world
                    .step({},
                          [&] {
                            if (s.world.state().time == 0.0) return;
                            const double tension = s.cable_reports()[0].spans[0].tension;
                            EXPECT_NEAR(tension, 3.0 * (g + 0.25 * 2.0), 1e-6);
                          })
                    .ok());
  }
  EXPECT_NEAR(s.world.velocity({1}).y(), 0.25, 1e-9);
}

TEST(ControlsDrive, AClearedDriveFollowsItsTableAgain) {
  test::Machine machine = winch(DriveKind::speed, {}, {0.5});
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  Simulation s = test::start(machine);
  ASSERT_TRUE(s.world.set_drive({0}, {1.0, 0.0}).empty());
  advance(s.world, 5);
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), 1.0, 1e-15);
  ASSERT_TRUE(s.world.clear_drive({0}).empty());
  EXPECT_TRUE(s.world.state().controls.empty());
  advance(s.world, 5);
  EXPECT_NEAR(s.world.angular_velocity({0}).z(), 0.5, 1e-15);
}

/// A bar on a hinge with a drive.
Model driven_bar(CoordinateDrive drive, std::vector<double> times, std::vector<double> values) {
  Model model;
  model.gravity = down;
  const BodyId bar = model.add(test::lump("bar", {0.5, 0.0, 0.0}, 2.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = bar;
  hinge->axis = Vector3::UnitZ();
  hinge->angle.drive = drive;
  hinge->angle.drive_times = std::move(times);
  hinge->angle.drive_values = std::move(values);
  model.joints.push_back(hinge);
  return model;
}

TEST(ControlsJointDrive, ARampEqualsATable) {
  for (const IntegratorKind integrator : both) {
    for (const CoordinateDrive kind :
         {CoordinateDrive::position, CoordinateDrive::speed, CoordinateDrive::force}) {
      const double goal = kind == CoordinateDrive::force ? 12.0 : 0.8;
      Model model = driven_bar(kind, {}, {0.0});
      model.step = test::direct_settings(integrator, 0.01, 2);
      World a = test::start(model);
      model.joints = driven_bar(kind, {0.0, 0.3}, {0.0, goal}).joints;
      World b = test::start(model);
      ASSERT_TRUE(a.set_joint_drive(0, 0, {goal, 0.3}).empty());
      for (int i = 0; i < 40; ++i) {
        advance(a, 1);
        advance(b, 1);
        const JointReport one = joint_reports(a)[0];
        const JointReport other = joint_reports(b)[0];
        ASSERT_NEAR(one.coordinates[0].value, other.coordinates[0].value, 1e-11);
        ASSERT_NEAR(one.coordinates[0].drive_force, other.coordinates[0].drive_force, 1e-6);
        ASSERT_NEAR(one.coordinates[0].drive_target, other.coordinates[0].drive_target, 1e-12);
      }
    }
  }
}

// The drive may have 5 N m; it takes 2 kg x 9.81 x 0.5 m = 9.81 N m to hold the bar up. It sinks
// with the rest.
TEST(ControlsJointDrive, StallsAtALimitThatIsSet) {
  Model model = driven_bar(CoordinateDrive::speed, {}, {0.0});
  model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
  World world = test::start(model);
  advance(world, 10);
  EXPECT_NEAR(joint_reports(world)[0].coordinates[0].drive_force, 9.81, 1e-6);
  ASSERT_TRUE(world.set_joint_drive_limit(0, 0, 5.0).empty());
  advance(world, 10);
  const JointReport report = joint_reports(world)[0];
  EXPECT_NEAR(report.coordinates[0].drive_force, 5.0, 1e-9);
  // About the hinge the lump has its own moment of inertia and m r^2.
  const double inertia = world.bodies()[0].inertia(2, 2) + 2.0 * 0.25;
  EXPECT_NEAR(report.coordinates[0].rate, -(9.81 - 5.0) / inertia * 0.01, 1e-4);
  ASSERT_TRUE(world.clear_joint_drive(0, 0).empty());
  EXPECT_TRUE(world.state().controls.empty());
}

}  // namespace
}  // namespace sheave
