// Cables that are taken apart and put together while a world runs.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cable/edit.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "cable/live_world.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::advance;
using test::attach;
using test::cable;
using test::edit;
using test::g;
using test::left;
using test::live;
using test::right;
using test::roll;
using test::worst_figure;
using testing::HasSubstr;

/// A body that slides along x.
BodyDef sled(const char* name, double x, double mass) {
  BodyDef body = test::weight(name, {x, 0.0, 0.0}, mass);
  body.axis = Vector3::UnitX();
  return body;
}

// Two ends that move apart are joined with some slack: when it is used up, m1 v / (m1 + m2).
TEST(EditCables, JoiningTwoMovingEndsIsAnInelasticImpact) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine;
    machine.model.step = test::direct_settings(integrator, 0.01);
    BodyDef fast = sled("fast", 0.0, 2.0);
    fast.velocity = {-3.0, 0.0, 0.0};
    machine.model.bodies = {fast, sled("slow", 2.0, 1.0)};
    CableDef a = cable("a", {attach(BodyId{0}), attach(BodyId::world(), {1.0, 0.0, 0.0})});
    CableDef b = cable("b", {attach(BodyId::world(), {1.0, 0.0, 0.0}), attach(BodyId{1})});
    a.rest_lengths = {1.5};
    b.rest_lengths = {1.25};
    machine.cables = {a, b};
    LiveWorld world = live(machine);
    const CableHandle first = *world.cable("a");
    const CableHandle second = *world.cable("b");
    advance(world, 5);
    const EditReport joined = edit(world, [&](Edit& e) {
      e.detach(first, CableEnd::last);
      e.detach(second, CableEnd::first);
      e.join(first, second);
    });
    EXPECT_EQ(joined.energy.total(), 0.0);
    EXPECT_EQ(*world.length(first), 2.75);
    EXPECT_FALSE(world.length(second).ok());
    EXPECT_EQ(*world.rest_length(first, 0), 2.75);
    advance(world, 60);
    for (const char* name : {"fast", "slow"}) {
      EXPECT_NEAR(world.pose(*world.body(name))->velocity.x(), -3.0 * 2.0 / 3.0, 1e-12) << name;
    }
    EXPECT_NEAR(world.pose(*world.body("slow"))->position.x() -
                    world.pose(*world.body("fast"))->position.x(),
                2.75, 1e-9);
  }
}

// At rest a cable that is just long enough changes neither energy nor momentum, and bears the load
// when another one goes.
TEST(EditCables, AttachingAtRestChangesNothing) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine;
    machine.model.gravity = test::down;
    machine.model.step = test::direct_settings(integrator, 0.01, 2);
    machine.model.bodies = {test::weight("load", {0.0, -2.0, 0.0}, 3.0)};
    machine.cables = {cable("old", {attach(BodyId::world()), attach(BodyId{0})})};
    LiveWorld world = live(machine);
    advance(world, 10);
    CableHandle fresh;
    const double speed = world.state().bodies[0].velocity.y();
    const EditReport added = edit(world, [&](Edit& e) {
      fresh = e.add(cable("new", {attach(BodyId::world()), attach(BodyId{0})}));
    });
    EXPECT_EQ(added.energy.total(), 0.0);
    ASSERT_EQ(added.cables.size(), 1U);
    EXPECT_NEAR(added.cables[0].added, 2.0, 1e-9);
    EXPECT_EQ(world.state().bodies[0].velocity.y(), speed);
    edit(world, [&](Edit& e) { e.remove(*world.cable("old")); });
    advance(world, 10);
    EXPECT_NEAR(*world.tension(fresh, 0), 3.0 * g, 1e-6);
    EXPECT_NEAR(world.pose(*world.body("load"))->position.y(), -2.0, 1e-9);
    EXPECT_LT(worst_figure(world), 1e-6);
  }
}

