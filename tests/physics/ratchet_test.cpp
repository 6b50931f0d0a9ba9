// Links that let cable slide in one direction only.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::right;
using test::wrapped;

constexpr double ratchet_hang = 10.0;  // of each weight below the post [m]

/// Two weights over a post on which cable slides only from the first weight to the second, or only
/// back. Bodies: 0 post, 1 first weight, 2 second weight.
struct Ratchet {
  double first = 1.0;   ///< [kg]
  double second = 2.0;  ///< [kg]
  double friction = 0.0;
  Passage passes = Passage::forward;

  [[nodiscard]] test::Machine machine(const StepSettings& step) const {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step;
    const BodyId post = m.model.add(test::post("post", Vector3::Zero(), 0.25));
    const BodyId one = m.model.add(test::weight("first", {-0.25, -ratchet_hang, 0.0}, first));
    const BodyId other = m.model.add(test::weight("second", {0.25, -ratchet_hang, 0.0}, second));
    auto link = wrapped(post, right, friction);
    link->passes = passes;
    m.cables.push_back(cable("rope", {attach(one), link, attach(other)}));
    return m;
  }
  /// Acceleration of the second weight downwards while cable slides forward: the tension behind the
  /// post is q = e^(friction pi) times that before it.
  [[nodiscard]] double acceleration() const {
    const double q = std::exp(friction * pi);
    return (second - q * first) * g / (second + q * first);
  }
};

class RatchetTest : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, RatchetTest, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

double ratchet_height(const Simulation& simulation, int body) {
  return simulation.world.state().bodies[static_cast<std::size_t>(body)].position.y();
}

double ratchet_rate(const Simulation& simulation, int body) {
  return simulation.world.state().bodies[static_cast<std::size_t>(body)].velocity.y();
}

// All motion is straight and uniformly accelerated, which every step has exactly but for rounding.
TEST_P(RatchetTest, PassesCableForwardWithItsFrictionOnly) {
  for (const double friction : {0.0, 0.15}) {
    const Ratchet ratchet{.friction = friction};
    Simulation simulation = test::start(ratchet.machine(step_settings(0.01, 30)));
    test::run(simulation.world, 0.5);
    EXPECT_NEAR(ratchet_rate(simulation, 2), -0.5 * ratchet.acceleration(), 1e-9);
    EXPECT_NEAR(ratchet_rate(simulation, 1), 0.5 * ratchet.acceleration(), 1e-9);
  }
}

TEST_P(RatchetTest, HoldsAnyTensionBackwards) {
  for (const double load : {2.0, 2000.0}) {
    Simulation simulation =
        test::start(Ratchet{.first = load, .second = 1.0}.machine(step_settings(0.01, 30)));
    test::run(simulation.world, 0.5);
    EXPECT_NEAR(ratchet_height(simulation, 1), -ratchet_hang, 1e-9);
    EXPECT_NEAR(ratchet_height(simulation, 2), -ratchet_hang, 1e-9);
    const CableReport report = simulation.cable_reports()[0];
    EXPECT_NEAR(report.spans[0].tension, load * g, 1e-6 * load * g);
    EXPECT_NEAR(report.spans[1].tension, g, 1e-6 * g);
    EXPECT_EQ(report.links[1].slip, 0.0);
  }
}

TEST_P(RatchetTest, BackwardIsTheMirroredLink) {
  const Ratchet mirrored{.first = 2.0, .second = 1.0, .passes = Passage::backward};
  Simulation simulation = test::start(mirrored.machine(step_settings(0.01, 30)));
  test::run(simulation.world, 0.5);
  EXPECT_NEAR(ratchet_rate(simulation, 1), -0.5 * Ratchet{}.acceleration(), 1e-9);
  const Ratchet held{.passes = Passage::backward};
  simulation = test::start(held.machine(step_settings(0.01, 30)));
  test::run(simulation.world, 0.5);
  EXPECT_NEAR(ratchet_height(simulation, 2), -ratchet_hang, 1e-9);
}

