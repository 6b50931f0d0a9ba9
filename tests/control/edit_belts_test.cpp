// Belts that are opened while a world runs, and cables that become belts.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/edit.h"
#include "cable/live_world.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::advance;
using test::attach;
using test::cable;
using test::edit;
using test::left;
using test::live;
using test::refused;
using test::roll;
using test::worst_figure;
using testing::HasSubstr;

constexpr double wheel_radius = 0.2;
constexpr double wheel_inertia = 0.03;
constexpr double spin = 5.0;

/// Two wheels that a belt joins and that turn; and a sled on its upper strand, which runs in
/// direction -x.
test::Machine belt_drive(IntegratorKind integrator, double sled_speed, double sled_mass) {
  test::Machine machine;
  machine.model.gravity = Vector3::Zero();
  machine.model.step = test::direct_settings(integrator, 0.002);
  for (const double x : {0.0, 2.0}) {
    BodyDef wheel = test::wheel(x > 0.0 ? "b" : "a", {x, 0.0, 0.0}, wheel_radius, wheel_inertia);
    wheel.angular_velocity = {0.0, 0.0, spin};
    machine.model.bodies.push_back(wheel);
  }
  BodyDef sled = test::weight("sled", {1.0, wheel_radius, 0.0}, sled_mass);
  sled.axis = Vector3::UnitX();
  sled.velocity = {sled_speed, 0.0, 0.0};
  machine.model.bodies.push_back(sled);
  CableDef belt = cable("belt", {roll(BodyId{0}, left), roll(BodyId{1}, left)});
  belt.closed = true;
  machine.cables = {belt};
  return machine;
}

/// The belt is opened where the sled is, and both its ends are tied to the sled.
EditReport tie_to_sled(LiveWorld& world) {
  const CableHandle belt = *world.cable("belt");
  const BodyHandle sled = *world.body("sled");
  const double at_sled = (2.0 - world.pose(sled)->position.x()) / 2.0;
  return edit(world, [&](Edit& e) {
    e.open(belt, 1, at_sled);
    e.attach(belt, CableEnd::first, e.id(sled), Vector3::Zero());
    e.attach(belt, CableEnd::last, e.id(sled), Vector3::Zero());
  });
}

// What moves with the belt already goes on with it; what rests is caught: the wheels have the
// momentum 2 I w / r along the belt, so all go on with u = (2 I / r^2) v / (2 I / r^2 + m).
TEST(EditBelts, SledIsTiedIntoARunningBelt) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double sled_speed : {-spin * wheel_radius, 0.0}) {
      const double mass = 0.7;
      LiveWorld world = live(belt_drive(integrator, sled_speed, mass));
      const CableHandle belt = *world.cable("belt");
      const double whole = *world.length(belt);
      advance(world, 3);
      const EditReport done = tie_to_sled(world);
      EXPECT_LT(std::abs(done.energy.total()), 1e-15);
      EXPECT_EQ(*world.length(belt), whole);
      advance(world, 10);
      EXPECT_EQ(*world.length(belt), whole);
      const double carried = 2.0 * wheel_inertia / (wheel_radius * wheel_radius);
      const double speed = (carried * -spin * wheel_radius + mass * sled_speed) / (carried + mass);
      // The belt is slack by rounding alone, which takes a substep to be used up.
      EXPECT_NEAR(world.pose(*world.body("sled"))->velocity.x(), speed, 1e-9);
      for (const char* wheel : {"a", "b"}) {
        EXPECT_NEAR(world.pose(*world.body(wheel))->angular_velocity.z(), -speed / wheel_radius,
                    1e-8);
      }
      EXPECT_LT(worst_figure(world), 1e-6);
    }
  }
}

// Opened and joined again, at the other strand too, it is the belt that it was, but for where its
// links begin.
TEST(EditBelts, ABeltOpenedAndJoinedAtOnceIsUnchanged) {
  for (const int span : {0, 1}) {
    LiveWorld world = live(belt_drive(IntegratorKind::rattle, 0.0, 1.0));
    const CableHandle belt = *world.cable("belt");
    advance(world, 3);
    const double whole = *world.length(belt);
    const double first = *world.rest_length(belt, 0);
    const double second = *world.rest_length(belt, 1);
    edit(world, [&](Edit& e) {
      e.open(belt, span, 0.3);
      e.join(belt, belt);
    });
    EXPECT_EQ(*world.length(belt), whole);
    EXPECT_EQ(*world.rest_length(belt, 0), span == 0 ? second : first);
    EXPECT_EQ(*world.rest_length(belt, 1), span == 0 ? first : second);
    advance(world, 100);
    EXPECT_EQ(*world.length(belt), whole);
    for (const char* wheel : {"a", "b"}) {
      EXPECT_NEAR(world.pose(*world.body(wheel))->angular_velocity.z(), spin, 1e-10);
    }
    EXPECT_LT(worst_figure(world), 1e-6);
  }
}

