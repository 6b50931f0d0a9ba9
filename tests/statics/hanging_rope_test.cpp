// Ropes with weight at rest, and their small vibrations, against closed forms and chains of weights.

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "statics/supports.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;
using testing::tension;

/// A rope from (0, 0) over a load of `mass` to (100, 0), with rest lengths of 44 and 60 m.
std::string loaded_line(double mass, double density) {
  return fmt::format(
      R"("bodies": [{{"name": "load", "mobility": "free", "position": [40, -15, 0], "mass": {}, "shape": {{"type": "sphere", "radius": 0.1}}}}],
      "cables": [{{"name": "line", "linear_density": {}, "axial_stiffness": 1e7, "rest_lengths": [44, 60],
        "links": [{{"type": "attachment", "body": "world"}}, {{"type": "attachment", "body": "load"}},
                  {{"type": "attachment", "body": "world", "point": [100, 0, 0]}}]}}])",
      mass, density);
}

TEST(HangingRope, HangsBetweenFixedPointsAsPublished) {
  // The published spans have 10.3005 N/m; g is 10 m/s2 here.
  const Simulation s = simulation_of(
      R"("cables": [{"name": "rope", "linear_density": 1.03005, "axial_stiffness": 13e6, "rest_lengths": [105],
        "links": [{"type": "attachment", "body": "world"},
                  {"type": "attachment", "body": "world", "point": [100, 30, 0]}]}])");
  const SpanReport span = s.cable_reports()[0].spans[0];
  EXPECT_NEAR(span.start_force.x(), 2617.46082, 6e-6);
  EXPECT_NEAR(span.end_force.x(), -2617.46082, 6e-6);
  EXPECT_NEAR(span.start_force.norm(), 2629.81058, 6e-6);
  EXPECT_NEAR(span.end_force.norm(), 2938.75941, 6e-6);
}

TEST(HangingRope, HasItsPretensionAlongItsChord) {
  const Simulation s = simulation_of(
      R"("cables": [{"name": "rope", "linear_density": 1.03005, "axial_stiffness": 13e6, "pretension": 2000,
        "links": [{"type": "attachment", "body": "world"},
                  {"type": "attachment", "body": "world", "point": [100, 30, 0]}]}])");
  EXPECT_NEAR(tension(s, 0, 0), 2000.0, 1e-6);
  EXPECT_GT(s.cable_reports()[0].spans[0].rest_length, 105.0);
}

TEST(HangingRope, SupportsBearRopeAndLoad) {
  Simulation s = simulation_of(loaded_line(30.0, 1.05));
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const std::vector<SupportReaction> supports = support_reactions(s, rest.forces);
  ASSERT_EQ(supports.size(), 1U);
  const double weight = 10.0 * (30.0 + 1.05 * 104.0);
  EXPECT_LE((supports[0].force - Vector3(0.0, weight, 0.0)).norm(), 1e-9 * weight);
}

/// Height at which a load of 30 kg rests between ropes of `count` segments in all, weights of the
/// same mass between them and half of one at the load.
double height_on_beads(int count) {
  const double density = 1.05;
  const double piece = 104.0 / count;
  std::string bodies;
  std::string links = R"({"type": "attachment", "body": "world"})";
  std::string lengths;
  for (int i = 1; i < count; ++i) {
    const double s = i * piece;
    const bool load = std::abs(s - 44.0) < 0.5 * piece;
    const double x = s < 44.0 ? 40.0 * s / 44.0 : 40.0 + 60.0 * (s - 44.0) / 60.0;
    const double y = s < 44.0 ? -15.0 * s / 44.0 : -15.0 * (104.0 - s) / 60.0;
    bodies += fmt::format(
        R"({}{{"name": "b{}", "mobility": "planar", "axis": [0, 0, 1], "position": [{}, {}, 0], "mass": {}, "shape": {{"type": "sphere", "radius": 0.1}}}})",
        i > 1 ? "," : "", i, x, y, density * piece + (load ? 30.0 : 0.0));
    links += fmt::format(R"(, {{"type": "attachment", "body": "b{}"}})", i);
  }
  for (int i = 0; i < count; ++i) lengths += fmt::format("{}{}", i > 0 ? "," : "", piece);
  links += R"(, {"type": "attachment", "body": "world", "point": [100, 0, 0]})";
  Simulation s = simulation_of(fmt::format(
      R"("bodies": [{}], "cables": [{{"name": "line", "axial_stiffness": 1e7, "rest_lengths": [{}], "links": [{}]}}])",
      bodies, lengths, links));
  const Equilibrium rest = find_equilibrium(s);
  EXPECT_TRUE(rest.converged) << rest.message;
  return s.world.position({static_cast<int>(std::lround(44.0 / piece)) - 1}).y();
}

