// What is set of cables while a world runs, against closed forms.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/instants.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::down;
using test::g;
using test::right;
using test::roll;

void let_run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step().ok());
}

TEST(ControlsFeed, ARampIsItsIntegral) {
  test::Machine machine;
  machine.model.gravity = down;
  const BodyId load = machine.model.add(test::weight("load", Vector3::Zero(), 2.0));
  auto mouth = attach(BodyId::world(), {0.0, 3.0, 0.0});
  mouth->feed_speed = 0.0;
  machine.cables.push_back(cable("rope", {mouth, attach(load)}));
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01, 2);
  Simulation s = test::start(machine);
  let_run(s.world, 5);
  EXPECT_NEAR(s.world.position({0}).y(), 0.0, 1e-12);
  ASSERT_TRUE(s.set_feed_speed(0, 0, {-0.8, 0.4}).empty());
  let_run(s.world, 20);
  const double tension = s.cable_reports()[0].spans[0].tension;
  EXPECT_NEAR(tension, 2.0 * (g + 2.0), 1e-7);
  let_run(s.world, 30);
  EXPECT_NEAR(s.world.position({0}).y(), 0.5 * 0.8 * 0.4 + 0.8 * 0.1, 1e-9);
  EXPECT_NEAR(s.cable_reports()[0].length_error, 0.0, 1e-15);
  ASSERT_TRUE(s.clear_feed_speed(0, 0).empty());
  let_run(s.world, 1);
  // A stop at once throws the load up; the cable stays as long as it is.
  EXPECT_NEAR(s.cable_reports()[0].links[0].fed, -0.24, 1e-9);
}

TEST(ControlsCable, ComplianceActsAsTheSetSpring) {
  for (const bool wheel : {false, true}) {
    test::Machine machine;
    machine.model.gravity = down;
    const BodyId load = machine.model.add(test::weight("load", Vector3::Zero(), 2.0));
    machine.cables.push_back(
        cable("rope", {attach(BodyId::world(), {0.0, 3.0, 0.0}), attach(load)}));
    if (wheel) {
      const BodyId drum = machine.model.add(test::wheel("drum", {-0.2, 3.0, 0.0}, 0.2, 0.1));
      machine.model.bodies[1].drive = DriveKind::speed;
      machine.model.bodies[1].drive_values = {0.0};
      auto on = roll(drum, right);
      on->stored_length = 1.0;
      machine.cables[0].links[0] = on;
    }
    machine.cables[0].compliance = 1e-4;
    machine.cables[0].damping = 200.0;
    machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01, 2);
    Simulation s = test::start(machine);
    let_run(s.world, 300);
    EXPECT_NEAR(s.world.position({0}).y(), -2.0 * g * 1e-4, 1e-9);
    ASSERT_TRUE(s.set_compliance(0, 3e-4).empty());
    // At the moment the stretch is what it was.
    EXPECT_NEAR(s.world.energy().elastic, 0.5 * std::pow(2.0 * g * 1e-4, 2.0) / 3e-4, 1e-9);
    let_run(s.world, 300);
    EXPECT_NEAR(s.world.position({0}).y(), -2.0 * g * 3e-4, 1e-9);
    ASSERT_TRUE(s.clear_compliance(0).empty());
    EXPECT_TRUE(s.world.state().controls.empty());
    let_run(s.world, 300);
    EXPECT_NEAR(s.world.position({0}).y(), -2.0 * g * 1e-4, 1e-9);
  }
}

// A rope with a turn and a half round a post holds e^(m a) as much as pulls at its other end.
TEST(ControlsCable, FrictionActsAsTheSetCoefficient) {
  test::Machine machine;
  machine.model.gravity = down;
  BodyDef post = test::wheel("post", Vector3::Zero(), 0.2, 1.0);
  post.mobility = Mobility::fixed;
  const BodyId on = machine.model.add(post);
  const BodyId light = machine.model.add(test::weight("light", {-0.2, -3.0, 0.0}, 1.0));
  const BodyId heavy = machine.model.add(test::weight("heavy", {0.2, -3.0, 0.0}, 2.0));
  auto over = roll(on, right);
  over->friction = 0.3;
  machine.cables.push_back(cable("rope", {attach(light), over, attach(heavy)}));
  machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.005, 2);
  Simulation s = test::start(machine);
  let_run(s.world, 20);
  // e^(0.3 pi) = 2.57 holds 2 : 1.
  EXPECT_NEAR(s.world.velocity(heavy).y(), 0.0, 1e-9);
  ASSERT_TRUE(s.set_friction(0, 1, 0.1).empty());
  let_run(s.world, 20);
  const double k = std::exp(0.1 * pi);
  const double a = (2.0 - k) * g / (2.0 + k);
  EXPECT_NEAR(s.world.velocity(heavy).y(), -a * 0.1, 1e-6);
  const CableReport rope = s.cable_reports()[0];
  EXPECT_NEAR(rope.spans[1].tension / rope.spans[0].tension, k, 1e-6);
  ASSERT_TRUE(s.clear_friction(0, 1).empty());
  EXPECT_TRUE(s.world.state().controls.empty());
}

TEST(ControlsCable, BreaksAtATensionThatIsSet) {
  for (const bool defined : {false, true}) {
    test::Machine machine;
    machine.model.gravity = down;
    const BodyId load = machine.model.add(test::weight("load", Vector3::Zero(), 2.0));
    machine.cables.push_back(
        cable("rope", {attach(BodyId::world(), {0.0, 3.0, 0.0}), attach(load)}));
    if (defined) machine.cables[0].breaking_tension = 100.0;
    machine.model.step = test::direct_settings(IntegratorKind::rattle, 0.01, 2);
    Simulation s = test::start(machine);
    let_run(s.world, 10);
    ASSERT_TRUE(s.set_breaking_tension(0, 25.0).empty());
    let_run(s.world, 10);
    EXPECT_FALSE(s.cable_reports()[0].cut);
    ASSERT_TRUE(s.set_breaking_tension(0, 15.0).empty());
    let_run(s.world, 1);
    EXPECT_TRUE(s.cable_reports()[0].cut);
    ASSERT_TRUE(s.clear_breaking_tension(0).empty());
    let_run(s.world, 10);
    // It breaks at once, after the shortest part of a substep.
    const double held = instant_slop(machine.model.step);
    EXPECT_NEAR(s.world.velocity(load).y(), -g * (0.11 - held), 1e-9);
    // Another world that has never been told of it is cut by the state alone.
    Simulation other = test::start(machine);
    ASSERT_TRUE(other.world.restore(s.world.state()).empty());
    EXPECT_TRUE(other.cable_reports()[0].cut);
    EXPECT_EQ(other.cable_reports()[0].spans[0].tension, 0.0);
    let_run(s.world, 10);
    let_run(other.world, 10);
    EXPECT_EQ(hash(s.world.state()), hash(other.world.state()));
  }
}

}  // namespace
}  // namespace sheave
