// What bearings bear, drives do and friction takes, and momentum: against closed forms.

#include "cable/reactions.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/math/turn_between.h"
#include "engine/shapes/box.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

using test::g;
using test::start;

using ReactionsOf = test::ForEveryCombination;

Simulation run_to(const test::Machine& machine, double time) {
  Simulation simulation = start(machine);
  test::run(simulation.world, time);
  return simulation;
}

TEST(Reactions, ExistAfterAStep) {
  Simulation simulation = start(test::Atwood{}.machine());
  EXPECT_FALSE(Reactions::of(simulation));
  ASSERT_TRUE(simulation.world.step().ok());
  EXPECT_TRUE(Reactions::of(simulation));
  const State state = simulation.world.state();
  ASSERT_TRUE(simulation.world.restore(state).empty());
  EXPECT_FALSE(Reactions::of(simulation));
}

// The axle carries the wheel and both tensions.
TEST_P(ReactionsOf, TheAxleOfAtwoodsMachine) {
  const test::Atwood atwood;
  test::Machine machine = atwood.machine();
  machine.model.step = step_settings(0.01, 100);
  const Simulation simulation = run_to(machine, 0.5);
  const double a = atwood.acceleration();
  const BearingReaction bearing = Reactions::of(simulation)->bearing(0);
  const double tensions = atwood.m1 * (g + a) + atwood.m2 * (g - a);
  // Positions of 2 m are known to 4e-16 m; that over h^2 = 1e-4 s2, times 3 kg, and some
  // operations.
  EXPECT_NEAR(bearing.force.y(), tensions + 1.0 * g, 1e-9);
  EXPECT_NEAR(bearing.force.x(), 0.0, 1e-9);
  EXPECT_NEAR(bearing.torque.norm(), 0.0, 1e-9);
}

// A sheave in a block that rises with the acceleration a hangs from the rope's two strands and
// carries the rest of the block.
TEST_P(ReactionsOf, TheAxleOfASheaveInAMovingBlock) {
  const test::Tackle tackle;
  test::Machine machine = tackle.machine();
  machine.model.step = step_settings(0.01, 200);
  Simulation simulation = run_to(machine, 0.3);
  const double a = tackle.acceleration();
  const std::vector<SpanReport> spans = simulation.cable_reports()[0].spans;
  const BearingReaction bearing = Reactions::of(simulation)->bearing(2);
  const double sheave_mass = tackle.sheave_mass;
  EXPECT_NEAR(bearing.force.y(), sheave_mass * (g + a) - spans[0].tension - spans[1].tension, 1e-8);
  EXPECT_NEAR(bearing.force.y(), -(tackle.load - sheave_mass) * (g + a), 1e-7)
      << "what hangs on the axle";
}

// A wheel with the spin s on an arm that turns at W about an axis across its axle: its momentum J s
// turns, too.
TEST_P(ReactionsOf, AGyroscopesAxle) {
  test::Machine machine;
  machine.model.gravity.setZero();
  constexpr double h = 1e-3;
  machine.model.step = step_settings(h, 10);
  BodyDef arm;
  arm.name = "arm";
  arm.mobility = Mobility::kinematic;
  arm.angular_velocity = {0.0, 2.0, 0.0};
  machine.model.add(arm);
  BodyDef wheel = test::sheave("wheel", BodyId{0}, {0.5, 0.0, 0.0}, 0.1, 3.0, 0.04);
  wheel.axis = Vector3::UnitX();
  wheel.orientation = turn_between(Vector3::UnitZ(), Vector3::UnitX());
  wheel.angular_velocity = {30.0, 0.0, 0.0};
  machine.model.add(wheel);
  const Simulation simulation = run_to(machine, 0.2);
  const BearingReaction bearing = Reactions::of(simulation)->bearing(1);
  // A chord for its arc: (2 h)^2 / 24, relatively.
  EXPECT_NEAR(bearing.torque.norm(), 0.04 * 30.0 * 2.0, 1e-6);
  EXPECT_NEAR(bearing.force.norm(), 3.0 * 2.0 * 2.0 * 0.5, 1e-5);
  // dL/dt = W x L, in the middle of the substep.
  const double angle = 2.0 * (0.2 - 0.5 * h);
  const Vector3 axle(std::cos(angle), 0.0, -std::sin(angle));
  EXPECT_NEAR((bearing.torque - 2.4 * Vector3::UnitY().cross(axle)).norm(), 0.0, 1e-5);
}

/// A winch that lifts 5 kg with 0.5 m/s2, by a speed or an angle.
test::Machine winch(DriveKind kind) {
  test::Machine machine;
  machine.model.gravity = test::down;
  BodyDef drum = test::wheel("drum", Vector3::Zero(), 0.2, 0.3);
  drum.drive = kind;
  drum.drive_times = {0.0, 0.5, 1.0};
  drum.drive_values = {0.0, -1.25, -2.5};
  if (kind == DriveKind::angle) drum.drive_values = {0.0, -0.3125, -1.25};
  drum.drive_interpolation = Interpolation::cubic;  // parabolas are what they are
  drum.angular_damping = 0.04;
  machine.model.add(drum);
  const BodyId load = machine.model.add(test::weight("load", {-0.2, -3.0, 0.0}, 5.0));
  auto spool = std::make_shared<SpoolLink>();
  spool->body = BodyId{0};
  spool->winding = test::left;
  spool->stored_length = 1.0;
  machine.cables.push_back(test::cable("rope", {spool, test::attach(load)}));
  return machine;
}