// Each span is a spring: what is released is the sum of T^2 c / 2 over those that lose their hold,
// and the weights fall.
TEST(EditCables, SplittingATautCableReleasesItsEnergy) {
  const double compliance = 1e-4;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine = test::Atwood{2.0, 2.0}.machine();
    machine.model.step = test::direct_settings(integrator, 0.005);
    machine.cables[0].compliance = compliance;
    machine.cables[0].rest_lengths.assign(2, 2.0 - 2.0 * g * compliance);
    LiveWorld world = live(machine);
    advance(world, 10);
    const CableHandle rope = *world.cable(machine.cables[0].name);
    const double whole = *world.length(rope);
    ASSERT_NEAR(*world.tension(rope, 1), 2.0 * g, 1e-6);
    const double on_right = *world.rest_length(rope, 1);
    CableHandle rest;
    const EditReport split = edit(world, [&](Edit& e) { rest = e.split(rope, 1, 0.25, "rest"); });
    // The left piece ran over the wheel, which holds no loose end.
    const double released = 2.0 * 0.5 * std::pow(2.0 * g, 2.0) * compliance;
    EXPECT_NEAR(split.energy.elastic, -released, 1e-6 * released);
    EXPECT_EQ(split.energy.kinetic, 0.0);
    EXPECT_EQ(split.energy.potential, 0.0);
    EXPECT_EQ(*world.length(rope) + *world.length(rest), whole);
    EXPECT_NEAR(**world.loose_length(rest, CableEnd::first), 0.75 * on_right, 1e-12);
    EXPECT_FALSE(world.tension(rope, 0).ok());
    EXPECT_THAT(world.tension(rope, 0).errors()[0].message, HasSubstr("hangs loose"));
    const double speed = world.pose(BodyHandle{1, 1})->velocity.y();
    advance(world, 10);
    EXPECT_NEAR(world.pose(BodyHandle{1, 1})->velocity.y(), speed - 0.05 * g, 1e-9);
    EXPECT_NEAR(world.pose(BodyHandle{2, 1})->velocity.y(), speed - 0.05 * g, 1e-9);
  }
}

// An attachment between the ends holds what is on its other side; only the loose part is gone.
TEST(EditCables, APieceKeepsItsTensionUpToItsLastAttachment) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {test::weight("upper", {0.0, -1.0, 0.0}, 1.0),
                          test::weight("lower", {0.0, -2.0, 0.0}, 2.0)};
  machine.cables = {cable("rope", {attach(BodyId::world()), attach(BodyId{0}), attach(BodyId{1})})};
  LiveWorld world = live(machine);
  advance(world, 5);
  const CableHandle rope = *world.cable("rope");
  EXPECT_NEAR(*world.tension(rope, 0), 3.0 * g, 1e-6);
  CableHandle rest;
  edit(world, [&](Edit& e) { rest = e.split(rope, 1, 0.5, "rest"); });
  advance(world, 20);
  EXPECT_NEAR(*world.tension(rope, 0), 1.0 * g, 1e-6);
  EXPECT_NEAR(world.pose(*world.body("upper"))->position.y(), -1.0, 1e-9);
  EXPECT_LT(world.pose(*world.body("lower"))->position.y(), -2.1);
  EXPECT_LT(worst_figure(world), 1e-6);
  // And the two halves are of use: the lower one catches its weight when it is tied to the upper
  // one's end.
  const double drop = -1.0 - world.pose(*world.body("lower"))->position.y();
  EditReport tied = edit(world, [&](Edit& e) {
    e.attach(rope, CableEnd::last, BodyId{1}, Vector3::Zero());
    e.pay_out(rope, 1, drop);
  });
  ASSERT_EQ(tied.cables.size(), 1U);
  EXPECT_NEAR(tied.cables[0].added, drop, 1e-12);
  EXPECT_NEAR(*world.rest_length(rope, 1), 0.5 + drop, 1e-12);
  advance(world, 100);
  EXPECT_NEAR(world.pose(*world.body("lower"))->position.y(), -1.5 - drop, 1e-9);
  EXPECT_NEAR(*world.tension(rope, 0), 3.0 * g, 1e-6);
}

