// Small vibrations of loads on ropes with weight (statics/refined_rows.h), against closed forms.

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// A rope of L between points at the same height, with the weight w per length, under the horizontal
/// tension H: its chord D = H L / EA + (2 H / w) asinh(u) with u = w L / 2 H, and k = dH / dD.
struct LevelRope {
  double length;
  double stiffness;  // EA
  double w;
  double horizontal;

  [[nodiscard]] double u() const { return 0.5 * w * length / horizontal; }
  [[nodiscard]] double chord() const {
    return horizontal * length / stiffness + 2.0 * horizontal / w * std::asinh(u());
  }
  [[nodiscard]] double pull_per_chord() const {
    return 1.0 / (length / stiffness + 2.0 / w * std::asinh(u()) -
                  length / horizontal / std::sqrt(1.0 + u() * u()));
  }
};

/// Ropes of `density` kg/m from both sides to the middle of a body, as the member "cables".
std::string two_ropes(const LevelRope& rope, double density) {
  std::string cables;
  for (const double side : {-1.0, 1.0}) {
    cables += fmt::format(
        R"({}{{"name": "rope{}", "linear_density": {}, "axial_stiffness": {}, "rest_lengths": [{}],
          "links": [{{"type": "attachment", "body": "world", "point": [{}, 0, 0]}},
                    {{"type": "attachment", "body": "load"}}]}})",
        cables.empty() ? "" : ", ", side > 0.0 ? 1 : 0, density, rope.stiffness, rope.length,
        side * rope.chord());
  }
  return R"("cables": [)" + cables + "]";
}

void expect_eigenvalue(const std::string& parts, double expected) {
  Simulation s = simulation_of(parts);
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  ASSERT_EQ(rest.eigenvalues.size(), 1U);
  // Differences of fourth order of a step of 1e-3 leave some 1e-9; the lengths of the search 1e-9.
  EXPECT_NEAR(rest.eigenvalues[0], expected, 1e-6 * expected);
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 1U);
  EXPECT_NEAR(modes.modes[0].eigenvalue, expected, 1e-6 * expected);
}

TEST(HeavyModes, OfALoadBetweenLevelRopesAreThoseOfTheCatenary) {
  // From ropes that hang 4 m deep to ropes that are nearly straight.
  for (const double horizontal : {30.0, 60.0, 200.0, 1000.0, 3000.0}) {
    for (const double stiffness : {1e4, 1e6}) {
      const LevelRope rope{12.0, stiffness, 10.0, horizontal};
      expect_eigenvalue(
          R"("bodies": [{"name": "load", "mobility": "slider", "axis": [1, 0, 0], "mass": 20}], )" +
              two_ropes(rope, 1.0),
          2.0 * rope.pull_per_chord() / 20.0);
    }
  }
}

TEST(HeavyModes, OfShortRopesInALargeSceneAreTheSame) {
  // Differences have steps relative to the scene, which are longer than the ropes here.
  for (const double size : {1e3, 1e4, 1e5}) {
    const LevelRope rope{12.0, 1e5, 10.0, 60.0};
    expect_eigenvalue(
        fmt::format(
            R"("bodies": [{{"name": "load", "mobility": "slider", "axis": [1, 0, 0], "mass": 20}},
                          {{"name": "far", "mobility": "static", "position": [{}, 0, 0]}}], )",
            size) +
            two_ropes(rope, 1.0),
        2.0 * rope.pull_per_chord() / 20.0);
  }
}

TEST(HeavyModes, TellWhetherRopesHoldAMast) {
  // A mast of 10 m turns about its foot; the ropes' ends bear half of their weight each.
  for (const double mass : {1.0, 1.6}) {
    const LevelRope rope{12.0, 1e5, 1.0, 6.0};
    const double inertia = 0.01;
    const double expected =
        (2.0 * rope.pull_per_chord() - (10.0 * mass + rope.w * rope.length) / 10.0) /
        (mass + inertia / 100.0);
    ASSERT_GT(expected, 0.0);
    expect_eigenvalue(
        fmt::format(
            R"("bodies": [{{"name": "load", "mobility": "planar", "mass": {}, "inertia": [{}, {}, {}]}}],
            "joints": [{{"type": "hinge", "name": "foot", "body_b": "load", "anchor": [0, -10, 0], "axis": [0, 0, 1]}}], )",
            mass, inertia, inertia, inertia) +
            two_ropes(rope, 0.1),
        expected);
  }
}

TEST(HeavyModes, OfALoadOnADrumThatStandsStillAreThoseOfItsUnstretchedLength) {
  // The weight of the rope adds no stiffness: dT / dL = EA / L0 with the damper c / L0 [N s/m].
  const std::array<std::string, 2> ends{
      R"({"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 5})",
      R"({"type": "attachment", "body": "world", "point": [0, 0, 0]})"};
  for (const std::string& end : ends) {
    for (const double stiffness : {1e4, 1e6, 5e7}) {
      for (const double damping : {0.0, 100.0}) {
        Simulation s = simulation_of(fmt::format(
            R"("bodies": [
              {{"name": "drum", "mobility": "rotor", "mass": 1, "position": [-0.5, 0, 0], "drive": "speed", "drive_values": [0],
                "shape": {{"type": "cylinder", "radius": 0.5, "length": 0.1}}}},
              {{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 100, "position": [0, -50, 0]}}],
            "cables": [{{"name": "rope", "linear_density": 1, "axial_stiffness": {}, "axial_damping": {}, "rest_lengths": [50],
              "links": [{}, {{"type": "attachment", "body": "load"}}]}}])",
            stiffness, damping, end));
        const Equilibrium rest = find_equilibrium(s);
        ASSERT_TRUE(rest.converged) << rest.message;
        const Modes modes = find_modes(s);
        ASSERT_EQ(modes.modes.size(), 1U);
        const double expected = stiffness / (50.0 * 100.0);
        EXPECT_NEAR(modes.modes[0].eigenvalue, expected, 1e-7 * expected);
        const double ratio = damping / 50.0 / 100.0 / (2.0 * std::sqrt(expected));
        EXPECT_NEAR(modes.modes[0].damping_ratio, ratio, 1e-6 * ratio);
      }
    }
  }
}

TEST(HeavyModes, OfASaggingRopeHaveNoDampingWhereTheRopeHardlyStretches) {
  // The sag takes the motion of the chord: the rope stretches by less than 1e-5 of it.
  const LevelRope rope{12.0, 1e8, 10.0, 60.0};
  std::string parts = two_ropes(rope, 1.0);
  const std::string stiff = R"("axial_stiffness")";
  for (std::size_t i = parts.find(stiff); i != std::string::npos; i = parts.find(stiff, i + 30)) {
    parts.insert(i, R"("axial_damping": 1000, )");
  }
  Simulation s = simulation_of(
      R"("bodies": [{"name": "load", "mobility": "slider", "axis": [1, 0, 0], "mass": 20}], )" +
      parts);
  ASSERT_TRUE(find_equilibrium(s).converged);
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 1U);
  EXPECT_GT(modes.modes[0].damping_ratio, 0.0);
  EXPECT_LT(modes.modes[0].damping_ratio, 1e-9);
}

}  // namespace
}  // namespace sheave
