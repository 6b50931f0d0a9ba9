#include "cable/live_world.h"

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "engine/joint_report.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/load_world.h"
#include "tests/control/allocation_count.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::allocation_count;
using test::attach;
using test::cable;
using test::g;
using test::right;
using test::roll;

/// A drum (speed) that lifts a load; a bar on a hinge with a drive; two wheels in gear; a hand.
test::Machine workshop() {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = 0.01;
  BodyDef drum = test::wheel("drum", {0.0, 4.0, 0.0}, 0.25, 0.05);
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  const BodyId on = machine.model.add(drum);
  const BodyId load = machine.model.add(test::weight("load", {0.25, 0.0, 0.0}, 3.0));
  const BodyId bar = machine.model.add(test::lump("bar", {4.5, 1.0, 0.0}, 2.0));
  const BodyId one = machine.model.add(test::wheel("one", {6.0, 1.0, 0.0}, 0.1, 0.01));
  const BodyId two = machine.model.add(test::wheel("two", {6.3, 1.0, 0.0}, 0.2, 0.02));
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  machine.model.add(hand);
  auto spool = roll(on, right);
  spool->stored_length = 5.0;
  CableDef rope = cable("rope", {spool, attach(load)});
  rope.compliance = 1e-6;
  rope.rest_lengths = {4.0 - 3.0 * g * 1e-6};  // at rest
  machine.cables.push_back(rope);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = bar;
  hinge->anchor = {4.0, 1.0, 0.0};
  hinge->axis = Vector3::UnitZ();
  hinge->angle.drive = CoordinateDrive::speed;
  hinge->angle.drive_values = {0.0};
  hinge->breaking_force = 50.0;
  machine.model.joints.push_back(hinge);
  auto gear = std::make_shared<GearJoint>();
  gear->name = "gear";
  gear->body_a = one;
  gear->body_b = two;
  gear->ratio = -0.5;
  machine.model.joints.push_back(gear);
  return machine;
}

TEST(LiveWorld, ReadersAgreeWithReports) {
  LiveWorld world = test::live(workshop());
  const BodyHandle drum = *world.body("drum");
  const BodyHandle bar = *world.body("bar");
  const CableHandle rope = *world.cable("rope");
  ASSERT_TRUE(world.set_speed(drum, 1.0).empty());
  ASSERT_TRUE(world.set_drive(*world.joint("hinge"), 0.3).empty());
  ASSERT_TRUE(world.set_force(*world.body("one"), {.torque = {0.0, 0.0, 0.1}}).empty());
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(world.step().ok());
    const Simulation& s = world.simulation();
    const State& state = s.world.state();
    const CableReport report = s.cables->report(s.world.bodies(), state, state.features.back())[0];
    EXPECT_EQ(*world.tension(rope, 0), report.spans[0].tension);
    EXPECT_EQ(*world.rest_length(rope, 0), report.spans[0].rest_length);
    EXPECT_EQ(*world.stored_length(rope, 0), report.links[0].stored_length);
    const auto joints = joint_reports(s.world);
    for (const char* name : {"hinge", "gear"}) {
      const Wrench wrench = *world.force(*world.joint(name));
      const JointReport& expected = joints[name == std::string_view("hinge") ? 0 : 1];
      EXPECT_EQ(wrench.force, expected.force) << name;
      EXPECT_EQ(wrench.torque, expected.torque) << name;
    }
    EXPECT_GT(world.force(*world.joint("hinge"))->force.norm(), 1.0);
    EXPECT_GT(std::abs(world.force(*world.joint("gear"))->torque.z()), 0.01);
    const BodyPose pose = *world.pose(bar);
    EXPECT_EQ(pose.position, s.world.position({2}));
    EXPECT_EQ(pose.velocity, s.world.velocity({2}));
    EXPECT_EQ(pose.angular_velocity, s.world.angular_velocity({2}));
    EXPECT_EQ(*world.point(bar, {0.1, 0.2, 0.3}), s.world.point({2}, {0.1, 0.2, 0.3}));
  }
}