// Split and joined again in one edit the cable is what it was: wheels, arcs and all, to the last
// bit.
TEST(EditCables, ACableSplitAndJoinedAgainIsUnchanged) {
  test::Machine machine = test::wheel_train(5, 1.0, 1.3, 0.2, 0.01);
  LiveWorld world = live(machine);
  LiveWorld alone = live(machine);
  advance(world, 30);
  advance(alone, 30);
  const CableHandle rope = world.cables()[0];
  const double whole = *world.length(rope);
  const EditReport report = edit(world, [&](Edit& e) {
    const CableHandle rest = e.split(rope, 2, 0.3, "rest");
    e.join(rope, rest);
  });
  EXPECT_TRUE(report.cables.empty());
  EXPECT_EQ(report.energy.total(), 0.0);
  EXPECT_EQ(*world.length(rope), whole);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(*world.rest_length(rope, i), *alone.rest_length(rope, i));
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(*world.stored_length(rope, i), *alone.stored_length(rope, i));
  }
  advance(world, 30);
  advance(alone, 30);
  for (std::size_t i = 0; i < world.state().bodies.size(); ++i) {
    EXPECT_LT((world.state().bodies[i].position - alone.state().bodies[i].position).norm(), 1e-9);
    EXPECT_NEAR(world.state().bodies[i].angle, alone.state().bodies[i].angle, 1e-9);
  }
  EXPECT_LT(std::abs(world.simulation().cable_reports()[0].length_error), 1e-15);
}

// A crane's hook rope is led over another wheel: it takes its arc from the span, and the load keeps
// its place until it moves.
TEST(EditCables, InsertedWheelTakesItsArc) {
  for (const bool elastic : {false, true}) {
    test::Machine machine;
    machine.model.gravity = test::down;
    machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01, 2);
    machine.model.bodies = {test::wheel("fixed", {0.0, 0.0, 0.0}, 0.2, 0.01),
                            test::wheel("other", {0.0, -1.0, 0.0}, 0.2, 0.01),
                            test::weight("load", {0.2, -3.0, 0.0}, 2.0)};
    CableDef rope = cable("rope", {attach(BodyId::world(), {-2.0, 0.0, 0.0}),
                                   roll(BodyId{0}, right), attach(BodyId{2})});
    if (elastic) {
      rope.axial_stiffness = 2e5;
    } else {
      rope.rest_lengths = {2.0, 3.3};
    }
    machine.cables = {rope};
    LiveWorld world = live(machine);
    advance(world, 1);
    const CableHandle handle = *world.cable("rope");
    const double whole = *world.length(handle);
    if (elastic) edit(world, [&](Edit& e) { e.pay_out(handle, 1, 0.3); });
    const double span = *world.stored_length(handle, 1) + *world.rest_length(handle, 1);
    auto wheel = roll(BodyId{1}, left);
    edit(world, [&](Edit& e) { e.insert(handle, 1, wheel); });
    EXPECT_NEAR(*world.length(handle), elastic ? whole + 0.3 : whole, 1e-14);
    const double on_wheel = *world.stored_length(handle, 2);
    EXPECT_GT(on_wheel, 0.05);
    // What it is led away from gives way, too.
    EXPECT_NEAR(*world.stored_length(handle, 1) + *world.rest_length(handle, 1) + on_wheel +
                    *world.rest_length(handle, 2),
                span, 1e-12);
    // Both sides are equally slack.
    const CableReport report = world.simulation().cable_reports()[0];
    EXPECT_NEAR(report.spans[1].length / report.spans[1].rest_length,
                report.spans[2].length / report.spans[2].rest_length, 1e-9);
    advance(world, 200);
    EXPECT_LT(std::abs(world.simulation().cable_reports()[0].length_error), 1e-14);
    EXPECT_LT(worst_figure(world), 1e-3);
    edit(world, [&](Edit& e) { e.remove_link(handle, 2); });
    EXPECT_EQ(world.simulation().cable_reports()[0].spans.size(), 2U);
    advance(world, 200);
    EXPECT_LT(worst_figure(world), 1e-3);
  }
}

