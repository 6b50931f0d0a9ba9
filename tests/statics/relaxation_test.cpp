// Damped spans on both sides of a pinhole share their tension, each with its own spring k_i and the
// damper b of the cable. In series they have the impedance
//   T / E = 1 / (1 / (k_1 + b s) + 1 / (k_2 + b s))
// for motions exp(s t), k_i = EA / L_i with the unstretched lengths. It is that of one spring and one
// damper only where k_1 = k_2.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>

#include <Eigen/LU>
#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;
using Complex = std::complex<double>;

constexpr double hoist_stiffness = 300.0;  // EA [N]
constexpr double hoist_damper = 15.0;      // [N s/m]
constexpr double hoist_mass = 2.0;         // [kg]
constexpr double drum_radius = 0.2;        // of the drum [m]
// Finite differences of geometric stiffness, which these machines do not have, are exact; the rest is
// rounding of small matrices.
constexpr double pole_rounding = 1e-9;

/// A weight on a rope that comes from a drum at `across` metres, through a pinhole.
Simulation hoist(double across, double down,
                 const std::string& damping = fmt::format(R"("damping": {})", hoist_damper)) {
  Simulation simulation = simulation_of(fmt::format(
      R"("bodies": [
    {{"name": "drum", "mobility": "rotor", "mass": 1, "drive": "speed", "drive_values": [0],
      "shape": {{"type": "cylinder", "radius": {}, "length": 0.1}}}},
    {{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": {},
      "position": [{}, {}, 0]}}],
    "cables": [{{"name": "rope", "axial_stiffness": {}, {}, "links": [
      {{"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 1}},
      {{"type": "pinhole", "body": "world", "point": [{}, {}, 0]}},
      {{"type": "attachment", "body": "weight"}}]}}])",
      drum_radius, hoist_mass, across, drum_radius - down, hoist_stiffness, damping, across,
      drum_radius));
  EXPECT_TRUE(find_equilibrium(simulation).converged);
  return simulation;
}

/// k_i of the spans at rest.
std::array<double, 2> springs_of(const Simulation& simulation) {
  const CableReport report = simulation.cable_reports()[0];
  return {hoist_stiffness / report.spans[0].rest_length,
          hoist_stiffness / report.spans[1].rest_length};
}

Complex impedance(const std::array<double, 2>& k, Complex s) {
  return 1.0 / (1.0 / (k[0] + hoist_damper * s) + 1.0 / (k[1] + hoist_damper * s));
}

TEST(RelaxingSpans, PolesAreThoseOfSpansInSeries) {
  Simulation simulation = hoist(3.0, 0.5);
  const auto k = springs_of(simulation);
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.poles.size(), 3U);
  // m s2 (k1 + k2 + 2 b s) + (k1 + b s) (k2 + b s) = 0
  const double third = 2.0 * hoist_mass * hoist_damper;
  const double second = hoist_mass * (k[0] + k[1]) + hoist_damper * hoist_damper;
  const double first = hoist_damper * (k[0] + k[1]);
  const double last = k[0] * k[1];
  Complex sum = 0.0;
  for (const Complex s : modes.poles) {
    sum += s;
    const Complex left = ((third * s + second) * s + first) * s + last;
    const double size = third * std::pow(std::abs(s), 3) + last;
    EXPECT_LT(std::abs(left), pole_rounding * size) << s;
  }
  EXPECT_NEAR(sum.real(), -second / third, pole_rounding * second / third);
  EXPECT_LT(std::abs(sum.imag()), pole_rounding * second / third);
}

TEST(RelaxingSpans, DampingRatioIsThatAtTheFrequencyOfTheMode) {
  Simulation simulation = hoist(3.0, 0.5);
  const auto k = springs_of(simulation);
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.modes.size(), 1U);
  const double w = std::sqrt(modes.modes[0].eigenvalue);
  EXPECT_NEAR(modes.modes[0].eigenvalue, impedance(k, 0.0).real() / hoist_mass,
              pole_rounding * w * w);
  // 2 zeta w m = Im(T / E) / w
  const double ratio = impedance(k, Complex(0.0, w)).imag() / w / (2.0 * hoist_mass * w);
  EXPECT_NEAR(modes.modes[0].damping_ratio, ratio, pole_rounding * ratio);
}

TEST(RelaxingSpans, DamperOfTheMaterialRelaxesAlikeEverywhere) {
  // Dampers of D / L_i beside springs of EA / L_i are one damper D / (L_1 + L_2).
  constexpr double material = 30.0;  // D [N s]
  Simulation simulation = hoist(3.0, 0.5, fmt::format(R"("axial_damping": {})", material));
  const CableReport report = simulation.cable_reports()[0];
  const double length = report.spans[0].rest_length + report.spans[1].rest_length;
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.poles.size(), 2U);
  const Complex sum = modes.poles[0] + modes.poles[1];
  const double wanted = material / length / hoist_mass;
  EXPECT_NEAR(sum.real(), -wanted, pole_rounding * wanted);
}

TEST(RelaxingSpans, DriveMovesTheLoadAsTheirImpedanceSays) {
  Simulation simulation = hoist(2.5, 0.4);
  const auto k = springs_of(simulation);
  ModeInput input;
  input.kind = ModeInput::Kind::drive;
  input.body = 0;
  const Modes modes = find_modes(simulation, {input});
  const Eigen::MatrixXd a = modes.state_matrix;
  ASSERT_EQ(a.rows(), 4);  // z, z', the angle of the drum, one stretch
  const Eigen::MatrixXd b = modes.input_matrix;
  for (const double w : {0.5, 5.0, 12.0, 80.0}) {
    const Complex s(0.0, w);
    const Eigen::MatrixXcd system = s * Eigen::MatrixXcd::Identity(4, 4) - a.cast<Complex>();
    const Eigen::VectorXcd x = system.lu().solve(b.col(0).cast<Complex>());
    const Complex moved = modes.motions(0, 0) * x[0] + modes.driven_motions(0, 0) * x[2];
    // The rim moves by r u / s; up is where the drum pulls.
    const Complex wanted =
        drum_radius / s * impedance(k, s) / (hoist_mass * s * s + impedance(k, s));
    EXPECT_LT(std::min(std::abs(moved - wanted), std::abs(moved + wanted)),
              pole_rounding * std::abs(wanted))
        << w;
  }
}

TEST(RelaxingSpans, TensionOfAStateCountsTheStretchOfEachSpan) {
  Simulation simulation = hoist(3.0, 0.5);
  const auto k = springs_of(simulation);
  const Modes modes = find_modes(simulation);
  const State rest = simulation.world.state();
  const double weight = simulation.cable_reports()[0].spans[0].tension;
  ModalVector x = ModalVector::Zero(3);
  constexpr double stretch = 1e-5;
  x[2] = stretch;  // of the first span, while the other one is as much shorter
  const State there = perturbed_state(simulation, modes, x);
  ASSERT_TRUE(simulation.world.restore(there).empty());
  // E = E' = 0: (k_1 - k_2) e / 2 by the mean of both spans' forces, as both have the damper b.
  const double wanted = 0.5 * (k[0] - k[1]) * stretch;
  const double found = simulation.cable_reports()[0].spans[0].tension - weight;
  EXPECT_NEAR(std::abs(found), std::abs(wanted), 1e-6 * std::abs(wanted));
  ASSERT_TRUE(simulation.world.restore(rest).empty());
}

}  // namespace
}  // namespace sheave
