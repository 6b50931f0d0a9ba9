// Bodies, joints and colliders that come and go while a world runs.

#include "cable/edit.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/live_world.h"
#include "engine/body_set.h"
#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "engine/shapes/box.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::advance;
using test::attach;
using test::cable;
using test::edit;
using test::g;
using test::live;
using test::refused;
using test::right;
using test::roll;
using test::worst_figure;
using testing::HasSubstr;

test::Machine empty(IntegratorKind integrator) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(integrator, 0.01, 2);
  return machine;
}

// A body that has tumbled is hung up on a hinge; the same as if it had been made there, hung up,
// with that motion.
TEST(Edit, AJointOfAMovedBodyEqualsOneOfANewModel) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine = empty(integrator);
    BodyDef lump = test::lump("lump", {0.3, 0.2, 0.1}, 2.0);
    lump.velocity = {0.5, 1.0, -0.3};
    lump.angular_velocity = {1.0, -2.0, 3.0};
    machine.model.add(lump);
    LiveWorld world = live(machine);
    advance(world, 30);
    const BodyHandle body = *world.body("lump");
    const BodyPose pose = *world.pose(body);
    HingeJoint hinge;
    hinge.name = "hinge";
    hinge.body_b = BodyId{body.slot};
    hinge.anchor = pose.position + Vector3(0.4, 0.3, -0.1);
    hinge.axis = {0.2, 1.0, 0.5};
    edit(world, [&](Edit& e) { e.add(std::make_shared<HingeJoint>(hinge)); });

    test::Machine there = empty(integrator);
    lump.position = pose.position;
    lump.orientation = pose.orientation;
    lump.velocity = pose.velocity;
    lump.angular_velocity = pose.angular_velocity;
    there.model.add(lump);
    there.model.joints.push_back(std::make_shared<HingeJoint>(hinge));
    LiveWorld made = live(there);
    advance(world, 60);
    advance(made, 60);
    const BodyPose a = *world.pose(body);
    const BodyPose b = *made.pose(*made.body("lump"));
    // Times are sums, so steps of both have other roundings.
    EXPECT_LT((a.position - b.position).norm(), 1e-9);
    EXPECT_LT((a.angular_velocity - b.angular_velocity).norm(), 1e-8);
    const JointReport report = joint_reports(world.simulation().world)[0];
    EXPECT_LT(report.error, 1e-9);
    EXPECT_NEAR(report.coordinates[0].value,
                joint_reports(made.simulation().world)[0].coordinates[0].value, 1e-9);
    EXPECT_LT(worst_figure(world), 1e-6);
  }
}

// What was there before an edit goes on to the last bit, forces, angles with all their turns and
// all.
TEST(Edit, UnchangedPartsContinueBitForBit) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine = empty(integrator);
    const BodyId arm = machine.model.add(test::lump("arm", {0.5, 0.0, 0.0}, 1.0));
    const BodyId tip = machine.model.add(test::lump("tip", {1.0, 0.0, 0.0}, 0.5));
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = "hinge";
    hinge->body_b = arm;
    hinge->axis = Vector3::UnitY();
    hinge->angle.drive = CoordinateDrive::speed;
    hinge->angle.drive_values = {30.0};
    auto ball = std::make_shared<BallJoint>();
    ball->name = "ball";
    ball->body_a = arm;
    ball->body_b = tip;
    ball->anchor = {0.8, 0.0, 0.0};
    machine.model.joints = {hinge, ball};
    LiveWorld world = live(machine);
    LiveWorld alone = live(machine);
    advance(world, 50);
    advance(alone, 50);
    ASSERT_EQ(hash(world.state()), hash(alone.state()));
    const BodyHandle hand = *world.body("arm");
    const JointHandle handle = *world.joint("ball");
    edit(world, [](Edit&) {});
    EXPECT_EQ(hash(world.state()), hash(alone.state()));
    BodyHandle far;
    edit(world, [&](Edit& e) { far = e.add(test::lump("far", {0.0, 100.0, 0.0}, 1.0)); });
    // Another body changes the size of the scene, and with it what rounding is taken to be.
    edit(world, [&](Edit& e) { e.remove(far); });
    EXPECT_TRUE(world.pose(hand).ok());
    EXPECT_TRUE(world.force(handle).ok());
    EXPECT_EQ(world.force(handle)->force, alone.force(*alone.joint("ball"))->force);
    advance(world, 50);
    advance(alone, 50);
    const JointReport a = joint_reports(world.simulation().world)[0];
    const JointReport b = joint_reports(alone.simulation().world)[0];
    EXPECT_GT(b.coordinates[0].value, 25.0) << "four turns";
    EXPECT_NEAR(a.coordinates[0].value, b.coordinates[0].value, 1e-9);
    EXPECT_LT((world.pose(hand)->position - alone.pose(*alone.body("arm"))->position).norm(), 1e-9);
  }
}

