// Joints and drives that contradict each other: they compromise, make no energy, and reports tell
// by how much they are off.
//
// With `direct` (and `rattle`, which leaves such substeps to it) rows give way so that the sum of
// r^2 / w is least, with their errors r and yields w (engine/solvers/active_set.h), within 1e-6.
// Gauss-Seidel ends with the row that it visits last.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/attachment.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/simulation.h"
#include "engine/joint_report.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave {
namespace {

class Contradiction : public test::ForEveryCombination {
 protected:
  static bool direct() { return GetParam().solver == SolverKind::direct; }
  static constexpr double h = 1.0 / 480.0;
};

std::shared_ptr<HingeJoint> hinge(std::string name, BodyId a, BodyId b, const Vector3& anchor) {
  auto joint = std::make_shared<HingeJoint>();
  joint->name = std::move(name);
  joint->body_a = a;
  joint->body_b = b;
  joint->anchor = anchor;
  joint->axis = Vector3::UnitZ();
  return joint;
}

void drive(HingeJoint& joint, CoordinateDrive kind, double value, double time = 0.0) {
  joint.angle.drive = kind;
  joint.angle.drive_values = {value};
  if (time > 0.0) {
    joint.angle.drive_times = {0.0, time};
    joint.angle.drive_values = {0.0, value};
  }
}

/// A bar of 1 m from the origin along x.
BodyDef bar() {
  BodyDef body = test::lump("bar", {0.5, 0.0, 0.0}, 2.0);
  body.inertia = Vector3(0.01, 0.2, 0.2);
  return body;
}

TEST_P(Contradiction, TwoSpeedsOfOneHingeMeetInTheMiddle) {
  Model model;
  model.step = step_settings(h, 20);
  const BodyId body = model.add(bar());
  auto a = hinge("a", BodyId::world(), body, Vector3::Zero());
  auto b = hinge("b", BodyId::world(), body, Vector3::Zero());
  drive(*a, CoordinateDrive::speed, 2.0);
  drive(*b, CoordinateDrive::speed, -1.0);
  model.joints = {a, b};
  World world = test::start(model);
  // The rows have the same gradient, so both are off by the same.
  test::run(world, 1.0);
  const std::vector<JointReport> reports = joint_reports(world);
  if (direct()) {
    EXPECT_NEAR(world.angular_velocity(body).z(), 0.5, 1e-5);
    EXPECT_NEAR(reports[0].coordinates[0].drive_error, -1.5, 1e-5);
    EXPECT_NEAR(reports[1].coordinates[0].drive_error, 1.5, 1e-5);
    EXPECT_LT(reports[0].error, 1e-6);
  }
  EXPECT_EQ(reports[0].coordinates[0].drive_target, 2.0);
  EXPECT_LE(std::abs(world.angular_velocity(body).z()), 2.0 + 1e-9);
  // Each spoils what the other one does: together they ask for a difference of 3 rad/s.
  EXPECT_NEAR(reports[1].coordinates[0].drive_error - reports[0].coordinates[0].drive_error, 3.0,
              1e-9);
}

TEST_P(Contradiction, ADriveAgainstALockedHingeStallsWithinOneStep) {
  // Two hinges 1 m apart hold the bar. The drive asks for v h = 2/480 rad in each substep, which
  // the locks stop when they are off by as much between them.
  Model model;
  model.gravity = test::down;
  model.step = step_settings(h, 20);
  const BodyId body = model.add(bar());
  auto a = hinge("a", BodyId::world(), body, Vector3::Zero());
  auto b = hinge("b", BodyId::world(), body, Vector3::UnitX());
  drive(*a, CoordinateDrive::speed, 2.0);
  model.joints = {a, b};
  World world = test::start(model);
  const double energy = world.energy().total();
  double most = 0.0;
  for (int i = 0; i < 960; ++i) {
    ASSERT_TRUE(world.step().ok());
    most = std::max(most, world.energy().total() - energy);
  }
  const std::vector<JointReport> reports = joint_reports(world);
  EXPECT_LE(reports[0].error + reports[1].error, 2.0 * h * 1.0 * 1.01);
  EXPECT_GT(reports[0].error + reports[1].error, 0.1 * 2.0 * h);
  // The whole bar at the drive's speed has 1/2 (0.2 + 2 / 4) 2^2 = 1.4 J; a first jerk of
  // Gauss-Seidel may come near that.
  EXPECT_LT(most, 1.4);
  if (direct()) {
    EXPECT_NEAR(reports[0].coordinates[0].drive_error, -2.0, 1e-3);
    EXPECT_LT(world.velocity(body).norm(), 1e-3);
  }
}

TEST_P(Contradiction, HingesToTheWorldAndToABodyThatLeavesShareTheGap) {
  // The far end of the bar is hinged to a body that is led away along it by 0.3 m/s for 1 s. The
  // hinges of the bar are alike as seen from its middle, so each is open by half of it. No gravity:
  // the bar stays on its line.
  Model model;
  model.step = step_settings(h, 20);
  const BodyId body = model.add(bar());
  BodyDef led;
  led.name = "led";
  led.mobility = Mobility::kinematic;
  led.position = Vector3::UnitX();
  led.velocity = {0.3, 0.0, 0.0};
  const BodyId leader = model.add(led);
  model.joints = {hinge("a", BodyId::world(), body, Vector3::Zero()),
                  hinge("b", leader, body, Vector3::UnitX())};
  World world = test::start(model);
  test::run(world, 1.0);
  const std::vector<JointReport> reports = joint_reports(world);
  EXPECT_GE(reports[0].error + reports[1].error, 0.3 - 1e-6);
  if (direct()) {
    EXPECT_NEAR(reports[0].error, 0.15, 1e-5);
    EXPECT_NEAR(reports[1].error, 0.15, 1e-5);
    EXPECT_EQ(reports[0].angle_error, 0.0);
    EXPECT_NEAR(world.velocity(body).x(), 0.15, 1e-5);
    EXPECT_NEAR(world.energy().kinetic, 0.5 * 2.0 * 0.15 * 0.15, 1e-6);
  }
}

TEST_P(Contradiction, TwoDrivesAndAGearThatDoesNotFit) {
  // The wheels shall turn with 2 and 3 rad/s, the gear wants opposite speeds.
  Model model;
  model.step = step_settings(h, 20);
  const BodyId u = model.add(test::lump("u", Vector3::Zero(), 1.0));
  const BodyId v = model.add(test::lump("v", Vector3::UnitX(), 1.0));
  auto a = hinge("a", BodyId::world(), u, Vector3::Zero());
  auto b = hinge("b", BodyId::world(), v, Vector3::UnitX());
  drive(*a, CoordinateDrive::speed, 2.0);
  drive(*b, CoordinateDrive::speed, 3.0);
  auto gear = std::make_shared<GearJoint>();
  gear->name = "gear";
  gear->body_a = u;
  gear->body_b = v;
  gear->ratio = -1.0;
  model.joints = {a, b, gear};
  World world = test::start(model);
  test::run(world, 1.0);
  const std::vector<JointReport> reports = joint_reports(world);
  // Drives ask for 5 rad/s between them that the gear does not have. It counts angles and they do
  // not: so it is off until its error stops them, by no more than they ask for in a substep.
  EXPECT_LE(reports[2].angle_error, 5.0 * h * 1.01);
  for (const BodyId body : {u, v}) EXPECT_LE(world.angular_velocity(body).norm(), 3.0 + 1e-9);
  if (direct()) {
    EXPECT_NEAR(world.angular_velocity(u).z() + world.angular_velocity(v).z(), 0.0, 1e-3);
  }
}

// A rope of 1 m from the world to a body that moves away as it is told lacks v t, whatever is on
// it; slack, or with a body at its other end that can yield, it asks for nothing impossible.
TEST_P(Contradiction, CablesTornByPrescribedMotionAreCounted) {
  if (!direct()) GTEST_SKIP() << "sweeps do not look for contradictions";
  constexpr double speed = 0.5;
  for (const double friction : {0.0, 0.3}) {
    for (const bool yields : {false, true}) {
      for (const double way : {speed, -speed}) {
        Model model;
        model.step = step_settings(h, 20);
        BodyDef led = test::lump("led", Vector3::UnitX(), 1.0);
        led.mobility = Mobility::kinematic;
        led.velocity = {way, 0.0, 0.0};
        const BodyId drawn = model.add(std::move(led));
        const BodyId weight = model.add(test::lump("weight", {3.0, 0.0, 0.0}, 1.0));
        CableDef rope;
        rope.name = "rope";
        const auto eyelet = std::make_shared<PinholeLink>();
        eyelet->body = BodyId::world();
        eyelet->point = {0.5, 0.0, 0.0};
        eyelet->friction = friction;
        const BodyId end = yields ? weight : BodyId::world();
        rope.links = {test::attach(end), eyelet, test::attach(drawn)};
        auto s = Simulation::create(model, {rope});
        ASSERT_TRUE(s.ok());
        const bool torn = way > 0.0 && !yields;
        for (int i = 1; i <= 10; ++i) {
          const StepReport report = s->world.step();
          ASSERT_TRUE(report.ok());
          EXPECT_EQ(report.statistics.impossible, torn ? 1 : 0);
          EXPECT_EQ(report.statistics.unconverged, 0);
          // A sum of some ten lengths of 1 m.
          EXPECT_NEAR(report.statistics.most_impossible, torn ? way * h * i : 0.0, 1e-14);
        }
      }
    }
  }
}

// A drum that turns as it is told winds rope that comes from a dead end over a rough, free wheel:
// the wheel would have to turn one way for either span, and cable that slides over it moves no
// more.
TEST_P(Contradiction, CableDrawnFromADeadEndOverAWheelIsCounted) {
  if (!direct()) GTEST_SKIP() << "counted by the direct solver";
  constexpr double radius = 0.2;
  constexpr double speed = 2.0;
  test::Machine m;
  m.model.step = step_settings(h, 20);
  BodyDef drum = test::wheel("drum", Vector3::Zero(), radius, 0.1);
  drum.mobility = Mobility::kinematic;
  drum.angular_velocity = {0.0, 0.0, speed};
  const BodyId winds = m.model.add(drum);
  const BodyId passes = m.model.add(test::wheel("wheel", {2.0, 0.0, 0.0}, radius, 0.1));
  auto from = test::roll(winds, test::right);
  from->stored_length = 1.0;
  auto over = test::roll(passes, test::right);
  over->friction = 0.3;
  m.cables.push_back(
      test::cable("rope", {from, over, test::attach(BodyId::world(), {2.2, -2.0, 0.0})}));
  Simulation s = test::start(m);
  for (int i = 1; i <= 20; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    EXPECT_GE(report.statistics.impossible, 1) << "once per part";
    EXPECT_NEAR(report.statistics.most_impossible, speed * radius * h * i, 1e-12);
  }
}

TEST(JointErrors, AreTheDistancesOfAnchorsAndAxes) {
  // Before the first step a state may be anything: a hinged body is moved by (3, 4, 0) cm and
  // tilted by 0.1 rad about x.
  Model model;
  const BodyId body = model.add(bar());
  model.joints = {hinge("a", BodyId::world(), body, Vector3::Zero())};
  World world = test::start(model);
  EXPECT_EQ(joint_reports(world)[0].error, 0.0);
  State state = world.state();
  state.bodies[0].position += Vector3(0.03, 0.04, 0.0);
  ASSERT_TRUE(world.restore(state).empty());
  EXPECT_NEAR(joint_reports(world)[0].error, 0.05, 1e-15);
  EXPECT_EQ(joint_reports(world)[0].angle_error, 0.0);
  state = world.state();
  state.bodies[0].orientation = rotation_by({0.1, 0.0, 0.0});
  ASSERT_TRUE(world.restore(state).empty());
  EXPECT_NEAR(joint_reports(world)[0].angle_error, std::sin(0.1), 1e-15);
}

TEST(JointErrors, StopsCountWhereTheyAreOverrunOnly) {
  for (const double turn : {0.3, -0.3}) {
    Model model;
    const BodyId body = model.add(bar());
    auto joint = hinge("a", BodyId::world(), body, Vector3::Zero());
    joint->angle.upper = 0.1;
    model.joints = {joint};
    World world = test::start(model);
    State state = world.state();
    state.bodies[0].orientation = rotation_by({0.0, 0.0, turn});
    state.bodies[0].position = state.bodies[0].orientation * Vector3(0.5, 0.0, 0.0);
    ASSERT_TRUE(world.restore(state).empty());
    const JointReport report = joint_reports(world)[0];
    EXPECT_NEAR(report.angle_error, turn > 0.0 ? 0.2 : 0.0, 1e-15);
    EXPECT_NEAR(report.error, 0.0, 1e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Contradiction, testing::ValuesIn(test::combinations),
                         test::combination_name);

}  // namespace
}  // namespace sheave
