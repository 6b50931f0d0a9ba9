// Ropes with weight over wheels and drums at rest, against closed forms.

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

/// A track rope of 3 kg/m from the world's origin over a saddle wheel of 2 m at (60, 8) to a
/// counterweight of 2 t.
std::string track() {
  return R"("bodies": [
      {"name": "saddle", "mobility": "rotor", "position": [60, 8, 0], "mass": 50, "shape": {"type": "cylinder", "radius": 2, "length": 0.2}},
      {"name": "counterweight", "mobility": "slider", "axis": [0, 1, 0], "position": [62, -4, 0], "mass": 2000, "shape": {"type": "sphere", "radius": 0.5}}],
    "cables": [{"name": "track", "linear_density": 3, "axial_stiffness": 1e9, "rest_lengths": [60.6, 12.1],
      "links": [{"type": "attachment", "body": "world"}, {"type": "rolling", "body": "saddle", "winding": "clockwise"},
                {"type": "attachment", "body": "counterweight"}]}])";
}

TEST(HeavyRopeOnWheels, HasTheTensionOfTheCounterweightAndItsHeightAtTheSaddle) {
  Simulation s = simulation_of(track());
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const SpanReport span = s.cable_reports()[0].spans[0];
  const double w = 30.0;
  const double yield = 1e-9;
  const double tension = span.end_force.norm();
  const double slope = std::atan2(-span.end_force.y(), -span.end_force.x());
  const Vector3 tangent(60.0 - 2.0 * std::sin(slope), 8.0 + 2.0 * std::cos(slope), 0.0);
  // T + T^2 / 2 EA differs by weight times height. The rope on the saddle has the strain with which it
  // was laid there, and not that of the tension, 2e-5: the weight of its 3 m is known to that.
  const double height = tangent.y() - s.world.position({1}).y();
  const auto potential = [&](double t) { return t + 0.5 * yield * t * t; };
  EXPECT_NEAR(potential(tension), potential(20000.0) + w * height, 2e-5 * 3.0 * w);
  // The span is an elastic catenary from the origin to that tangent point.
  const double level = span.start_force.x();
  const double length = -(span.start_force.y() + span.end_force.y()) / w;
  const double x =
      level / w *
          (std::asinh(-span.end_force.y() / level) - std::asinh(span.start_force.y() / level)) +
      yield * level * length;
  const double z = (tension - span.start_force.norm()) / w +
                   yield * length * (span.start_force.y() + 0.5 * w * length);
  // Forces of 2e4 N with residuals of 1e-11 give places within 1e-7 m.
  EXPECT_NEAR(x, tangent.x(), 1e-7);
  EXPECT_NEAR(z, tangent.y(), 1e-7);
}

TEST(HeavyRopeOnWheels, SupportsBearTheWholeRope) {
  Simulation s = simulation_of(track());
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  double up = 0.0;
  for (const SupportReaction& support : support_reactions(s, rest.forces)) up += support.force.y();
  const double weight = 10.0 * (50.0 + 2000.0 + 3.0 * s.cable_reports()[0].total_length);
  // The strain of 2e-5 on additional arcs of 0.1 m is known to its change along them.
  EXPECT_NEAR(up, weight, 1e-9 * weight);
}

TEST(HeavyRopeOnDrums, StretchUnderTheHookAndTheirOwnWeight) {
  // F L / EA = 0.1 m and w L^2 / 2 EA = 0.125 m at a drop of 500 m.
  Simulation s = simulation_of(
      R"("bodies": [{"name": "hook", "mobility": "slider", "axis": [0, 1, 0], "position": [0.5, -500, 0], "mass": 1000, "shape": {"type": "sphere", "radius": 0.5}}],
      "cables": [{"name": "rope", "linear_density": 5, "axial_stiffness": 5e7, "rest_lengths": [500],
        "links": [{"type": "spool", "body": "world", "winding": "clockwise", "radius": 0.5, "stored_length": 20},
                  {"type": "attachment", "body": "hook"}]}])");
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(s.world.position({0}).y(), -500.225, 1e-9);
  EXPECT_NEAR(s.cable_reports()[0].spans[0].start_force.norm(), 35000.0, 1e-5);
}

TEST(HeavyRopeOnWheels, RunsAwayFromTheMiddleAtTheRateOfItsWeight) {
  // Two equal weights on equal lengths are an equilibrium, from which the rope runs off:
  // k^2 = 2 rho g / (m1 + m2 + I / r^2).
  Simulation s = simulation_of(
      R"("bodies": [
      {"name": "wheel", "mobility": "rotor", "mass": 1, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
      {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 10, "position": [-0.5, -20, 0]},
      {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 10, "position": [0.5, -20, 0]}],
      "cables": [{"name": "rope", "linear_density": 1, "axial_stiffness": 1e9, "links": [
      {"type": "attachment", "body": "light"}, {"type": "rolling", "body": "wheel", "winding": "clockwise"},
      {"type": "attachment", "body": "heavy"}]}])");
  ASSERT_TRUE(find_equilibrium(s).converged);
  const Modes modes = find_modes(s);
  ASSERT_FALSE(modes.modes.empty());
  // Differences of forces of 300 N by 1e-4 m or less.
  EXPECT_NEAR(modes.modes[0].eigenvalue, -20.0 / 20.5, 1e-5);
}

}  // namespace
}  // namespace sheave