TEST(Edit, BodiesComeAndGoAndTheirHandlesWithThem) {
  LiveWorld world = live(empty(IntegratorKind::rattle));
  BodyHandle first;
  edit(world, [&](Edit& e) {
    BodyDef lump = test::lump("first", {1.0, 2.0, 3.0}, 2.0);
    lump.velocity = {0.0, 1.0, 0.0};
    first = e.add(lump);
  });
  EXPECT_EQ(*world.body("first"), first);
  EXPECT_NEAR(world.energy().total(), 0.5 * 2.0 + 2.0 * g * 2.0, 1e-12);
  advance(world, 10);
  EXPECT_NEAR(world.pose(first)->position.y(), 2.0 + 0.1 - 0.5 * g * 0.01, 1e-12);
  const double energy = world.energy().total();
  const EditReport gone = edit(world, [&](Edit& e) { e.remove(first); });
  EXPECT_NEAR(gone.energy.total(), -energy, 1e-12);
  EXPECT_TRUE(world.bodies().empty());
  EXPECT_FALSE(world.pose(first).ok());
  EXPECT_THAT(world.pose(first).errors()[0].message, HasSubstr("\"first\""));
  BodyHandle second;
  edit(world, [&](Edit& e) { second = e.add(test::lump("second", {0.0, 0.0, 0.0}, 1.0)); });
  EXPECT_EQ(second.slot, first.slot) << "places are used again";
  EXPECT_THAT(refused(world, [&](Edit& e) { static_cast<void>(e.id(first)); }),
              HasSubstr("is no more"));
  EXPECT_FALSE(world.pose(first).ok()) << "and the old handle does not become the new body's";
  EXPECT_TRUE(world.pose(second).ok());
  EXPECT_FALSE(world.body("first").ok());
  EXPECT_THAT(world.body("nothing").errors()[0].message, testing::Not(HasSubstr("(no body")))
      << "what stands where there is no body has no name that users see";
}

// A wheel is put on the axle of a carrier that has turned and moved.
// What an edit has tied to a body that it then removes is not tied to the next one that it adds.
TEST(Edit, ANewBodyIsNotTheRemovedOne) {
  LiveWorld world = test::live(test::Atwood{}.machine());
  const CableHandle cable = world.cable_at(0);
  edit(world, [](Edit& e) { e.add(test::lump("old", {3.0, 0.0, 0.0}, 1.0)); });
  const std::string fault = test::refused(world, [&](Edit& e) {
    e.detach(cable, CableEnd::last);
    e.attach(cable, CableEnd::last, e.id(*world.body("old")), Vector3::Zero());
    e.remove(*world.body("old"));
    e.add(test::lump("new", {0.25, -2.0, 0.0}, 1.0));
  });
  EXPECT_THAT(fault, HasSubstr("on a body that does not exist"));
}

TEST(Edit, RotorOnACarrierThatHasTurned) {
  test::Machine machine = empty(IntegratorKind::rattle);
  machine.model.gravity = Vector3::Zero();
  BodyDef lump = test::lump("carrier", {1.0, 0.0, 0.0}, 2.0);
  lump.angular_velocity = {0.0, 0.0, 2.0};
  lump.velocity = {0.3, 0.0, 0.0};
  machine.model.add(lump);
  LiveWorld world = live(machine);
  advance(world, 40);
  const BodyHandle carrier = *world.body("carrier");
  const BodyPose pose = *world.pose(carrier);
  const Vector3 place = pose.position + Vector3(0.0, 0.5, 0.2);
  BodyHandle wheel;
  const Vector3 momentum = 2.0 * pose.velocity;
  edit(world, [&](Edit& e) {
    BodyDef rotor = test::sheave("wheel", e.id(carrier), place, 0.2, 0.7, 0.03);
    rotor.angular_velocity = {0.0, 0.0, 9.0};
    wheel = e.add(rotor);
  });
  const BodyPose on = *world.pose(wheel);
  EXPECT_LT((on.position - place).norm(), 1e-12);
  EXPECT_NEAR(on.angular_velocity.z(), 9.0, 1e-12);
  const Vector3 arm = place - pose.position;
  EXPECT_LT((on.velocity - (pose.velocity + pose.angular_velocity.cross(arm))).norm(), 1e-12);
  // Then all of it goes on as one: the centre of mass of both in a straight line.
  const auto center = [&] {
    return Vector3((2.0 * world.pose(carrier)->position + 0.7 * world.pose(wheel)->position) / 2.7);
  };
  const Vector3 start = center();
  const Vector3 velocity = (momentum + 0.7 * on.velocity) / 2.7;
  advance(world, 100);
  EXPECT_LT((center() - start - velocity).norm(), 1e-9);
  EXPECT_NEAR((world.pose(wheel)->position - world.pose(carrier)->position).norm(), arm.norm(),
              1e-12);
}

