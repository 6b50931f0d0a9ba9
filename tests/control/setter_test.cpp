// What setting controls costs, in allocations and in work: times would depend on the machine.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/links/attachment.h"
#include "cable/live_world.h"
#include "engine/index.h"
#include "engine/joints/hinge.h"
#include "tests/control/allocation_count.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::allocation_count;
using test::attach;
using test::cable;
using test::right;
using test::roll;

std::shared_ptr<HingeJoint> driven_hinge(std::string name, BodyId body, const Vector3& anchor,
                                         CoordinateDrive drive) {
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = std::move(name);
  hinge->body_b = body;
  hinge->anchor = anchor;
  hinge->axis = Vector3::UnitZ();
  hinge->angle.drive = drive;
  hinge->angle.drive_values = {0.0};
  return hinge;
}

/// Something for each setter.
test::Machine machine_of_all_controls() {
  test::Machine machine;
  Model& model = machine.model;
  const auto driven = [](BodyDef body, DriveKind kind) {
    body.drive = kind;
    body.drive_values = {0.0};
    return body;
  };
  const BodyId drum =
      model.add(driven(test::wheel("drum", {0.0, 4.0, 0.0}, 0.25, 0.05), DriveKind::speed));
  model.add(driven(test::wheel("pointer", {3.0, 0.0, 0.0}, 0.25, 0.05), DriveKind::angle));
  model.add(driven(test::wheel("motor", {6.0, 0.0, 0.0}, 0.25, 0.05), DriveKind::torque));
  const BodyId load = model.add(test::weight("load", {0.25, 0.0, 0.0}, 3.0));
  const BodyId craft = model.add(test::lump("craft", {9.0, 0.0, 0.0}, 2.0));
  model.add(
      driven(test::sheave("wheel", craft, {9.0, 0.0, 0.2}, 0.1, 0.5, 0.003), DriveKind::speed));
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  hand.position = {-3.0, 0.0, 0.0};
  model.add(hand);
  const BodyId bar = model.add(test::lump("bar", {12.5, 0.0, 0.0}, 2.0));
  model.joints = {driven_hinge("hinge", bar, {12.0, 0.0, 0.0}, CoordinateDrive::speed)};
  BodyDef post = test::wheel("post", {-6.0, 0.0, 0.0}, 0.2, 0.1);
  post.mobility = Mobility::fixed;
  auto spool = roll(drum, right);
  spool->stored_length = 5.0;
  machine.cables = {cable("rope", {spool, attach(load)})};
  machine.cables[0].compliance = 1e-6;
  machine.cables[0].wrap_friction = 0.2;
  auto over = roll(model.add(post), right);
  over->friction = 0.2;
  auto mouth = attach(BodyId::world(), {-5.8, -3.0, 0.0});
  mouth->feed_speed = 0.0;
  machine.cables.push_back(cable(
      "line", {attach(model.add(test::weight("weight", {-6.2, -2.0, 0.0}, 1.0))), over, mouth}));
  return machine;
}

struct Setter {
  const char* name;
  std::function<Errors(LiveWorld& world, double value)> set;
};

/// All there are; `value` is at least 0.
std::vector<Setter> all_setters(const LiveWorld& world) {
  const auto body = [&](const char* name) { return *world.body(name); };
  const BodyHandle drum = body("drum");
  const BodyHandle pointer = body("pointer");
  const BodyHandle motor = body("motor");
  const BodyHandle wheel = body("wheel");
  const BodyHandle craft = body("craft");
  const BodyHandle hand = body("hand");
  const JointHandle hinge = *world.joint("hinge");
  const CableHandle rope = *world.cable("rope");
  const CableHandle line = *world.cable("line");
  using W = LiveWorld&;
  return {
      {"speed", [=](W w, double x) { return w.set_speed(drum, x); }},
      {"speed of a mounted rotor", [=](W w, double x) { return w.set_speed(wheel, x); }},
      {"angle",
       [=](W w, double x) {
         return w.set_angle(pointer, {x, 0.1, 0.2});
       }},
      {"torque", [=](W w, double x) { return w.set_torque(motor, x); }},
      {"force",
       [=](W w, double x) {
         return w.set_force(craft, {.force = {x, 0.0, 0.0}});
       }},
      {"force at a point",
       [=](W w, double x) {
         return w.set_force(craft, {.force = {x, 0.0, 0.0},
                                    .torque = {0.0, x, 0.0},
                                    .point = Vector3(0.1, 0.0, 0.0),
                                    .frame = ForceFrame::body});
       }},
      {"straight motion",
       [=](W w, double x) {
         return w.set_motion(hand, {.position = {-3.0, x, 0.0}});
       }},
      {"smooth motion",
       [=](W w, double x) {
         const Quaternion orientation = rotation_by(Vector3(0.0, 0.0, x));
         return w.set_motion(hand, {.position = {-3.0, x, 0.0},
                                    .orientation = orientation,
                                    .velocity = Vector3(0.0, x, 0.0),
                                    .angular_velocity = Vector3(0.0, 0.0, x)});
       }},
      {"drive", [=](W w, double x) { return w.set_drive(hinge, x); }},
      {"drive limit", [=](W w, double x) { return w.set_drive_limit(hinge, 1.0 + x); }},
      {"gravity",
       [=](W w, double x) {
         return w.set_gravity({0.0, -x, 0.0});
       }},
      {"compliance", [=](W w, double x) { return w.set_compliance(rope, 1e-6 * (1.0 + x)); }},
      {"breaking tension", [=](W w, double x) { return w.set_breaking_tension(rope, 1e6 + x); }},
      {"wrap friction", [=](W w, double x) { return w.set_wrap_friction(rope, 0.1 + x); }},
      {"friction", [=](W w, double x) { return w.set_friction(line, 1, 0.1 + x); }},
      {"feed speed", [=](W w, double x) { return w.set_feed_speed(line, 2, x); }},
      {"clear drive of a body", [=](W w, double /*x*/) { return w.clear_drive(drum); }},
      {"clear force", [=](W w, double /*x*/) { return w.clear_force(craft); }},
      {"clear drive of a joint", [=](W w, double /*x*/) { return w.clear_drive(hinge); }},
      {"clear compliance", [=](W w, double /*x*/) { return w.clear_compliance(rope); }},
      {"clear breaking tension", [=](W w, double /*x*/) { return w.clear_breaking_tension(rope); }},
      {"clear wrap friction", [=](W w, double /*x*/) { return w.clear_wrap_friction(rope); }},
      {"clear friction", [=](W w, double /*x*/) { return w.clear_friction(line, 1); }},
      {"clear feed speed", [=](W w, double /*x*/) { return w.clear_feed_speed(line, 2); }},
      {"clear motion", [=](W w, double /*x*/) { return w.clear_motion(hand); }},
  };
}