TEST_P(ReactionsOf, TheDriveOfAWinch) {
  for (const DriveKind kind : {DriveKind::speed, DriveKind::angle}) {
    test::Machine machine = winch(kind);
    machine.model.step = step_settings(0.01, 100);
    const Simulation simulation = run_to(machine, 0.8);
    const DriveReaction drive = Reactions::of(simulation)->drive(0);
    const double middle = 2.5 * (0.8 - 0.005);  // speed in the middle of the step [rad/s]
    const double torque = 0.3 * 2.5 + 5.0 * (g + 0.5) * 0.2 + 0.04 * middle;
    EXPECT_NEAR(drive.torque, -torque, 1e-8) << drive_names[static_cast<std::size_t>(kind)];
    EXPECT_NEAR(drive.power, torque * middle, 1e-8);
    EXPECT_NEAR(Reactions::of(simulation)->drive_power(), torque * middle, 1e-8);
    EXPECT_NEAR(drive.error, 0.0, 1e-12);
  }
}

// A drum that the load has come up to: the drive stalls, and lags behind by what it has not turned.
TEST(Reactions, ReportTheErrorOfAStalledDrive) {
  test::Machine machine = winch(DriveKind::angle);
  machine.model.step.integrator = IntegratorKind::xpbd;
  machine.model.bodies[0].drive_times = {0.0, 2.0};
  machine.model.bodies[0].drive_interpolation = Interpolation::linear;
  for (const double turn :
       {20.0, -20.0}) {  // against the clock the drum pays out, with it it winds up 3 m by 15 rad
    machine.model.bodies[0].drive_values = {0.0, turn};
    Simulation simulation = start(machine);
    test::run(simulation.world, 1.9);
    const DriveReaction drive = Reactions::of(simulation)->drive(0);
    const double turned = simulation.world.state().bodies[0].angle;
    EXPECT_NEAR(drive.error, turned - turn * 0.95, 1e-12);
    if (turn < 0.0) {
      EXPECT_GT(drive.error, 3.0);
    }
  }
}

TEST_P(ReactionsOf, ADriveOnACarrier) {
  test::Machine machine;
  machine.model.gravity.setZero();
  machine.model.step = step_settings(0.01, 50);
  BodyDef carrier = test::lump("carrier", Vector3::Zero(), 2.0);
  carrier.mobility = Mobility::planar;
  machine.model.add(carrier);
  BodyDef rotor = test::sheave("rotor", BodyId{0}, Vector3::Zero(), 0.1, 1.0, 0.05);
  rotor.drive = DriveKind::torque;
  rotor.drive_values = {0.3};
  machine.model.add(rotor);
  const Simulation simulation = run_to(machine, 1.0);
  const DriveReaction drive = Reactions::of(simulation)->drive(1);
  EXPECT_NEAR(drive.torque, 0.3, 1e-12);
  // The carrier's inertia has that of the rotor across the axle, but none of its spin.
  const double against = 0.3 * (1.0 / 0.05 + 1.0 / (2.0 * 0.12));  // [rad/s2]
  // `xpbd` turns by the speed at the end of each step, `rattle` by that in the middle.
  const double time = GetParam().rattle() ? 0.995 : 1.0;
  EXPECT_NEAR(drive.power, 0.3 * against * time, 1e-10);
  const Momentum all = momentum(simulation.world);
  EXPECT_NEAR(all.angular.norm(), 0.0, 1e-12);
  EXPECT_NEAR(momentum(simulation.world, 1).angular.z(), 0.3, 1e-12) << "N m for a second";
}

// A block on a rail with dry friction F comes to rest; F has then done the work of its kinetic
// energy.
TEST_P(ReactionsOf, TheDryFrictionOfARail) {
  test::Machine machine;
  machine.model.gravity.setZero();
  constexpr double h = 0.01;
  machine.model.step = step_settings(h, 50);
  BodyDef block = test::lump("block", Vector3::Zero(), 2.0);
  block.velocity = {1.5, 0.0, 0.0};
  machine.model.add(block);
  auto rail = std::make_shared<SliderJoint>();
  rail->name = "rail";
  rail->body_b = BodyId{0};
  rail->axis = Vector3::UnitX();
  rail->travel.friction = 4.0;
  machine.model.joints.push_back(rail);
  Simulation simulation = start(machine);
  double work = 0.0;
  while (simulation.world.state().time < 1.0) {
    ASSERT_TRUE(simulation.world.step().ok());
    const Reactions reactions = std::move(*Reactions::of(simulation));
    EXPECT_NEAR(reactions.friction(), reactions.joint_friction(0), 1e-12);
    if (std::abs(simulation.world.state().time - 0.5) < 0.5 * h) {
      const double way = 1.5 - 2.0 * (GetParam().rattle() ? 0.495 : 0.5);
      EXPECT_NEAR(reactions.joint_friction(0), 4.0 * way, 1e-8);
    }
    work += h * reactions.joint_friction(0);
  }
  // `xpbd` stops 1.5 m/s h / 2 early.
  EXPECT_NEAR(work, 0.5 * 2.0 * 1.5 * 1.5, GetParam().rattle() ? 1e-3 : 4.0 * 1.5 * 0.5 * h * 1.01);
}