// The frame of a body stays where it is when its mass moves within it; its momentum changes by what
// theory says.
TEST(Edit, ChangedMassKeepsTheFrameAndItsMotion) {
  test::Machine machine = empty(IntegratorKind::rattle);
  BodyDef lump = test::lump("lump", {0.0, 0.0, 0.0}, 2.0);
  lump.angular_velocity = {0.0, 0.0, 1.0};
  machine.model.add(lump);
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = BodyId{0};
  hinge->anchor = {0.3, 0.0, 0.0};
  machine.model.joints = {hinge};
  LiveWorld world = live(machine);
  advance(world, 20);
  const BodyHandle body = *world.body("lump");
  const BodyPose before = *world.pose(body);
  edit(world, [&](Edit& e) {
    e.change(body, [](BodyDef& def) {
      def.mass.reset();
      def.inertia.reset();
      def.density = 100.0;
      auto box = std::make_shared<Box>();
      box->size = {0.2, 0.2, 0.2};
      def.shapes = {{box, {0.05, 0.02, 0.0}}};
    });
  });
  const BodyPose after = *world.pose(body);
  EXPECT_LT((after.position - before.position).norm(), 1e-12);
  EXPECT_LT((after.velocity - before.velocity).norm(), 1e-12);
  const Vector3 own_mass_center = world.state().bodies[0].orientation.conjugate() *
                                  (world.state().bodies[0].position - after.position);
  EXPECT_LT((own_mass_center - Vector3(0.05, 0.02, 0.0)).norm(), 1e-12);
  advance(world, 50);
  EXPECT_LT(joint_reports(world.simulation().world)[0].error, 1e-9);
  EXPECT_LT(worst_figure(world), 1e-6);
}

// A box at rest on another one stays at rest when a third comes, and falls when the lower one goes.
TEST(Edit, ContactsFollowAddedAndRemovedBodies) {
  test::Machine machine = empty(IntegratorKind::xpbd);
  const auto box = [](const char* name, double y, Mobility mobility) {
    BodyDef body;
    body.name = name;
    body.mobility = mobility;
    body.position = {0.0, y, 0.0};
    if (mobility != Mobility::fixed) body.density = 500.0;
    auto shape = std::make_shared<Box>();
    shape->size = {0.5, 0.2, 0.5};
    body.shapes = {{shape}};
    return body;
  };
  const auto touching = [](int body) {
    ColliderDef collider;
    collider.body = {body};
    collider.friction = 0.5;
    return collider;
  };
  machine.model.bodies = {box("table", 0.0, Mobility::fixed), box("low", 0.2, Mobility::free)};
  machine.model.colliders = {touching(0), touching(1)};
  LiveWorld world = live(machine);
  advance(world, 50);
  const double rest = world.pose(*world.body("low"))->position.y();
  BodyHandle high;
  edit(world, [&](Edit& e) {
    high = e.add(box("high", rest + 0.2, Mobility::free));
    e.add(touching(e.id(high).index));
  });
  EXPECT_FALSE(world.simulation().world.contacts().empty()) << "known from before";
  advance(world, 100);
  EXPECT_NEAR(world.pose(high)->position.y(), rest + 0.2, 1e-3);
  edit(world, [&](Edit& e) { e.remove(*world.body("low")); });
  const double start = world.pose(high)->position.y();
  advance(world, 10);
  // xpbd takes the end of a substep of 5 ms for its speed.
  EXPECT_NEAR(world.pose(high)->position.y(), start - 0.5 * g * 0.1 * (0.1 + 0.005), 1e-6);
  advance(world, 200);
  EXPECT_NEAR(world.pose(high)->position.y(), 0.2, 1e-3);
}

TEST(Edit, SettingsOfTheStep) {
  LiveWorld world = live(test::Atwood{}.machine());
  advance(world, 5);
  edit(world, [&](Edit& e) {
    StepSettings step = world.simulation().world.model().step;
    step.substeps *= 4;
    step.solver = SolverKind::direct;
    e.set_step(step);
  });
  EXPECT_EQ(world.simulation().world.model().step.solver, SolverKind::direct);
  advance(world, 5);
  EXPECT_THAT(refused(world,
                      [&](Edit& e) {
                        StepSettings step = world.simulation().world.model().step;
                        step.dt *= 2.0;
                        e.set_step(step);
                      }),
              HasSubstr("dt cannot be changed"));
}