TEST(HangingRope, IsTheLimitOfAChainOfWeights) {
  Simulation s = simulation_of(loaded_line(30.0, 1.05));
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const double height = s.world.position({0}).y();
  // Pieces of 4 m and 2 m put a bead at the load. Lumped weights are of second order, and
  // Richardson's extrapolation leaves a term of fourth order: (2 m / 44 m)^4 of the sag of 18 m, 8e-5 m.
  const double coarse = height_on_beads(26);
  const double fine = height_on_beads(52);
  EXPECT_NEAR((coarse - height) / (fine - height), 4.0, 0.05);
  EXPECT_NEAR(fine + (fine - coarse) / 3.0, height, 8e-5);
}

TEST(HangingRope, SwingsBelowAHeavyRope) {
  // A rope without inertia takes the load back by H = w x / ln(1 + W / M g) for a small displacement
  // x: T dx / dz is constant along it. So w^2 = rho g / (M ln(1 + W / M g)).
  Simulation s = simulation_of(
      R"("bodies": [{"name": "load", "mobility": "free", "position": [0, -10, 0], "mass": 10, "shape": {"type": "sphere", "radius": 0.1}}],
      "cables": [{"name": "rope", "linear_density": 2, "axial_stiffness": 1e12,
        "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}])");
  ASSERT_TRUE(find_equilibrium(s).converged);
  const Modes modes = find_modes(s);
  const double square = 2.0 * 10.0 / (10.0 * std::log(1.0 + 2.0 * 10.0 / 10.0));
  int swings = 0;
  for (const Mode& mode : modes.modes) {
    if (mode.eigenvalue > 0.0 && mode.eigenvalue < 100.0) {
      // The differences of forces of 300 N by 1e-4 m or less have this rounding.
      EXPECT_NEAR(mode.eigenvalue, square, 1e-7 * square);
      ++swings;
    }
  }
  EXPECT_EQ(swings, 2);
}

TEST(HangingRope, RestsTheSameUnderAllDescriptions) {
  // From the other end, turned in space, and in millimetres, tonnes and seconds.
  Simulation s = simulation_of(loaded_line(30.0, 1.05));
  ASSERT_TRUE(find_equilibrium(s).converged);
  Simulation reversed = simulation_of(
      R"("bodies": [{"name": "load", "mobility": "free", "position": [0, -15, 40], "mass": 30, "shape": {"type": "sphere", "radius": 0.1}}],
      "cables": [{"name": "line", "linear_density": 1.05, "axial_stiffness": 1e7, "rest_lengths": [60, 44],
        "links": [{"type": "attachment", "body": "world", "point": [0, 0, 100]},
                  {"type": "attachment", "body": "load"}, {"type": "attachment", "body": "world"}]}])");
  ASSERT_TRUE(find_equilibrium(reversed).converged);
  Simulation small = simulation_of(
      R"("bodies": [{"name": "load", "mobility": "free", "position": [40000, -15000, 0], "mass": 0.03, "shape": {"type": "sphere", "radius": 100}}],
      "cables": [{"name": "line", "linear_density": 1.05e-6, "axial_stiffness": 1e7, "rest_lengths": [44000, 60000],
        "links": [{"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"},
                  {"type": "attachment", "body": "world", "point": [100000, 0, 0]}]}])",
      "[0,-10000,0]");
  ASSERT_TRUE(find_equilibrium(small).converged);
  const double first = tension(s, 0, 0);
  const double second = tension(s, 0, 1);
  // The search ends at residuals of 1e-11 of the forces.
  EXPECT_NEAR(tension(reversed, 0, 1), first, 1e-8 * first);
  EXPECT_NEAR(tension(reversed, 0, 0), second, 1e-8 * second);
  EXPECT_NEAR(tension(small, 0, 0), first, 1e-8 * first);
  EXPECT_NEAR(tension(small, 0, 1), second, 1e-8 * second);
}

}  // namespace
}  // namespace sheave
