// A load that a rope lifts off the ground: the dynamic factor of hoists.
//
// A rope of the length L and the stiffness EA is just taut above a load m on the ground, and its upper end
// moves up with v. The load leaves the ground at the stretch m g L / EA with the rate v of the stretch, so
// the tension is m g + v sqrt(EA m / L) sin(w t) with w^2 = EA / m L, and its largest value over m g is
// the factor 1 + (v / g) sqrt(EA / m L).

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/shapes/sphere.h"
#include "tests/support/builders.h"

namespace sheave::lifted_load {
namespace {

using test::attach;
using test::cable;

constexpr double mass = 5000.0;
constexpr double length = 20.0;
constexpr double stiffness = 13e6;

/// The load on the ground below the end of a hoist, and `count` - 1 beads of the rope between.
test::Machine hoist(const StepSettings& step, int count, double density) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.ground = GroundDef{};
  BodyDef load = test::weight("load", {0.0, 0.5, 0.0}, mass);
  load.shapes = {};
  auto ball = std::make_shared<Sphere>();
  ball->radius = 0.5;
  load.shapes.push_back({ball});
  m.model.add(load);
  BodyDef top;
  top.name = "top";
  top.mobility = Mobility::kinematic;
  top.position = {0.0, 0.5 + length, 0.0};
  top.velocity = {0.0, 0.3, 0.0};
  m.model.add(top);
  CableDef rope;
  rope.name = "rope";
  rope.axial_stiffness = stiffness;
  rope.links.push_back(attach({1}));
  // The beads begin where the weight of the rope below them stretches it.
  const double piece = length / count;
  const double w = density * test::g;
  for (int i = 1; i < count; ++i) {
    const double hung = length - i * piece;
    const double low = hung + 0.5 * w * hung * hung / stiffness;
    m.model.add(test::weight("bead" + std::to_string(i), {0.0, 0.5 + low, 0.0}, density * piece));
    rope.links.push_back(attach({1 + i}));
  }
  rope.links.push_back(attach({0}));
  m.model.bodies[1].position.y() = 0.5 + length + 0.5 * w * length * length / stiffness;
  rope.rest_lengths.assign(static_cast<std::size_t>(count), piece);
  m.cables.push_back(rope);
  return m;
}

/// Largest tension at the upper end.
double peak(const test::Machine& machine, double time) {
  Simulation s = test::start(machine);
  double most = 0.0;
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
    most = std::max(most, s.cable_reports()[0].spans[0].start_force.norm());
  }
  return most;
}

TEST(LiftedLoad, HasTheDynamicFactorOfItsSpeed) {
  const double factor = 1.0 + 0.3 / test::g * std::sqrt(stiffness / (mass * length));
  EXPECT_NEAR(factor, 1.348678, 5e-7);
  // With h w = 5.7e-3 the samples miss the peak by (h w)^2 / 8, and the rule of second order shifts the
  // frequency and the instant of lift-off by (h w)^2: together below 3e-5 of the dynamic part.
  StepSettings step = test::direct_settings(IntegratorKind::rattle, 5e-4);
  EXPECT_NEAR(peak(hoist(step, 1, 0.0), 0.6), 66152.63, 3e-5 * 17102.63);
  // `xpbd` is of first order.
  const double coarse =
      peak(hoist(test::direct_settings(IntegratorKind::xpbd, 2e-4), 1, 0.0), 0.6) - 66152.63;
  const double fine =
      peak(hoist(test::direct_settings(IntegratorKind::xpbd, 1e-4), 1, 0.0), 0.6) - 66152.63;
  EXPECT_NEAR(coarse / fine, 2.0, 0.1);
}

/// A hoist whose speed rises smoothly, v (1 - cos 2 pi f t), so that no waves run in the rope.
test::Machine smooth(test::Machine m) {
  const double f = 1.0;
  BodyDef& top = m.model.bodies[1];
  top.oscillation = {0.0, 0.3 / (2.0 * std::numbers::pi * f), 0.0};
  top.oscillation_frequency = f;
  top.oscillation_phase = std::numbers::pi;
  return m;
}

TEST(LiftedLoad, OnARopeWithMassIsThatOfAChainOfBeads) {
  const double density = 1.05;
  const StepSettings step = test::direct_settings(IntegratorKind::rattle, 5e-4);
  test::Machine rope = smooth(hoist(step, 1, density));
  rope.cables[0].linear_density = density;
  rope.cables[0].axial_inertia = true;
  const double found = peak(rope, 1.0);
  const double beads = peak(smooth(hoist(step, 32, density)), 1.0);
  EXPECT_NEAR(found, beads, 1e-3 * beads);
  // The mass matters: without it the peak is lower by about the weight of the rope.
  EXPECT_GT(found, peak(smooth(hoist(step, 1, 0.0)), 1.0) + 0.8 * density * length * test::g);
}

}  // namespace
}  // namespace sheave::lifted_load
