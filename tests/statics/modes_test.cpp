// Natural frequencies against closed forms, within 1e-6.

#include "statics/modes.h"

#include <cmath>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// Differences of forces with two steps leave some 1e-10 of turning forces, and nothing of springs.
constexpr double near = 1e-6;

std::vector<double> squares(const Modes& modes) {
  std::vector<double> result;
  for (const Mode& mode : modes.modes) result.push_back(mode.eigenvalue);
  return result;
}

TEST(Modes, PhysicalPendulum) {
  // A box of 0.04 x 1 m about its upper end: m g l / (I + m l^2) with I = (1 + 0.0016) / 12.
  Simulation simulation = simulation_of(
      R"("bodies": [{"name": "rod", "mobility": "planar", "axis": [0, 0, 1], "mass": 1,
      "position": [0, -0.5, 0], "shape": {"type": "box", "size": [0.04, 1, 0.04]}}],
      "joints": [{"type": "hinge", "name": "pin", "body_b": "rod", "anchor": [0, 0, 0], "axis": [0, 0, 1], "damping": 0.2}])");
  const Modes modes = find_modes(simulation);
  ASSERT_EQ(modes.modes.size(), 1U);
  const double inertia = 1.0016 / 12.0 + 0.25;
  const double square = 10.0 * 0.5 / inertia;
  EXPECT_NEAR(modes.modes[0].eigenvalue, square, near * square);
  EXPECT_NEAR(modes.modes[0].damping_ratio, 0.2 / inertia / (2.0 * std::sqrt(square)), near);
  ASSERT_EQ(modes.poles.size(), 2U);
  EXPECT_NEAR(modes.poles[0].real(), -0.1 / inertia, near);
  EXPECT_LT(modes.imbalance, 1e-12);
}