// A rope over two wheels whose ends are spliced drives the second wheel: all turn on with half the
// momentum.
TEST(EditBelts, RopeIsSplicedToABelt) {
  test::Machine machine = belt_drive(IntegratorKind::rattle, 0.0, 1.0);
  machine.model.bodies[1].angular_velocity = Vector3::Zero();
  const Vector3 here(1.0, wheel_radius, 0.0);
  machine.cables = {cable("rope", {attach(BodyId::world(), here), roll(BodyId{0}, left),
                                   roll(BodyId{1}, left), attach(BodyId::world(), here)})};
  // Until it is spliced nothing is taut: of rope there is more than enough.
  machine.cables[0].rest_lengths = {1.5, 2.5, 1.5};
  LiveWorld world = live(machine);
  const CableHandle rope = *world.cable("rope");
  advance(world, 3);
  const double whole = *world.length(rope);
  edit(world, [&](Edit& e) {
    e.detach(rope, CableEnd::first);
    e.detach(rope, CableEnd::last);
    e.join(rope, rope);
  });
  EXPECT_EQ(*world.length(rope), whole);
  advance(world, 1000);
  EXPECT_EQ(*world.length(rope), whole);
  for (const char* wheel : {"a", "b"}) {
    EXPECT_NEAR(world.pose(*world.body(wheel))->angular_velocity.z(), 0.5 * spin, 1e-9) << wheel;
  }
  EXPECT_LT(worst_figure(world), 1e-6);
}

TEST(EditBelts, CutBeltIsOpenedWhereItIsCut) {
  test::Machine machine = belt_drive(IntegratorKind::rattle, 0.0, 1.0);
  machine.cables[0].cut_time = 0.003;
  LiveWorld world = live(machine);
  const CableHandle belt = *world.cable("belt");
  advance(world, 3);
  ASSERT_TRUE(world.simulation().cable_reports()[0].cut);
  const double whole = *world.length(belt);
  EXPECT_THAT(refused(world, [&](Edit& e) { e.pay_out(belt, 0, 0.1); }), HasSubstr("open it"));
  edit(world, [&](Edit& e) {
    e.open(belt, 77, 0.5);
    e.join(belt, belt);
  });
  EXPECT_FALSE(world.simulation().cable_reports()[0].cut);
  EXPECT_EQ(*world.length(belt), whole);
  advance(world, 100);
  EXPECT_EQ(*world.length(belt), whole);
  EXPECT_LT(worst_figure(world), 1e-6);
}

TEST(EditBelts, ImpossibleEditsAreReported) {
  test::Machine machine = belt_drive(IntegratorKind::rattle, 0.0, 1.0);
  machine.cables.push_back(
      cable("tether", {attach(BodyId::world(), {1.0, 2.0, 0.0}), attach(BodyId{2})}));
  LiveWorld world = live(machine);
  const CableHandle belt = *world.cable("belt");
  const CableHandle tether = *world.cable("tether");
  const std::string faults = refused(world, [&](Edit& e) {
    static_cast<void>(e.split(belt, 0, 0.5, "half"));
    e.open(tether, 0, 0.5);
    e.open(belt, 2, 0.5);
    e.open(belt, 0, 1.5);
    e.join(tether, tether);
    e.join(belt, belt);
    e.detach(tether, CableEnd::first);
    e.detach(tether, CableEnd::last);
    e.attach(tether, CableEnd::first, e.id(*world.body("sled")), Vector3::Zero());
  });
  for (const char* text :
       {"\"belt\" is closed and cannot be split in two; open it", "\"tether\" is open; split it",
        "has no span number 2", "must be from 0 to 1, not 1.5",
        "\"tether\" cannot be joined to itself: both its ends must be loose",
        "\"belt\" cannot be joined to itself"}) {
    EXPECT_THAT(faults, HasSubstr(text));
  }
  EXPECT_THAT(refused(world,
                      [&](Edit& e) {
                        e.detach(tether, CableEnd::first);
                        e.detach(tether, CableEnd::last);
                        e.attach(tether, CableEnd::first, e.id(*world.body("sled")),
                                 Vector3::Zero());
                        e.detach(tether, CableEnd::first);
                        e.join(tether, tether);
                      }),
              HasSubstr("a belt needs at least 2 links"));
}

}  // namespace
}  // namespace sheave