TEST(LiveWorld, NeitherReadingNorSettingAgainAllocates) {
  LiveWorld world = test::live(workshop());
  const BodyHandle drum = *world.body("drum");
  const BodyHandle load = *world.body("load");
  const BodyHandle hand = *world.body("hand");
  const CableHandle rope = *world.cable("rope");
  const JointHandle hinge = *world.joint("hinge");
  const JointHandle gear = *world.joint("gear");
  double sum = 0.0;
  bool fine = true;
  std::int64_t allocations = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(world.step().ok());
    const std::int64_t before = allocation_count();
    for (int k = 0; k < 10; ++k) {
      const double x = 0.1 * k;
      fine = fine && world.set_speed(drum, x).empty() &&
             world.set_force(load, {.force = {x, 0.0, 0.0}}).empty() &&
             world.set_motion(hand, {.position = {x, 0.0, 0.0}}).empty() &&
             world.set_drive(hinge, x).empty() && world.set_drive_limit(hinge, 40.0).empty() &&
             world.set_gravity({0.0, -9.0 - x, 0.0}).empty() &&
             world.set_compliance(rope, 1e-6 * (1.0 + x)).empty() &&
             world.set_breaking_tension(rope, 1e5).empty();
      sum += *world.tension(rope, 0) + world.force(hinge)->force.x() +
             world.force(gear)->torque.z() + world.pose(load)->position.y();
    }
    allocations = allocation_count() - before;
    // The first time makes room.
    if (i > 0) {
      EXPECT_EQ(allocations, 0);
    }
  }
  EXPECT_TRUE(fine);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(LiveWorld, WrongNamesAndHandlesAreReported) {
  LiveWorld world = test::live(workshop());
  const std::uint64_t before = hash(world.state());
  const auto none = world.body("drun");
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.errors()[0].message,
            "there is no body \"drun\"; there are: drum, load, bar, one, two, hand");
  EXPECT_FALSE(world.joint("rope").ok());
  EXPECT_FALSE(world.cable("hinge").ok());
  EXPECT_FALSE(world.pose({}).ok());
  EXPECT_EQ(world.pose({}).errors()[0].message, "this handle refers to no body");
  EXPECT_FALSE(world.tension({3, 1}, 0).ok());
  EXPECT_FALSE(world.tension(*world.cable("rope"), 1).ok());
  EXPECT_NE(world.tension(*world.cable("rope"), 1).errors()[0].message.find("it has 1"),
            std::string::npos);
  EXPECT_FALSE(world.force({7, 1}).ok());
  EXPECT_FALSE(world.set_speed({}, 1.0).empty());
  EXPECT_FALSE(world.set_drive(JointHandle{}, 1.0).empty());
  EXPECT_FALSE(world.set_compliance({}, 1.0).empty());
  const Errors wrong = world.set_torque(*world.body("drum"), 1.0);
  ASSERT_EQ(wrong.size(), 1U);
  EXPECT_EQ(wrong[0].message, "the drive of body \"drum\" has a speed, and no torque");
  EXPECT_EQ(hash(world.state()), before);
}

TEST(LiveWorld, AStepReportsItsEvents) {
  LiveWorld world = test::live(workshop());
  ASSERT_TRUE(world.set_breaking_tension(*world.cable("rope"), 35.0).empty());
  LiveReport report = world.step();
  EXPECT_TRUE(report.events.empty());
  EXPECT_TRUE(report.broken_joints.empty());
  const State before = world.state();
  std::vector<CableEvent> first;
  for (const bool again : {false, true}) {
    // Faster than 3 (g + 2) = 35.4 N lifts with, and more than the hinge bears.
    ASSERT_TRUE(world.set_speed(*world.body("drum"), {0.9, 0.1}).empty());
    ASSERT_TRUE(world.set_force(*world.body("bar"), {.force = {60.0, 0.0, 0.0}}).empty());
    report = world.step();
    ASSERT_EQ(report.events.size(), 1U);
    EXPECT_EQ(report.events[0].kind, CableEvent::Kind::cut);
    ASSERT_EQ(report.broken_joints.size(), 1U);
    EXPECT_EQ(report.broken_joints[0], *world.joint("hinge"));
    if (again) {
      EXPECT_EQ(report.events[0].time, first[0].time);
    }
    first = report.events;
    EXPECT_TRUE(world.step().events.empty());
    // Back to before it happens again.
    ASSERT_TRUE(world.restore(before).empty());
    EXPECT_EQ(hash(world.state()), hash(before));
  }
}