TEST(Setters, DoNotAllocateOnceThereIsRoom) {
  LiveWorld world = test::live(machine_of_all_controls());
  const std::vector<Setter> setters = all_setters(world);
  for (const Setter& setter : setters) {
    EXPECT_TRUE(setter.set(world, 0.1).empty()) << setter.name;
  }
  for (int step = 0; step < 3; ++step) {
    ASSERT_TRUE(world.step().ok());
    for (const Setter& setter : setters) {
      const std::int64_t before = allocation_count();
      const bool fine = setter.set(world, 0.01 * step).empty();
      EXPECT_EQ(allocation_count() - before, 0) << setter.name;
      EXPECT_TRUE(fine) << setter.name;
    }
  }
  // What counts them sees what a fault costs.
  const std::int64_t before = allocation_count();
  EXPECT_FALSE(world.set_torque(*world.body("drum"), 1.0).empty());
  EXPECT_GT(allocation_count() - before, 0);
}

/// Bodies of each kind whose drives can be set: on axles, mounted, hinged, and with a force.
test::Machine fleet(int count) {
  test::Machine machine;
  machine.model.gravity.setZero();
  const std::vector<double> steady{0.1};
  for (int i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    const double x = 10.0 * i;
    BodyDef wheel = test::wheel("wheel " + number, {x, 0.0, 0.0}, 0.25, 0.05);
    wheel.drive = DriveKind::speed;
    wheel.drive_values = steady;
    machine.model.add(wheel);
    const BodyId craft = machine.model.add(test::lump("craft " + number, {x, 3.0, 0.0}, 2.0));
    BodyDef mounted = test::sheave("mounted " + number, craft, {x, 3.0, 0.2}, 0.1, 0.5, 0.003);
    mounted.drive = DriveKind::speed;
    mounted.drive_values = steady;
    machine.model.add(mounted);
    const BodyId bar = machine.model.add(test::lump("bar " + number, {x, 6.0, 0.0}, 2.0));
    auto hinge = driven_hinge("hinge " + number, bar, {x, 6.0, 0.0}, CoordinateDrive::speed);
    hinge->angle.drive_values = steady;
    machine.model.joints.push_back(hinge);
  }
  return machine;
}

/// Sets everything of a fleet near what it does anyway.
bool set_all(LiveWorld& world, const std::vector<BodyHandle>& bodies,
             const std::vector<JointHandle>& joints, int step) {
  const double speed = 0.1 * (1.0 + 0.1 * (step % 3));
  bool fine = true;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    fine = fine && world.set_speed(bodies[4 * i], speed).empty() &&
           world.set_force(bodies[4 * i + 1], {.force = {speed, 0.0, 0.0}}).empty() &&
           world.set_speed(bodies[4 * i + 2], speed).empty() &&
           world.set_drive(joints[i], speed).empty();
  }
  return fine;
}

struct Work {
  std::int64_t allocations = 0;
  std::int64_t row_solves = 0;
  std::int64_t rounds = 0;
  std::int64_t factorisations = 0;
  std::int64_t fallbacks = 0;  ///< of any kind
};

Work work_of_steps(bool steered, int bodies_of_each_kind) {
  LiveWorld world = test::live(fleet(bodies_of_each_kind));
  const std::vector<BodyHandle> bodies = world.bodies();
  const std::vector<JointHandle> joints = world.joints();
  Work work;
  for (int step = 0; step < 20; ++step) {
    const std::int64_t before = allocation_count();
    const bool fine = !steered || set_all(world, bodies, joints, step);
    const LiveReport report = world.step();
    EXPECT_TRUE(fine && report.ok());
    // The first ones make room.
    if (step < 5) continue;
    const StepStatistics& done = report.statistics;
    work.allocations += allocation_count() - before;
    work.row_solves += done.row_solves;
    work.rounds += done.rounds;
    work.factorisations += done.factorisations;
    work.fallbacks += done.solver_fallbacks + done.integrator_fallbacks + done.cut_substeps;
  }
  return work;
}

// Whatever costs time beside the setters themselves would be among these: memory, or rounds of the
// solver.
TEST(Setters, DoNotAddWorkToAStep) {
  constexpr int each = 25;
  const Work alone = work_of_steps(false, each);
  const Work steered = work_of_steps(true, each);
  EXPECT_GT(alone.rounds, 0);
  EXPECT_EQ(steered.allocations, alone.allocations);
  EXPECT_EQ(steered.row_solves, alone.row_solves);
  EXPECT_EQ(steered.rounds, alone.rounds);
  EXPECT_EQ(steered.factorisations, alone.factorisations);
  EXPECT_EQ(steered.fallbacks, alone.fallbacks);
}

}  // namespace
}  // namespace sheave