// What cannot lie on it is told, and too long a way, too.
TEST(EditCables, ACableThatIsTooShortIsRefused) {
  test::Machine machine = test::Atwood{}.machine();
  LiveWorld world = live(machine);
  advance(world, 3);
  const CableHandle rope = world.cables()[0];
  const std::uint64_t before = hash(world.state());
  auto eyelet = std::make_shared<PinholeLink>();
  eyelet->point = {3.0, 0.0, 0.0};
  const Result<EditReport> done = world.edit([&](Edit& e) { e.insert(rope, 0, eyelet); });
  ASSERT_FALSE(done.ok());
  EXPECT_THAT(test::text(done.errors()), HasSubstr("too short for that, and it is rigid"));
  EXPECT_EQ(hash(world.state()), before);
}

// Where there is no way, there is nothing to share the length by.
TEST(EditCables, AnInsertedLinkNeedsSpansOfFiniteLength) {
  test::Machine machine;
  machine.model.bodies = {test::weight("load", {0.0, 0.0, 0.0}, 1.0)};
  machine.cables = {cable("rope", {attach(BodyId::world()), attach(BodyId{0})})};
  machine.cables[0].rest_lengths = {1.0};
  LiveWorld world = live(machine);
  const Result<EditReport> done =
      world.edit([&](Edit& e) { e.insert(world.cables()[0], 0, std::make_shared<PinholeLink>()); });
  ASSERT_FALSE(done.ok());
  EXPECT_THAT(done.errors()[0].message, HasSubstr("too little for the inserted link"));
}

// Also of what has been set.
TEST(EditCables, OnlyCablesWithEqualSettingsAreJoined) {
  test::Machine machine;
  machine.model.bodies = {test::weight("load", {0.0, -2.0, 0.0}, 1.0)};
  machine.cables = {cable("a", {attach(BodyId::world()), attach(BodyId{0})}),
                    cable("b", {attach(BodyId::world()), attach(BodyId{0})})};
  for (const bool set : {false, true}) {
    if (!set) machine.cables[1].breaking_tension = 1e3;
    LiveWorld world = live(machine);
    machine.cables[1].breaking_tension.reset();
    const CableHandle a = *world.cable("a");
    const CableHandle b = *world.cable("b");
    if (set) {
      ASSERT_TRUE(world.set_breaking_tension(b, 1e3).empty());
    }
    const Result<EditReport> done = world.edit([&](Edit& e) {
      e.detach(a, CableEnd::last);
      e.detach(b, CableEnd::first);
      e.join(a, b);
    });
    ASSERT_FALSE(done.ok());
    EXPECT_THAT(done.errors()[0].message, HasSubstr("different settings"));
  }
}

// A belt that has left its first wheel goes on over the others when one of these is taken out.
TEST(EditCables, WheelsAreTakenOutOfBelts) {
  test::Machine machine;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {
      test::wheel("off", {0.0, -3.0, 0.0}, 0.2, 0.01), test::wheel("a", {0.0, 0.0, 0.0}, 0.2, 0.01),
      test::wheel("b", {2.0, 0.5, 0.0}, 0.3, 0.01), test::wheel("c", {1.0, 2.0, 0.0}, 0.25, 0.01)};
  auto off = std::make_shared<RollingLink>();
  off->body = BodyId{0};
  off->winding = left;
  off->lifted = true;
  CableDef belt =
      cable("belt", {off, roll(BodyId{1}, left), roll(BodyId{2}, left), roll(BodyId{3}, left)});
  belt.closed = true;
  machine.cables = {belt};
  LiveWorld world = live(machine);
  advance(world, 3);
  const CableHandle handle = world.cables()[0];
  const double whole = *world.length(handle);
  edit(world, [&](Edit& e) { e.remove_link(handle, 1); });
  EXPECT_EQ(*world.length(handle), whole);
  advance(world, 20);
  EXPECT_EQ(*world.length(handle), whole);
  EXPECT_LT(worst_figure(world), 1e-6);
}