// After an edit the numbers of an older state mean something else, although there are as many of them; only snapshots go back.
TEST(LiveWorld, AStateFromBeforeAnEditIsRefused) {
  LiveWorld world = test::live(workshop());
  const State before = world.state();
  const LiveSnapshot snapshot = world.snapshot();
  const CableHandle rope = *world.cable("rope");
  const auto report = world.edit([&](Edit& edit) {
    edit.detach(rope, CableEnd::last);
    edit.attach(rope, CableEnd::last, BodyId::world(), Vector3(0.25, 0.0, 0.0));
  });
  ASSERT_TRUE(report.ok()) << report.errors().front().message;
  const std::uint64_t now = hash(world.state());
  const Errors errors = world.restore(before);
  ASSERT_FALSE(errors.empty());
  EXPECT_NE(errors.front().message.find("does not belong to this world"), std::string::npos);
  EXPECT_EQ(hash(world.state()), now);
  EXPECT_TRUE(world.restore(snapshot).empty());
  EXPECT_EQ(hash(world.state()), hash(before));
  EXPECT_TRUE(world.restore(before).empty());
}

TEST(LiveWorld, ReportsWhetherACableIsCut) {
  LiveWorld world = test::live(workshop());
  const CableHandle rope = *world.cable("rope");
  EXPECT_FALSE(world.is_cut(rope));
  ASSERT_TRUE(world.set_breaking_tension(rope, 1.0).empty());
  ASSERT_TRUE(world.step().ok());
  EXPECT_TRUE(world.is_cut(rope));
  EXPECT_TRUE(world.pulls(rope)) << "its links are there";
}

TEST(LiveWorld, ACutActsAtOnceAndIsPartOfTheState) {
  LiveWorld world = test::live(workshop());
  const CableHandle rope = *world.cable("rope");
  const BodyHandle load = *world.body("load");
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(world.step().ok());
  ASSERT_NEAR(*world.tension(rope, 0), 3.0 * g, 1e-6);
  const double before = world.pose(load)->velocity.y();
  ASSERT_TRUE(world.cut(rope).empty());
  EXPECT_TRUE(world.is_cut(rope));
  const LiveSnapshot after_cut = world.snapshot();
  const LiveReport report = world.step();
  ASSERT_TRUE(report.ok());
  ASSERT_EQ(report.events.size(), 1U);
  EXPECT_EQ(report.events[0].kind, CableEvent::Kind::cut);
  EXPECT_EQ(report.events[0].time, 5 * 0.01);
  EXPECT_EQ(*world.tension(rope, 0), 0.0);
  // Free fall from the cut on. Places near 0 have the rounding of the lengths of 4 m, 9e-16 m, and the
  // shortest substep is 1 ms.
  EXPECT_NEAR(world.pose(load)->velocity.y() - before, -g * 0.01, 1e-11);
  const std::uint64_t fallen = hash(world.state());
  ASSERT_TRUE(world.restore(after_cut).empty());
  ASSERT_TRUE(world.step().ok());
  EXPECT_EQ(hash(world.state()), fallen);
  EXPECT_TRUE(world.cut(rope).empty());
  EXPECT_TRUE(world.step().events.empty()) << "a cable parts once";
}

TEST(LiveWorld, ACutWaitsForTension) {
  for (const bool revoked : {false, true}) {
    test::Machine machine = workshop();
    machine.cables[0].rest_lengths = {4.5};
    LiveWorld world = test::live(machine);
    const CableHandle rope = *world.cable("rope");
    ASSERT_TRUE(world.cut(rope).empty());
    EXPECT_FALSE(world.is_cut(rope)) << "the rope is slack";
    if (revoked) {
      ASSERT_TRUE(world.clear_breaking_tension(rope).empty());
    }
    // The load falls 0.5 m to the end of the slack in sqrt(2 * 0.5 / g) = 0.3193 s.
    for (int i = 0; i < 31; ++i) ASSERT_TRUE(world.step().events.empty());
    const LiveReport report = world.step();
    EXPECT_EQ(report.events.size(), revoked ? 0U : 1U);
    EXPECT_EQ(world.is_cut(rope), !revoked);
  }
}