TEST(Modes, DoublePendulum) {
  // Point-like bobs of 1 kg on strings of 1 m: w^2 = g (2 -+ sqrt 2). Strings reach the middles, so the
  // bobs' own turning is free.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "a", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [1, 1, 1], "position": [0, -1, 0]},
    {"name": "b", "mobility": "planar", "axis": [0, 0, 1], "mass": 1, "inertia": [1, 1, 1], "position": [0, -2, 0]}],
    "cables": [{"name": "u", "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "a"}]},
    {"name": "l", "links": [{"type": "attachment", "body": "a"}, {"type": "attachment", "body": "b"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const Modes modes = find_modes(simulation);
  const std::vector<double> found = squares(modes);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_NEAR(found[2], 10.0 * (2.0 - std::sqrt(2.0)), 10.0 * near);
  EXPECT_NEAR(found[3], 10.0 * (2.0 + std::sqrt(2.0)), 40.0 * near);
  // Strings are upright, so bobs begin to move along x; without stiffness they turn where they are.
  EXPECT_EQ(largest_motion(simulation, modes.modes[0]), "turn");
  EXPECT_EQ(largest_motion(simulation, modes.modes[1]), "turn");
  EXPECT_EQ(largest_motion(simulation, modes.modes[2]), "x");
  EXPECT_EQ(largest_motion(simulation, modes.modes[3]), "x");
}

TEST(Modes, BeadsOnAString) {
  // n beads of m on a string of the tension T and the length (n + 1) a, without weight:
  // w_j^2 = 4 T / (m a) sin^2(j pi / 2 (n + 1)), across.
  constexpr int n = 7;
  constexpr double pull = 50.0;
  std::string bodies;
  for (int i = 0; i < n; ++i) {
    bodies += fmt::format(
        R"({}{{"name": "b{}", "mobility": "slider", "axis": [0, 1, 0], "mass": 0.5, "position": [{}, 0, 0]}})",
        i == 0 ? "" : ", ", i, -7 + i);
  }
  // Of each span's material EA = 5000 N, shortened so that it is strained by a hundredth.
  std::string cables;
  for (int i = 0; i <= n; ++i) {
    const std::string from =
        i == 0 ? R"("body": "world", "point": [-8, 0, 0])" : fmt::format(R"("body": "b{}")", i - 1);
    const std::string to =
        i == n ? R"("body": "world", "point": [0, 0, 0])" : fmt::format(R"("body": "b{}")", i);
    cables += fmt::format(
        R"({}{{"name": "c{}", "axial_stiffness": 5000, "rest_lengths": [{}], "links": [{{"type": "attachment", {}}}, {{"type": "attachment", {}}}]}})",
        i == 0 ? "" : ", ", i, 1.0 / 1.01, from, to);
  }
  Simulation simulation =
      simulation_of("\"bodies\": [" + bodies + "], \"cables\": [" + cables + "]", "[0,0,0]");
  const std::vector<double> found = squares(find_modes(simulation));
  ASSERT_EQ(found.size(), static_cast<std::size_t>(n));
  for (int j = 1; j <= n; ++j) {
    const double sine = std::sin(j * pi / (2.0 * (n + 1)));
    const double square = 4.0 * pull / (0.5 * 1.0) * sine * sine;
    EXPECT_NEAR(found[static_cast<std::size_t>(j - 1)], square, near * square) << j;
  }
}

TEST(Modes, ElasticAtwood) {
  // Equal weights m over a wheel of I, spans of the compliance c each. The sum of stretches and the
  // wheel's turn against them: the wheel's and the weights' motion against each other, with k = 1 / c:
  // both weights alike up and down w^2 = k / m; against the wheel w^2 = k (1 / m + 2 r^2 / I).
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 1, "spin_inertia": 0.2, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "l", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [-0.5, -2, 0]},
    {"name": "r", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.5, -2, 0]}],
    "cables": [{"name": "rope", "compliance": 0.001, "links": [{"type": "attachment", "body": "l"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "r"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const std::vector<double> found = squares(find_modes(simulation));
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[0], 0.0, 1000.0 * near);
  EXPECT_NEAR(found[1], 1000.0 / 2.0, 500.0 * near);
  const double square = 1000.0 * (1.0 / 2.0 + 2.0 * 0.25 / 0.2);
  EXPECT_NEAR(found[2], square, square * near);
}

TEST(Modes, Bifilar) {
  // A bar on two parallel strings of L = 2 m at +-0.5 m from its middle: it swings with g / L along
  // and across, and turns with m g d^2 / (L I), I = m (1.2^2 + 0.1^2) / 12.
  Simulation simulation =
      simulation_of(R"("bodies": [{"name": "bar", "mass": 3, "position": [0, -2, 0],
      "shape": {"type": "box", "size": [1.2, 0.06, 0.1]}}],
    "cables": [{"name": "l", "links": [{"type": "attachment", "body": "world", "point": [-0.5, 0, 0]},
        {"type": "attachment", "body": "bar", "point": [-0.5, 0, 0]}]},
      {"name": "r", "links": [{"type": "attachment", "body": "world", "point": [0.5, 0, 0]},
        {"type": "attachment", "body": "bar", "point": [0.5, 0, 0]}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const std::vector<double> found = squares(find_modes(simulation));
  ASSERT_EQ(found.size(), 4U);  // and about its own axis nothing holds it
  EXPECT_NEAR(found[0], 0.0, 10.0 * near);
  EXPECT_NEAR(found[1], 5.0, 5.0 * near);
  EXPECT_NEAR(found[2], 5.0, 5.0 * near);
  const double square = 10.0 * 0.25 / (2.0 * (1.44 + 0.01) / 12.0);
  EXPECT_NEAR(found[3], square, square * near);
}

TEST(Modes, TackleWithAStretchingRope) {
  // Four parts over pinholes: the block hangs from 4 spans of one rope that passes freely, of the
  // total compliance c = 4 x 0.0005: stretch 4 x = c T, force 4 T: k = 16 / c.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "block", "mobility": "slider", "axis": [0, 1, 0], "mass": 8, "position": [0, -3, 0]}],
    "cables": [{"name": "rope", "compliance": 0.0005, "links": [
      {"type": "attachment", "body": "world", "point": [0, 0, 0]}, {"type": "pinhole", "body": "block"},
      {"type": "pinhole", "body": "world", "point": [0, 0, 0]}, {"type": "pinhole", "body": "block"},
      {"type": "attachment", "body": "world", "point": [0, 0, 0]}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const std::vector<double> found = squares(find_modes(simulation));
  ASSERT_EQ(found.size(), 1U);
  const double square = 16.0 / 0.002 / 8.0;
  EXPECT_NEAR(found[0], square, square * near);
}

TEST(Modes, ForcesMoveTheirBodiesAndDrivesTheirRopes) {
  // A weight of 2 kg on a rope of k = 500 N/m from a winch of r = 0.2 m. A force makes 1 / m of the
  // acceleration; the drive's angle u stretches the rope by r u: k r u / m.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "drum", "mobility": "rotor", "mass": 1, "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1},
     "drive": "speed", "drive_values": [0]},
    {"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.2, -2, 0]}],
    "cables": [{"name": "rope", "compliance": 0.002, "links": [
      {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 3}, {"type": "attachment", "body": "load"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  std::vector<ModeInput> inputs(2);
  inputs[0] = {ModeInput::Kind::force, 1, Vector3::UnitY()};
  inputs[1] = {ModeInput::Kind::drive, 0, Vector3::UnitX()};
  const Modes modes = find_modes(simulation, inputs);
  ASSERT_EQ(modes.modes.size(), 1U);
  ASSERT_EQ(modes.state_matrix.rows(), 3);
  const double per_unit = modes.motions(0, 0);  // of q per z, 1 / sqrt(m)
  EXPECT_NEAR(per_unit * modes.input_matrix(1, 0), 0.5, near);
  EXPECT_NEAR(std::abs(per_unit * modes.state_matrix(1, 2)), 500.0 * 0.2 / 2.0, 50.0 * near);
  EXPECT_EQ(modes.input_matrix(2, 1), 1.0);
  EXPECT_NEAR(modes.state_matrix(1, 0), -250.0, 250.0 * near);
}

}  // namespace
}  // namespace sheave