// A drum pays out into a piece that is tied to something else.
TEST(EditCables, RopeOfADrumIsTiedElsewhere) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {test::wheel("drum", {0.0, 0.0, 0.0}, 0.2, 0.05),
                          test::weight("first", {0.2, -2.0, 0.0}, 1.0),
                          test::weight("second", {0.2, -1.0, 0.0}, 2.0)};
  machine.model.bodies[0].drive = DriveKind::speed;
  machine.model.bodies[0].drive_values = {0.0};
  auto spool = std::make_shared<SpoolLink>();
  spool->body = BodyId{0};
  spool->winding = right;
  spool->stored_length = 3.0;
  machine.cables = {cable("rope", {spool, attach(BodyId{1})}),
                    cable("keeper", {attach(BodyId::world(), {0.2, 0.0, 0.0}), attach(BodyId{2})})};
  LiveWorld world = live(machine);
  advance(world, 5);
  const CableHandle rope = *world.cable("rope");
  edit(world, [&](Edit& e) { e.detach(rope, CableEnd::last); });
  EXPECT_NEAR(**world.loose_length(rope, CableEnd::last), 2.0, 1e-12);
  EXPECT_EQ(*world.length(rope), 5.0);
  advance(world, 1);
  edit(world, [&](Edit& e) {
    e.attach(rope, CableEnd::last, BodyId{2}, Vector3::Zero());
    e.remove(*world.cable("keeper"));
  });
  advance(world, 200);
  EXPECT_NEAR(world.pose(*world.body("second"))->position.y(), -2.0, 1e-9);
  EXPECT_NEAR(*world.tension(rope, 0), 2.0 * g, 1e-6);
  ASSERT_TRUE(world.set_speed(*world.body("drum"), 1.0).empty());
  advance(world, 100);
  // The drum has turned on by 1 rad and what the ramp to its speed takes, half a step.
  EXPECT_NEAR(std::abs(world.pose(*world.body("second"))->position.y() + 2.0), 0.2 * (1.0 - 0.005),
              1e-6);
  EXPECT_EQ(*world.length(rope), 5.0);
}

/// A drum whose rope of 3 m hangs down 2 m from it, behind a cable with many links.
test::Machine drum_behind_a_long_cable() {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {
      test::wheel("drum", {0.0, 0.0, 0.0}, 0.2, 0.05), test::weight("first", {0.2, -2.0, 0.0}, 1.0),
      test::weight("second", {1.5, -0.5, 0.0}, 2.0), test::weight("third", {5.0, -1.0, 0.0}, 1.0)};
  machine.model.bodies[0].drive = DriveKind::speed;
  machine.model.bodies[0].drive_values = {0.0};
  auto spool = std::make_shared<SpoolLink>();
  spool->body = BodyId{0};
  spool->winding = right;
  spool->stored_length = 1.0;
  CableDef many = cable("many", {attach(BodyId::world(), {3.0, 0.0, 0.0})});
  for (int i = 0; i < 4; ++i) {
    auto eyelet = std::make_shared<PinholeLink>();
    eyelet->point = {3.2 + 0.3 * i, i % 2 == 0 ? 0.2 : 0.0, 0.0};
    many.links.push_back(eyelet);
  }
  many.links.push_back(attach(BodyId{3}));
  machine.cables = {many, cable("rope", {spool, attach(BodyId{1})})};
  return machine;
}