/// A pull F of 30 N on the second weight (1 kg) for 0.5 s raises the first one (2 kg), which then
/// coasts upwards and is held at its highest point:
///   a1 = (F + (m2 - m1) g) / (m1 + m2), v = a1 t, rise = v t / 2 + v^2 / (2 a2), a2 = (m1 - m2) g / (m1 + m2)
/// The link holds from the first substep in which cable would slide back. It may have slid for most
/// of a substep before, or have come a part of it back: a2 h^2 = 3e-4 m bounds both.
TEST_P(RatchetTest, KeepsTheProgressOfEachPull) {
  const Ratchet ratchet{.first = 2.0, .second = 1.0};
  Simulation simulation = test::start(ratchet.machine(step_settings(0.01, 30)));
  double expected = -ratchet_hang;
  for (int pull = 0; pull < 3; ++pull) {
    PointForce force;
    force.force = {0.0, -30.0, 0.0};
    ASSERT_TRUE(simulation.world.set_force({2}, force).empty());
    test::run(simulation.world, 2.0 * pull + 0.5);
    ASSERT_TRUE(simulation.world.clear_force({2}).empty());
    test::run(simulation.world, 2.0 * pull + 2.0);
    const double up = (30.0 - g) / 3.0;
    const double back = g / 3.0;
    expected += 0.5 * 0.5 * 0.5 * up + 0.25 * up * up / (2.0 * back);
    EXPECT_NEAR(ratchet_height(simulation, 1), expected, 1e-3 * (pull + 1));
    EXPECT_NEAR(ratchet_rate(simulation, 1), 0.0, 1e-9);
  }
}

TEST_P(RatchetTest, HoldsALoadWhoseTailIsSlack) {
  test::Machine machine = Ratchet{.first = 5.0}.machine(step_settings(0.01, 30));
  machine.cables[0].links.back() = attach(BodyId::world(), {0.25, -1.0, 0.0});
  machine.cables[0].rest_lengths = {ratchet_hang, 1.5};
  Simulation simulation = test::start(machine);
  test::run(simulation.world, 0.5);
  EXPECT_NEAR(ratchet_height(simulation, 1), -ratchet_hang, 1e-9);
  const CableReport report = simulation.cable_reports()[0];
  EXPECT_NEAR(report.spans[0].tension, 5.0 * g, 1e-6 * g);
  EXPECT_EQ(report.spans[1].tension, 0.0);
}

// The force of an elastic rope under its load: m g / c of stretch, about which the load swings
// without passing the hole.
TEST_P(RatchetTest, AHoleIsARatchetForElasticCableToo) {
  test::Machine machine;
  machine.model.gravity = test::down;
  machine.model.step = step_settings(0.002, 30);
  const BodyId load = machine.model.add(test::weight("load", {0.0, -2.0, 0.0}, 3.0));
  auto hole = test::eyelet(BodyId::world(), Vector3::Zero(), 0.0);
  hole->passes = Passage::forward;
  CableDef rope = cable("rope", {attach(load), hole, attach(BodyId::world(), {1.0, 0.0, 0.0})});
  rope.axial_stiffness = 1e4;
  machine.cables.push_back(rope);
  Simulation simulation = test::start(machine);
  test::run(simulation.world, 0.5);
  const CableReport report = simulation.cable_reports()[0];
  EXPECT_EQ(report.links[1].slip, 0.0);
  EXPECT_NEAR(report.spans[0].rest_length, 2.0, 1e-13);
  EXPECT_NEAR(report.spans[1].tension, 0.0, 1e-9);
  EXPECT_LT(ratchet_height(simulation, 0), -2.0);
}

TEST_P(RatchetTest, PassesTheChecksOfTheCertificate) {
  const Ratchet slides{.friction = 0.1};
  EXPECT_TRUE(test::checked_run(slides.machine(step_settings(0.01, 30)), 0.5).clean());
  const Ratchet holds{.first = 3.0, .second = 1.0};
  EXPECT_TRUE(test::checked_run(holds.machine(step_settings(0.01, 30)), 0.5).clean());
}

void expect_ratchet_fault(const std::function<void(RollingLink&, test::Machine&)>& spoil,
                          const std::string& word) {
  test::Machine machine = Ratchet{}.machine(test::settings(0.01, 1, 10));
  auto link =
      std::make_shared<RollingLink>(dynamic_cast<const RollingLink&>(*machine.cables[0].links[1]));
  spoil(*link, machine);
  machine.cables[0].links[1] = link;
  const Result<Simulation> made = Simulation::create(machine.model, machine.cables);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.errors()[0].path, "/cables/0/links/1/passes");
  EXPECT_NE(made.errors()[0].message.find(word), std::string::npos) << made.errors()[0].message;
}

TEST(Ratchet, NeedsFrictionAndAWheelWithInertia) {
  expect_ratchet_fault([](RollingLink& link, test::Machine&) { link.friction.reset(); },
                       "friction");
  expect_ratchet_fault(
      [](RollingLink& /*link*/, test::Machine& machine) {
        machine.model.bodies[0] = test::wheel("post", Vector3::Zero(), 0.25, 1.0);
        machine.model.bodies[0].spin_inertia = 0.0;
      },
      "spin inertia");
}

}  // namespace
}  // namespace sheave
