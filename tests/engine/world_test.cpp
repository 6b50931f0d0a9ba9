// The world: stages, divergence, restore.

#include "engine/world.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/body_set.h"
#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/step.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using testing::HasSubstr;

TEST(World, BodiesWithoutShapesHaveAScaleToo) {
  // One point mass that falls: nothing about it is large.
  Model model;
  model.gravity = test::down;
  BodyDef mass = test::lump("mass", {1.0, 2.0, 3.0}, 1.0);
  mass.shapes.clear();
  model.add(mass);
  World world = test::start(model);
  for (int i = 0; i < 60; ++i) {
    const StepReport report = world.step();
    ASSERT_TRUE(report.ok()) << report.divergence->message;
  }
  EXPECT_LT(world.position({0}).y(), 0.0);
}

TEST(World, PendulumOfOnePointMassRuns) {
  test::Machine machine = test::cable_pendulum(1.0, 1.0, 0.5);
  machine.model.bodies[0].shapes.clear();
  Simulation s = test::start(machine);
  const StepReport report = s.world.step();
  EXPECT_TRUE(report.ok()) << report.divergence->message;
}

// A repulsive force without bound: the body leaves the scene by 1e9 sizes.
TEST(Divergence, StopsARunawayAndKeepsTheLastGoodState) {
  Model model;
  model.step = test::settings(0.01, 4, 1);
  model.add(test::lump("quiet", {1.0, 0.0, 0.0}, 1.0));
  BodyDef rocket = test::lump("rocket", Vector3::Zero(), 1.0);
  rocket.force = {1e12, 0.0, 0.0};
  model.add(rocket);
  World world = test::start(model);
  StepReport report;
  int steps = 0;
  while (report.ok() && steps < 10000) {
    report = world.step();
    ++steps;
  }
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.divergence->body, BodyId{1});
  EXPECT_NE(report.divergence->message.find("rocket"), std::string::npos);
  EXPECT_GT(report.divergence->time, world.state().time);
  EXPECT_LE(report.divergence->time, world.state().time + 0.01 / 4 + 1e-12);
  EXPECT_TRUE(world.state().bodies[1].position.allFinite());
  EXPECT_LE(world.state().bodies[1].position.norm(), 1e9 * world.bodies().scale());
  // It stays there, whatever is called.
  const std::uint64_t stopped = hash(world.state());
  EXPECT_FALSE(world.step().ok());
  EXPECT_EQ(hash(world.state()), stopped);
}

TEST(Divergence, StopsAtTheFirstStateThatIsNotFinite) {
  Model model;
  model.add(test::lump("a", {1.0, 0.0, 0.0}, 1.0));
  BodyDef bad = test::lump("b", Vector3::Zero(), 1.0);
  bad.force = {1e308, 1e308, 0.0};
  bad.mass = 1e-100;
  bad.inertia = Vector3(1.0, 1.0, 1.0);
  model.add(bad);
  World world = test::start(model);
  const StepReport report = world.step();
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.divergence->body, BodyId{1});
  EXPECT_EQ(world.state().steps, 0);
  EXPECT_TRUE(world.state().bodies[1].position.allFinite());
}

// The angular velocity of a wheel was a count of turns before anything found it to be none.
TEST(Restore, RefusesNonFiniteNumbersByName) {
  const test::Machine machine = test::Atwood{}.machine();
  Simulation s = test::start(machine);
  ASSERT_TRUE(s.world.step().ok());
  const std::uint64_t before = hash(s.world.state());
  const auto fault_with = [&](const std::function<void(State&)>& damage) {
    State state = s.world.state();
    damage(state);
    const Errors errors = s.world.restore(state);
    EXPECT_EQ(hash(s.world.state()), before);
    return errors.empty() ? std::string() : errors.front().message;
  };
  const std::string name = "body \"" + machine.model.bodies[1].name + "\": its ";
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(fault_with([&](State& x) { x.time = bad; }), HasSubstr("time is not finite"));
    EXPECT_THAT(fault_with([&](State& x) { x.bodies[1].position.x() = bad; }),
                HasSubstr(name + "position is not finite"));
    EXPECT_THAT(fault_with([&](State& x) { x.bodies[1].orientation.w() = bad; }),
                HasSubstr(name + "orientation"));
    EXPECT_THAT(fault_with([&](State& x) { x.bodies[1].velocity.y() = bad; }),
                HasSubstr(name + "velocity"));
    EXPECT_THAT(fault_with([&](State& x) { x.bodies[1].angular_velocity.z() = bad; }),
                HasSubstr(name + "angular velocity"));
    EXPECT_THAT(fault_with([&](State& x) { x.bodies[1].angle = bad; }), HasSubstr(name + "angle"));
    EXPECT_THAT(fault_with([&](State& x) { x.features[0].reals[0] = bad; }),
                HasSubstr("cables: number 0"));
  }
}