// Tied elsewhere in one edit, the rope leaves the drum elsewhere, and the way between comes out of
// what is stored: a contact at the angle t on a drum of radius r lies at t = phi + arccos(r / d) for
// a point at the angle phi and the distance d, and the rope runs clockwise up to it.
TEST(EditCables, TheContactMovesWithTheSpanInOneEdit) {
  LiveWorld world = live(drum_behind_a_long_cable());
  const CableHandle rope = *world.cable("rope");
  const double stored = *world.stored_length(rope, 0);
  const double hanging = *world.rest_length(rope, 0);
  EXPECT_NEAR(hanging, 2.0, 1e-12);
  edit(world, [&](Edit& e) {
    e.detach(rope, CableEnd::last);
    e.attach(rope, CableEnd::last, BodyId{2}, Vector3::Zero());
  });
  const auto contact = [](double x, double y) {
    return std::atan2(y, x) + std::acos(0.2 / std::hypot(x, y));
  };
  const double way = 0.2 * (contact(1.5, -0.5) - contact(0.2, -2.0));
  EXPECT_NEAR(*world.stored_length(rope, 0), stored - way, 1e-12);
  EXPECT_NEAR(*world.rest_length(rope, 0), hanging + way, 1e-12);
}

// What has hung loose knows nothing of the world in which it did: neither of one with fewer links
// nor of one in which other cables have the numbers that it had. All that was loose is the span.
TEST(EditCables, ALooseCableKeepsNothingOfItsFormerWorld) {
  for (const bool other_cable : {false, true}) {
    LiveWorld world = live(drum_behind_a_long_cable());
    const CableHandle rope = *world.cable("rope");
    const double stored = *world.stored_length(rope, 0);
    edit(world, [&](Edit& e) { e.detach(rope, CableEnd::last); });
    const double loose = **world.loose_length(rope, CableEnd::last);
    EXPECT_NEAR(loose, 2.0, 1e-12);
    edit(world, [&](Edit& e) {
      const auto from = attach(BodyId::world(), {-1.0, 0.5, 0.0});
      if (other_cable) e.add(cable("other", {from, attach(BodyId{1})}));
    });
    edit(world, [&](Edit& e) { e.attach(rope, CableEnd::last, BodyId{2}, Vector3::Zero()); });
    EXPECT_EQ(*world.stored_length(rope, 0), stored) << other_cable;
    EXPECT_EQ(*world.rest_length(rope, 0), loose) << other_cable;
    advance(world, 5);
  }
}

// A cable that has been cut splits where it was cut, and both pieces can be tied to something.
TEST(EditCables, ACutLeavesTwoUsableHalves) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01);
  machine.model.bodies = {test::weight("load", {0.0, -2.0, 0.0}, 2.0)};
  machine.cables = {cable("rope", {attach(BodyId::world()), attach(BodyId{0})})};
  machine.cables[0].cut_time = 0.1;
  LiveWorld world = live(machine);
  advance(world, 20);
  const CableHandle rope = *world.cable("rope");
  EXPECT_THAT(test::text(world.edit([&](Edit& e) { e.pay_out(rope, 0, 1.0); }).errors()),
              HasSubstr("is cut; split it"));
  CableHandle rest;
  edit(world, [&](Edit& e) { rest = e.split(rope, 0, 0.25, "rest"); });
  EXPECT_EQ(**world.loose_length(rope, CableEnd::last), 0.5);
  EXPECT_EQ(**world.loose_length(rest, CableEnd::first), 1.5);
  // The lower one to a point from which it is slack.
  edit(world, [&](Edit& e) { e.attach(rest, CableEnd::first, BodyId::world(), {0.0, -1.0, 0.0}); });
  advance(world, 300);
  EXPECT_NEAR(world.pose(*world.body("load"))->position.y(), -2.5, 1e-9);
  EXPECT_NEAR(*world.tension(rest, 0), 2.0 * g, 1e-6);
}

}  // namespace
}  // namespace sheave