TEST(Edit, ControlsStaySet) {
  test::Machine machine = test::Atwood{}.machine();
  LiveWorld world = live(machine);
  ASSERT_TRUE(world.set_gravity({0.0, -3.0, 0.0}).empty());
  ASSERT_TRUE(world.set_force(*world.body("left"), {Vector3(0.0, 1.0, 0.0)}).empty());
  ASSERT_TRUE(world.set_breaking_tension(*world.cable("rope"), 1e6).empty());
  advance(world, 5);
  const std::uint64_t before = hash(world.state());
  edit(world, [](Edit&) {});
  EXPECT_EQ(hash(world.state()), before);
  edit(world, [](Edit& e) { e.add(test::lump("other", {5.0, 0.0, 0.0}, 1.0)); });
  EXPECT_TRUE(world.state().controls.has_gravity);
  EXPECT_NE(world.state().controls.forces.find(world.body("left")->slot), nullptr);
  EXPECT_NE(world.state().controls.cables.find(0), nullptr);
}

TEST(Edit, AllFaultsAreReportedAndNothingIsChanged) {
  LiveWorld world = live(test::Atwood{}.machine());
  advance(world, 5);
  const BodyHandle wheel = *world.body("wheel");
  const CableHandle rope = *world.cable("rope");
  std::string faults = refused(world, [&](Edit& e) { e.remove(wheel); });
  EXPECT_THAT(faults, HasSubstr("cable \"rope\""));
  EXPECT_THAT(faults, HasSubstr("on body \"wheel\", which is removed"));
  // Also if another one has its place.
  faults = refused(world, [&](Edit& e) {
    e.remove(wheel);
    e.add(test::wheel("other wheel", {0.0, 0.0, 0.0}, 0.25, 0.05));
  });
  EXPECT_THAT(faults, HasSubstr("on body \"wheel\", which is removed"));
  faults = refused(world, [&](Edit& e) {
    e.remove(BodyHandle{});
    e.remove(JointHandle{3, 7});
    e.add(std::shared_ptr<JointDef>());
    e.pay_out(rope, 9, 1.0);
    e.pay_out(rope, 0, std::nan(""));
    e.insert(rope, 0, nullptr);
    e.remove_link(rope, 0);
    e.split(rope, 0, 2.0, "half");
    e.join(rope, rope);
    e.attach(rope, CableEnd::first, BodyId::world(), Vector3::Zero());
  });
  for (const char* text :
       {"refers to no body", "refers to no joint", "must not be null", "no span number 9",
        "cannot give", "between its ends", "from 0 to 1", "joined to itself", "attached already"}) {
    EXPECT_THAT(faults, HasSubstr(text));
  }
  // What a model would not take an edit does not, either.
  faults = refused(world, [&](Edit& e) {
    BodyDef bad = test::lump("wheel", {0.0, 0.0, 0.0}, -1.0);
    e.add(bad);
  });
  EXPECT_THAT(faults, HasSubstr("mass"));
  faults = refused(world, [&](Edit& e) {
    e.add(cable("other", {attach(BodyId{77}), attach(BodyId::world())}));
  });
  EXPECT_THAT(faults, HasSubstr("number 77"));
  faults = refused(
      world, [&](Edit& e) { e.change(wheel, [](BodyDef& def) { def.position.x() += 1.0; }); });
  EXPECT_THAT(faults, HasSubstr("move it with place()"));
  faults = refused(world, [&](Edit& e) { e.pay_out(rope, 0, -1e3); });
  EXPECT_THAT(faults, HasSubstr("cannot give"));
  faults = refused(world, [&](Edit& e) { e.pay_out(rope, 0, -0.5); });
  EXPECT_THAT(faults, HasSubstr("too short"));
  advance(world, 5);
}