// A rope that slides over a fixed post: 1 kg against 8 kg, half a turn, e^(0.1 pi) = 1.3691.
TEST_P(ReactionsOf, TheFrictionOfARopeThatSlides) {
  test::Atwood atwood;
  atwood.m2 = 4.0;
  test::Machine machine = atwood.machine();
  machine.model.step = step_settings(0.01, 100);
  machine.model.bodies[0].mobility = Mobility::fixed;
  auto post = test::roll(BodyId{0}, test::right);
  post->friction = 0.1;
  machine.cables[0].links[1] = post;
  const Simulation simulation = run_to(machine, 0.3);
  const Reactions reactions = std::move(*Reactions::of(simulation));
  const double ratio = std::exp(0.1 * pi);
  const double a = (4.0 - ratio * 1.0) * g / (4.0 + ratio * 1.0);
  const double low = 1.0 * (g + a);
  const double speed = a * (GetParam().rattle() ? 0.295 : 0.3);
  EXPECT_NEAR(reactions.link_friction(0, 1), (ratio - 1.0) * low * speed, 1e-6);
  EXPECT_NEAR(reactions.friction(), (ratio - 1.0) * low * speed, 1e-6);
  EXPECT_EQ(reactions.link_friction(0, 0), 0.0);
}

TEST_P(ReactionsOf, TheDriveOfAHinge) {
  test::Machine machine;
  machine.model.gravity.setZero();
  machine.model.step = step_settings(0.01, 50);
  machine.model.add(test::lump("arm", Vector3::Zero(), 2.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "motor";
  hinge->body_b = BodyId{0};
  hinge->axis = Vector3::UnitZ();
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_times = {0.0, 1.0};
  hinge->angle.drive_values = {0.0, 3.0};
  machine.model.joints.push_back(hinge);
  const Simulation simulation = run_to(machine, 0.5);
  const double torque = 2.0 * 0.12 * 3.0;
  EXPECT_NEAR(Reactions::of(simulation)->drive_power(0, 0), torque * 3.0 * 0.495, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(All, ReactionsOf, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

// A box slides over the floor: friction times speed.
TEST(Reactions, ReportTheFrictionOfContacts) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = 0.01;
  machine.model.step.substeps = 1;
  machine.model.step.integrator = IntegratorKind::xpbd;
  BodyDef floor;
  floor.name = "floor";
  floor.mobility = Mobility::fixed;
  auto slab = std::make_shared<Box>();
  slab->size = Vector3(20.0, 1.0, 20.0);
  floor.shapes.push_back({slab});
  floor.position = {0.0, -0.5, 0.0};
  machine.model.add(floor);
  BodyDef box = test::lump("box", {0.0, 0.15, 0.0}, 2.0);
  box.velocity = {3.0, 0.0, 0.0};
  machine.model.add(box);
  for (const int body : {0, 1}) {
    ColliderDef collider;
    collider.body = BodyId{body};
    collider.friction = 0.2;
    machine.model.colliders.push_back(collider);
  }
  const Simulation simulation = run_to(machine, 0.5);
  const double slow = simulation.world.velocity(BodyId{1}).x();
  // The friction of a pair is the geometric mean of both, 0.2; xpbd moves by the speed at the end.
  EXPECT_NEAR(slow, 3.0 - 0.2 * g * 0.5, 1e-6);
  EXPECT_NEAR(Reactions::of(simulation)->friction(), 0.2 * 2.0 * g * slow, 1e-5);
}

TEST(Momentum, OfABodyThatFlies) {
  test::Machine machine;
  machine.model.gravity = test::down;
  BodyDef body = test::lump("body", {1.0, 2.0, 3.0}, 2.0);
  body.velocity = {0.5, 1.0, -1.0};
  body.angular_velocity = {0.0, 0.0, 2.0};  // about a principal axis
  machine.model.add(body);
  const Simulation simulation = run_to(machine, 0.5);
  const Momentum own = momentum(simulation.world, 0);
  const Vector3 p = 2.0 * (body.velocity + 0.5 * test::down);
  EXPECT_NEAR((own.linear - p).norm(), 0.0, 1e-12);
  EXPECT_NEAR((own.angular - Vector3(0.0, 0.0, 2.0 * 0.12 * 2.0)).norm(), 0.0, 1e-12);
  const Momentum all = momentum(simulation.world);
  const Vector3 at_end = body.position + 0.5 * body.velocity + 0.125 * test::down;
  // The standard settings are of second order, and exact for parabolas.
  EXPECT_NEAR((all.angular - own.angular - at_end.cross(p)).norm(), 0.0, 1e-11);
}

}  // namespace
}  // namespace sheave