TEST(LiveWorld, RefusesToCutACableThatIsNotThere) {
  LiveWorld world = test::live(workshop());
  const CableHandle rope = *world.cable("rope");
  ASSERT_TRUE(world.edit([&](Edit& edit) { edit.remove(rope); }).ok());
  const std::uint64_t before = hash(world.state());
  const Errors errors = world.cut(rope);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].message.find("\"rope\""), std::string::npos) << errors[0].message;
  EXPECT_EQ(world.cut({}).size(), 1U);
  EXPECT_EQ(hash(world.state()), before);
}

// A drum draws a rigid rope that the world holds: it stalls, and the step in which it first does says
// so, in the words that the command has for it.
TEST(LiveWorld, AStepWarnsOfUnmetRequests) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {test::wheel("drum", {0.0, 0.0, 0.0}, 0.2, 0.05)};
  machine.model.bodies[0].drive = DriveKind::speed;
  machine.model.bodies[0].drive_values = {0.0};
  auto spool = roll(BodyId{0}, right);
  spool->stored_length = 1.0;
  machine.cables = {cable("rope", {spool, attach(BodyId::world(), {0.2, -2.0, 0.0})})};
  LiveWorld world = test::live(machine);
  EXPECT_TRUE(world.step().warnings.empty());
  // Of the two senses one draws the rope.
  std::vector<std::string> told;
  for (const double speed : {1.0, -1.0}) {
    ASSERT_TRUE(world.set_speed(*world.body("drum"), speed).empty());
    for (int i = 0; i < 60; ++i) {
      const LiveReport report = world.step();
      ASSERT_TRUE(report.ok());
      for (const Warning& warning : report.warnings) {
        told.push_back(warning.kind);
        EXPECT_EQ(warning.kind, "stalled");
        EXPECT_EQ(warning.subject, "rope");
        EXPECT_NE(warning.message.find("link 0 on \"drum\" stalled"), std::string::npos);
      }
    }
  }
  EXPECT_EQ(told.size(), 1U);
}

// An elastic rope of 1 m that is 2 m long: the report of the first step says so, and no other.
TEST(LiveWorld, TheFirstStepWarnsOfTheStart) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {test::wheel("load", {0.0, -2.0, 0.0}, 0.2, 1.0)};
  machine.cables = {cable(
      "rope", {attach(BodyId::world(), {0.2, 0.0, 0.0}), attach(BodyId{0}, {0.2, 0.0, 0.0})})};
  machine.cables[0].axial_stiffness = 10.0;
  machine.cables[0].rest_lengths = {1.0};
  LiveWorld world = test::live(machine);
  const LiveReport first = world.step();
  ASSERT_EQ(first.warnings.size(), 1U);
  EXPECT_EQ(first.warnings[0].kind, "strained_start");
  EXPECT_EQ(first.warnings[0].subject, "rope.0");
  EXPECT_NE(first.warnings[0].message.find("stretched by 100 % in span 0"), std::string::npos);
  EXPECT_TRUE(world.step().warnings.empty());
}

TEST(LiveWorld, LoadsScenes) {
  const std::string machines = std::string(SHEAVE_SOURCE_DIR) + "/scenes/machines/";
  Result<LiveWorld> crane = load(machines + "crane.json");
  ASSERT_TRUE(crane.ok());
  ASSERT_TRUE(crane->set_speed(*crane->body("hoist winch"), 1.2).empty());
  ASSERT_TRUE(crane->step().ok());
  EXPECT_GT(*crane->tension(*crane->cable("hoist cable"), 2), 20000.0);
  const Result<LiveWorld> none = load(machines + "no-such-crane.json");
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.errors()[0].message.find("no-such-crane.json"), std::string::npos);
}

TEST(LiveWorld, SetsTogetherAllOrNothing) {
  LiveWorld world = live(workshop());
  ASSERT_TRUE(world.set_speed(*world.body("drum"), 0.2).empty());
  const std::uint64_t before = hash(world.state());
  const auto change = [&](double compliance) {
    return world.set_together([&] {
      Errors errors = world.set_gravity({0.0, -1.0, 0.0});
      for (Error& error : world.set_speed(*world.body("drum"), 1.0)) errors.push_back(error);
      for (Error& error : world.set_compliance(*world.cable("rope"), compliance)) {
        errors.push_back(error);
      }
      return errors;
    });
  };
  EXPECT_EQ(change(-1.0).size(), 1U);
  EXPECT_EQ(hash(world.state()), before);
  EXPECT_TRUE(change(1e-6).empty());
  EXPECT_NE(hash(world.state()), before);
}

