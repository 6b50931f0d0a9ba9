// Bodies that are put elsewhere: with the cables' lengths or with their tensions.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "cable/live_world.h"
#include "engine/joints/hinge.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::roll;

LiveWorld place_in(const test::Machine& machine) {
  Result<LiveWorld> world = LiveWorld::create(machine.model, machine.cables);
  EXPECT_TRUE(world.ok()) << test::text(world.errors());
  return std::move(*world);
}

/// A load of 2 kg that hangs by 4 m of rope.
test::Machine plumb(std::optional<double> compliance) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = 0.01;
  const BodyId load = machine.model.add(test::lump("load", {0.0, -4.0, 0.0}, 2.0));
  CableDef rope = cable("rope", {attach(BodyId::world()), attach(load)});
  rope.compliance = compliance;
  if (compliance) rope.rest_lengths = {4.0 - 2.0 * g * *compliance};
  machine.cables.push_back(rope);
  return machine;
}

TEST(Placement, KeepingTheLengthCausesSlackOrStretch) {
  LiveWorld world = place_in(plumb(1e-3));
  const BodyHandle load = *world.body("load");
  const CableHandle rope = *world.cable("rope");
  ASSERT_TRUE(world.step().ok());
  const double rest = *world.rest_length(rope, 0);
  const double elastic = world.energy().elastic;
  Result<Placement> placed = world.place(load, {0.0, -4.1, 0.0}, {}, Keep::length);
  ASSERT_TRUE(placed.ok()) << test::text(placed.errors());
  EXPECT_TRUE(placed->cables.empty());
  EXPECT_EQ(*world.rest_length(rope, 0), rest);
  // The spring has more energy, gravity less.
  const double stretch = 2.0 * g * 1e-3;
  const double spring = 0.5 * (std::pow(stretch + 0.1, 2.0) - stretch * stretch) / 1e-3;
  EXPECT_NEAR(world.energy().elastic - elastic, spring, 1e-9);
  EXPECT_NEAR(placed->energy, spring - 2.0 * g * 0.1, 1e-9);
  placed = world.place(load, {0.0, -3.0, 0.0}, {}, Keep::length);
  ASSERT_TRUE(placed.ok());
  ASSERT_TRUE(world.step().ok());
  EXPECT_EQ(*world.tension(rope, 0), 0.0);
  EXPECT_NEAR(world.pose(load)->velocity.y(), -g * 0.01, 1e-12);
}

// A load on a rail beside a sheave of 0.3 m is put from 2 m below its axle to 0.4 m above. The rope
// then leaves the sheave by 2 a = 2 atan(0.4 / 0.3) earlier, so an arc of 0.3 x 2 a comes from the
// sheave to the span. (Before, the span kept 2 m.)
TEST(Placement, ALoadOnARailPassesItsSheave) {
  constexpr double radius = 0.3;
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step.dt = 0.01;
  machine.model.bodies = {test::wheel("sheave", Vector3::Zero(), radius, 0.05),
                          test::lump("load", {radius, -2.0, 0.0}, 2.0)};
  machine.model.bodies[1].mobility = Mobility::slider;
  machine.model.bodies[1].axis = Vector3::UnitY();
  machine.cables = {cable("rope", {attach(BodyId::world(), {-radius, -2.0, 0.0}),
                                   roll(BodyId{0}, right), attach(BodyId{1})})};
  LiveWorld world = place_in(machine);
  const CableHandle rope = *world.cable("rope");
  ASSERT_NEAR(*world.stored_length(rope, 1), pi * radius, 1e-12);
  const Result<Placement> placed =
      world.place(*world.body("load"), {radius, 0.4, 0.0}, {}, Keep::length);
  ASSERT_TRUE(placed.ok()) << test::text(placed.errors());
  const double arc = radius * 2.0 * std::atan(0.4 / radius);
  // Lengths are multiples of a quantum of some 1e-15 m.
  EXPECT_NEAR(*world.rest_length(rope, 1), 2.0 + arc, 1e-12);
  EXPECT_NEAR(*world.stored_length(rope, 1), pi * radius - arc, 1e-12);
}