// So states that steps leave behind are always taken back.
TEST(WorldStep, EndsWhereTheTimeWouldNotBeFinite) {
  Model model;
  model.step.dt = 1e308;
  World world = test::start(model);
  ASSERT_TRUE(world.step().ok());
  const StepReport report = world.step();
  ASSERT_FALSE(report.ok());
  EXPECT_THAT(report.divergence->message, HasSubstr("time is not finite"));
  EXPECT_TRUE(std::isfinite(world.state().time));
  EXPECT_TRUE(world.restore(world.state()).empty());
}

TEST(Restore, RefusesAForeignState) {
  Simulation atwood = test::start(test::Atwood{}.machine());
  Simulation tackle = test::start(test::Tackle{}.machine());
  Simulation belt = test::start(test::belt(0.2, 0.1, 1.0, 0.1, 0.1));
  const std::uint64_t before = hash(atwood.world.state());
  EXPECT_FALSE(atwood.world.restore(tackle.world.state()).empty());
  EXPECT_FALSE(atwood.world.restore(belt.world.state()).empty());
  EXPECT_FALSE(atwood.world.restore(State{}).empty());
  // As many bodies, but no cable.
  World no_cable = test::start(test::Atwood{}.machine().model);
  EXPECT_FALSE(atwood.world.restore(no_cable.state()).empty());
  EXPECT_EQ(hash(atwood.world.state()), before);
}

std::vector<std::string> stage_names(const World& world) {
  std::vector<std::string> names;
  for (const Stage& stage : world.stages()) names.push_back(stage.name);
  return names;
}
using Names = std::vector<std::string>;

TEST(Stages, AreTwoForAFreeBody) {
  Model model;
  model.step = StepSettings::paper();
  model.add(test::lump("a", Vector3::Zero(), 1.0));
  EXPECT_EQ(stage_names(test::start(model)), (Names{"predict", "derive velocities"}));
}

TEST(Stages, CableAppearsOnlyWithACable) {
  test::Machine machine = test::Atwood{}.machine();
  EXPECT_EQ(stage_names(test::start(machine).world),
            (Names{"begin cables", "predict", "solve by gauss-seidel", "derive velocities",
                   "finish cables"}));
  machine.cables.clear();
  EXPECT_EQ(stage_names(test::start(machine).world), (Names{"predict", "derive velocities"}));
  EXPECT_EQ(test::start(machine).cables, nullptr);
}

TEST(Stages, EachJointTypeAppearsOnlyIfUsed) {
  Model model;
  model.step = StepSettings::paper();
  model.add(test::lump("a", Vector3::Zero(), 1.0));
  auto ball = std::make_shared<BallJoint>();
  ball->name = "ball";
  ball->body_b = {0};
  model.joints.push_back(ball);
  EXPECT_EQ(stage_names(test::start(model)),
            (Names{"begin ball joints", "predict", "solve by gauss-seidel", "derive velocities",
                   "finish ball joints"}));
  auto rod = std::make_shared<DistanceJoint>();
  rod->name = "rod";
  rod->body_b = {0};
  rod->anchor_a = {0.0, 1.0, 0.0};
  model.joints.insert(model.joints.begin(), rod);
  model.ground.emplace();
  EXPECT_EQ(stage_names(test::start(model)),
            (Names{"begin distance joints", "begin ball joints", "begin ground contacts", "predict",
                   "solve by gauss-seidel", "derive velocities", "finish distance joints",
                   "finish ball joints", "finish ground contacts"}));
}

TEST(Stages, SolveVelocitiesWithASymmetricIntegrator) {
  Model model;
  model.add(test::lump("a", Vector3::Zero(), 1.0));
  EXPECT_EQ(
      stage_names(test::start(model)),
      (Names{"keep the start", "predict", "solve positions", "derive velocities",
             "correct gyroscopic velocities", "second half of the loads", "solve velocities"}));
}

TEST(Stages, IncludeThoseOfKinematicAndMountedBodies) {
  Model model;
  model.step = StepSettings::paper();
  BodyDef drive;
  drive.name = "drive";
  drive.mobility = Mobility::kinematic;
  model.add(drive);
  EXPECT_EQ(stage_names(test::start(model)),
            (Names{"move kinematic bodies", "predict", "derive velocities"}));
  model.add(test::sheave("rotor", {0}, Vector3::Zero(), 0.1, 1.0, 0.01));
  EXPECT_EQ(stage_names(test::start(model)), (Names{"move kinematic bodies", "predict",
                                                    "derive velocities", "place mounted rotors"}));
}

TEST(Statistics, CountRowsAndSolves) {
  test::Machine machine = test::Atwood{}.machine();
  machine.model.step = test::settings(0.01, 4, 7);
  Simulation s = test::start(machine);
  const StepReport report = s.world.step();
  EXPECT_EQ(report.statistics.rows, 2);
  EXPECT_EQ(report.statistics.row_solves, 2 * 4 * 7);
  EXPECT_EQ(report.statistics.geometry_fallbacks, 0);
  EXPECT_GE(report.statistics.last_correction, 0.0);
}

}  // namespace
}  // namespace sheave