TEST(LiveWorld, ControllersAndTriggersOfScenesAct) {
  const std::string path =
      std::string(SHEAVE_SOURCE_DIR) + "/scenes/machines/constant-tension-winch.json";
  Result<LiveWorld> world = load(path);
  ASSERT_TRUE(world.ok());
  const SceneResult scene = load_scene(path);
  Result<Simulation> simulation = create_simulation(*scene);
  int calls = 0;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(world->step({}, [&] { ++calls; }).ok());
    ASSERT_TRUE(simulation->step().ok());
  }
  EXPECT_EQ(hash(world->state()), hash(simulation->world.state()));
  EXPECT_EQ(calls, 50 * scene->model.step.substeps);
  EXPECT_FALSE(world->state().controls.empty()) << "the controller has set the drive";
}

// What is set is no fault: every balance of the certificate closes with it.
TEST(LiveWorld, CertificatesTakeAccountOfControls) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine = workshop();
    machine.model.step.integrator = integrator;
    machine.model.joints[0] = [&] {
      auto hinge =
          std::make_shared<HingeJoint>(static_cast<const HingeJoint&>(*machine.model.joints[0]));
      hinge->breaking_force.reset();
      return hinge;
    }();
    // A rotor on the load, and a line with a feed and friction.
    const BodyId rider =
        machine.model.add(test::sheave("rider", {1}, {0.25, 0.0, 0.2}, 0.1, 0.5, 0.003));
    BodyDef post = test::wheel("post", {-3.0, 0.0, 0.0}, 0.2, 0.1);
    post.mobility = Mobility::fixed;
    const BodyId around = machine.model.add(post);
    const BodyId weight = machine.model.add(test::weight("weight", {-3.2, -2.0, 0.0}, 1.0));
    auto over = roll(around, right);
    over->friction = 0.2;
    auto mouth = attach(BodyId::world(), {-2.8, -3.0, 0.0});
    mouth->feed_speed = 0.0;
    machine.cables.push_back(cable("line", {attach(weight), over, mouth}));
    LiveWorld world = test::live(machine);
    Certificate all;
    for (int i = 0; i < 60; ++i) {
      const double phase = 0.1 * i;
      ASSERT_TRUE(world.set_gravity({0.0, -9.0 + std::sin(phase), 0.0}).empty());
      ASSERT_TRUE(world.set_speed(*world.body("drum"), std::sin(phase)).empty());
      ASSERT_TRUE(world.set_drive(*world.joint("hinge"), 0.5 * std::cos(phase)).empty());
      ASSERT_TRUE(world
                      .set_force(*world.body("bar"), {.force = {1.0, std::sin(phase), 0.5},
                                                      .torque = {0.1, 0.0, 0.2},
                                                      .point = Vector3{0.1, 0.0, 0.1},
                                                      .frame = ForceFrame::body})
                      .empty());
      ASSERT_TRUE(world
                      .set_force({rider.index, 1}, {.force = {0.0, 2.0, 0.0},
                                                    .torque = {0.0, 0.0, 0.01},
                                                    .point = Vector3{0.05, 0.0, 0.0}})
                      .empty());
      ASSERT_TRUE(world.set_force(*world.body("one"), {.torque = {0.0, 0.0, 0.02}}).empty());
      ASSERT_TRUE(
          world.set_compliance(*world.cable("rope"), 1e-6 * (2.0 + std::sin(phase))).empty());
      ASSERT_TRUE(world.set_friction(*world.cable("line"), 1, 0.2 + 0.1 * std::sin(phase)).empty());
      ASSERT_TRUE(world.set_feed_speed(*world.cable("line"), 2, 0.2 * std::cos(phase)).empty());
      ASSERT_TRUE(world.step().ok());
      const auto one = world.simulation().certificate();
      ASSERT_TRUE(one.has_value());
      all.merge(*one);
    }
    EXPECT_TRUE(all.clean(1e-3)) << all.worst()->sentence();
    // And it sees it if they are not what acted: a state whose controls differ from those of the
    // last substep is none.
    EXPECT_NE(all.find(CertificateItem::Kind::drive), nullptr);
  }
}

}  // namespace
}  // namespace sheave