TEST(Placement, KeepingTensionKeepsTheBalance) {
  for (const std::optional<double> compliance : {std::optional<double>{}, {1e-3}}) {
    LiveWorld world = place_in(plumb(compliance));
    const BodyHandle load = *world.body("load");
    const CableHandle rope = *world.cable("rope");
    ASSERT_TRUE(world.step().ok());
    for (const double y : {-5.5, -0.7}) {
      const double before = world.pose(load)->position.y();
      const Result<Placement> placed = world.place(load, {0.0, y, 0.0}, {}, Keep::tension);
      ASSERT_TRUE(placed.ok()) << test::text(placed.errors());
      ASSERT_EQ(placed->cables.size(), 1U);
      EXPECT_EQ(placed->cables[0].cable, rope);
      EXPECT_NEAR(placed->cables[0].added, before - y, 1e-12);
      EXPECT_NEAR(placed->energy, 2.0 * g * (y - before), 1e-9);
      for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
      EXPECT_NEAR(*world.tension(rope, 0), 2.0 * g, 1e-6);
      EXPECT_NEAR(world.pose(load)->position.y(), y, 1e-9);
      // What has been put in is accounted for.
      EXPECT_NEAR(world.simulation().cable_reports()[0].length_error, 0.0, 1e-15);
      std::vector<CableGauge> gauges;
      world.simulation().gauge_cables(gauges);
      EXPECT_NEAR(gauges[0].length_error, 0.0, 1e-15);
    }
    EXPECT_TRUE(world.simulation().certificate()->clean(1e-6));
  }
}

// A block on four strands: each of them gives what it has too much.
TEST(Placement, ATackleIsLifted) {
  test::Tackle tackle;
  tackle.strands = 4;
  tackle.effort = tackle.load / 4.0;
  test::Machine machine = tackle.machine();
  machine.model.step = StepSettings{};
  machine.model.step.dt = 0.01;
  LiveWorld world = place_in(machine);
  const BodyHandle block = *world.body("block");
  const CableHandle rope = *world.cable("rope");
  const Vector3 from = world.pose(block)->position;
  const Result<Placement> placed =
      world.place(block, from + Vector3{0.0, 0.5, 0.0}, {}, Keep::tension);
  ASSERT_TRUE(placed.ok()) << test::text(placed.errors());
  ASSERT_EQ(placed->cables.size(), 1U);
  EXPECT_NEAR(placed->cables[0].added, -4.0 * 0.5, 1e-12);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(world.step().ok());
  EXPECT_NEAR((world.pose(block)->position - from - Vector3{0.0, 0.5, 0.0}).norm(), 0.0, 1e-9);
  for (int span = 0; span < 5; ++span) {
    EXPECT_NEAR(*world.tension(rope, span), tackle.load * g / 4.0, 1e-6);
  }
}

/// Two loads on one rope over a wheel without friction in its axle.
test::Machine over_a_wheel() {
  test::Machine machine;
  machine.model.step.dt = 0.01;
  const BodyId wheel = machine.model.add(test::wheel("wheel", Vector3::Zero(), 0.5, 0.1));
  BodyDef load = test::lump("right", {0.5, -3.0, 0.0}, 1.0);
  load.mobility = Mobility::planar;
  const BodyId free = machine.model.add(load);
  const BodyId other = machine.model.add(test::weight("left", {-0.5, -3.0, 0.0}, 1.0));
  machine.cables.push_back(cable("rope", {attach(other), roll(wheel, right), attach(free)}));
  return machine;
}