TEST(Edit, AnEditWithinAStepOrAnEditIsRefused) {
  LiveWorld world = test::live(test::Atwood{}.machine());
  const LiveSnapshot snapshot = world.snapshot();
  int calls = 0;
  ASSERT_TRUE(
      world
          .step({},
                [&] {
                  ++calls;
                  EXPECT_FALSE(world.edit([](Edit&) {}).ok());
                  EXPECT_FALSE(world.restore(snapshot).empty());
                  EXPECT_FALSE(world.restore(snapshot.state()).empty());
                  EXPECT_FALSE(
                      world.place(*world.body("left"), {0.0, 0.0, 0.0}, {}, Keep::length).ok());
                })
          .ok());
  EXPECT_GT(calls, 0);
  edit(world, [&](Edit&) {
    EXPECT_THAT(test::text(world.edit([](Edit&) {}).errors()), HasSubstr("from within"));
    const std::uint64_t before = hash(world.state());
    EXPECT_TRUE(world.step().stopped);
    EXPECT_EQ(hash(world.state()), before);
  });
  // What throws leaves a world that can be used.
  EXPECT_THROW(static_cast<void>(world.edit([](Edit&) { throw std::runtime_error("no"); })),
               std::runtime_error);
  edit(world, [](Edit&) {});
  EXPECT_TRUE(world.restore(snapshot).empty());
}

TEST(Edit, NamesMustDiffer) {
  LiveWorld world = test::live(test::Atwood{}.machine());
  const CableHandle rope = world.cables()[0];
  EXPECT_THAT(refused(world, [&](Edit& e) { e.split(rope, 0, 0.5, *world.name(rope)); }),
              HasSubstr("names must differ"));
  EXPECT_THAT(refused(world, [&](Edit& e) { e.split(rope, 0, 0.5, ""); }), HasSubstr("not empty"));
}

TEST(Edit, ASnapshotRestoresAcrossEdits) {
  LiveWorld world = live(test::Atwood{}.machine());
  advance(world, 7);
  const LiveSnapshot before = world.snapshot();
  const BodyHandle wheel = *world.body("wheel");
  const CableHandle rope = *world.cable("rope");
  const auto play = [&] {
    BodyHandle added;
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(world.step().ok());
      if (i % 20 == 3) {
        edit(world, [&](Edit& e) { added = e.add(test::lump("extra", {3.0, 0.0, 0.0}, 1.0)); });
      }
      if (i % 20 == 13) edit(world, [&](Edit& e) { e.remove(added); });
      if (i % 20 == 9) edit(world, [&](Edit& e) { e.pay_out(rope, 0, 0.01); });
      if (i == 100) edit(world, [&](Edit& e) { e.remove(rope); });
      if (i == 100) break;
    }
  };
  play();
  EXPECT_FALSE(world.tension(rope, 0).ok());
  const std::uint64_t first = hash(world.state());
  ASSERT_TRUE(world.restore(before).empty());
  EXPECT_EQ(hash(world.state()), hash(before.state()));
  EXPECT_TRUE(world.tension(rope, 0).ok()) << "handles of then are good again";
  EXPECT_TRUE(world.pose(wheel).ok());
  play();
  EXPECT_EQ(hash(world.state()), first);
  LiveWorld other = live(test::Atwood{}.machine());
  EXPECT_FALSE(other.restore(before).empty()) << "not a snapshot of its own";
}

// What is seen when all is put together is told of the handle's slot, wherever in its list the part
// then is.
TEST(Edit, FaultsOfPartsHaveThePathsOfTheirHandles) {
  test::Machine machine = empty(IntegratorKind::rattle);
  machine.model.add(test::lump("one", {0.0, 0.0, 0.0}, 1.0));
  machine.model.add(test::lump("two", {2.0, 0.0, 0.0}, 1.0));
  for (const char* name : {"first", "second"}) {
    auto joint = std::make_shared<BallJoint>();
    joint->name = name;
    joint->body_b = {std::string_view(name) == "first" ? 0 : 1};
    machine.model.joints.push_back(joint);
    machine.cables.push_back(
        cable(std::string("rope ") + name, {attach(BodyId::world()), attach(joint->body_b)}));
  }
  LiveWorld world = live(machine);
  JointHandle hinge;
  CableHandle rope;
  const Result<EditReport> done = world.edit([&](Edit& e) {
    // Their slots are free then, and their places in the lists are not.
    e.remove(*world.joint("first"));
    e.remove(*world.cable("rope first"));
    auto joint = std::make_shared<HingeJoint>();
    joint->name = "hinge";
    joint->body_b = {0};
    joint->axis = Vector3::Zero();
    hinge = e.add(joint);
    rope = e.add(cable("rope", {attach(BodyId::world())}));
    ColliderDef collider;
    collider.body = {1};
    collider.restitution = 2.0;
    e.add(collider);
  });
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(hinge.slot, 0);
  EXPECT_EQ(rope.slot, 0);
  std::vector<std::string> paths;
  for (const Error& error : done.errors()) paths.push_back(error.path);
  EXPECT_THAT(paths, testing::UnorderedElementsAre("/joints/0/axis", "/cables/0/links",
                                                   "/colliders/1/restitution"))
      << test::text(done.errors());
}

}  // namespace
}  // namespace sheave