// Where it is put decides where the rope lies; how it came there does not.
TEST(Placement, WheelsGiveAndTakeTheArcsBetween) {
  const test::Machine machine = over_a_wheel();
  LiveWorld world = place_in(machine);
  const BodyHandle load = *world.body("right");
  const CableHandle rope = *world.cable("rope");
  const Vector3 there{3.0, -1.5, 0.0};
  const double before = *world.stored_length(rope, 1);
  ASSERT_TRUE(world.place(load, there, {}, Keep::tension).ok());
  test::Machine moved = machine;
  moved.model.bodies[1].position = there;
  LiveWorld made = place_in(moved);
  const CableHandle same = *made.cable("rope");
  EXPECT_LT(*world.stored_length(rope, 1), before - 0.1);
  EXPECT_NEAR(*world.stored_length(rope, 1), *made.stored_length(same, 1), 1e-12);
  for (const int span : {0, 1}) {
    EXPECT_NEAR(*world.rest_length(rope, span), *made.rest_length(same, span), 1e-12);
  }
}

TEST(Placement, LengthsAreConservedToTheLastBit) {
  LiveWorld world = place_in(over_a_wheel());
  const BodyHandle load = *world.body("right");
  const CableHandle rope = *world.cable("rope");
  const auto total = [&] {
    return *world.rest_length(rope, 0) + *world.rest_length(rope, 1) +
           *world.stored_length(rope, 1);
  };
  const double start = total();
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.7 * i;
    // Never farther than the rope reaches.
    const Vector3 there{1.5 + 0.4 * std::cos(angle), -1.0 + 0.4 * std::sin(angle), 0.0};
    const Quaternion turned_by = rotation_by({0.0, 0.0, 0.3 * i});
    const Result<Placement> placed = world.place(load, there, turned_by, Keep::length);
    ASSERT_TRUE(placed.ok()) << test::text(placed.errors());
    ASSERT_EQ(total(), start);
  }
}

TEST(Placement, ImpossiblePlacementsAreReportedAndChangeNothing) {
  test::Machine machine = plumb(std::nullopt);
  BodyDef hand;
  hand.name = "hand";
  hand.mobility = Mobility::kinematic;
  machine.model.add(hand);
  machine.model.add(test::weight("slider", {3.0, 0.0, 0.0}, 1.0));
  machine.model.add(test::wheel("wheel", {5.0, 0.0, 0.0}, 0.2, 0.1));
  const BodyId door = machine.model.add(test::lump("door", {7.0, 0.0, 0.0}, 1.0));
  auto hinge = std::make_shared<HingeJoint>();
  hinge->name = "hinge";
  hinge->body_b = door;
  hinge->anchor = {6.5, 0.0, 0.0};
  hinge->axis = Vector3::UnitZ();
  machine.model.joints.push_back(hinge);
  LiveWorld world = place_in(machine);
  ASSERT_TRUE(world.step().ok());
  const std::uint64_t before = hash(world.state());
  const auto says = [&](const char* body, const Vector3& to, Keep keep, const char* what) {
    const Result<Placement> placed = world.place(*world.body(body), to, {}, keep);
    ASSERT_FALSE(placed.ok()) << body;
    EXPECT_NE(placed.errors()[0].message.find(what), std::string::npos)
        << placed.errors()[0].message;
  };
  says("load", {0.0, -4.3, 0.0}, Keep::length, "cable \"rope\" is 0.29999");
  says("load", {0.0, std::nan(""), 0.0}, Keep::length, "finite");
  says("hand", {0.0, 1.0, 0.0}, Keep::length, "kinematic");
  says("slider", {4.0, 0.0, 0.0}, Keep::length, "slides along its axis");
  says("wheel", {4.0, 0.0, 0.0}, Keep::length, "rotor");
  says("door", {7.0, 1.0, 0.0}, Keep::tension, "joint \"hinge\"");
  EXPECT_FALSE(world.place({}, Vector3::Zero(), {}, Keep::length).ok());
  EXPECT_EQ(hash(world.state()), before);
}

}  // namespace
}  // namespace sheave
