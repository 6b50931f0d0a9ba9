// Ropes with weight over massless wheels and through eyes at rest, against closed forms.

#include <cmath>
#include <string>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "statics/supports.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// A track rope of 3 kg/m from the world's origin over a massless saddle of 2 m at (60, 8) to a
/// counterweight of 2 t.
std::string free_track() {
  return R"("bodies": [
      {"name": "saddle", "mobility": "rotor", "position": [60, 8, 0], "mass": 50, "spin_inertia": 0, "shape": {"type": "cylinder", "radius": 2, "length": 0.2}},
      {"name": "counterweight", "mobility": "slider", "axis": [0, 1, 0], "position": [62, -4, 0], "mass": 2000, "shape": {"type": "sphere", "radius": 0.5}}],
    "cables": [{"name": "track", "linear_density": 3, "axial_stiffness": 1e9, "rest_lengths": [60.6, 12.1],
      "links": [{"type": "attachment", "body": "world"}, {"type": "rolling", "body": "saddle", "winding": "clockwise"},
                {"type": "attachment", "body": "counterweight"}]}])";
}

TEST(HeavyRun, HasTheTensionOfTheCounterweightAndItsHeightAtAFreeSaddle) {
  Simulation s = simulation_of(free_track());
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const SpanReport span = s.cable_reports()[0].spans[0];
  const double w = 30.0;
  const double yield = 1e-9;
  const double tension = span.end_force.norm();
  const double slope = std::atan2(-span.end_force.y(), -span.end_force.x());
  const double top = 8.0 + 2.0 * std::cos(slope);
  const auto potential = [&](double t) { return t + 0.5 * yield * t * t; };
  // The rope on the saddle has the strain of the start, and not that of the tension, 2e-5.
  EXPECT_NEAR(potential(tension), potential(20000.0) + w * (top - s.world.position({1}).y()),
              2e-5 * 3.0 * w);
}

TEST(HeavyRun, IsBorneByItsSupports) {
  Simulation s = simulation_of(free_track());
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  double up = 0.0;
  for (const SupportReaction& support : support_reactions(s, rest.forces)) up += support.force.y();
  const double weight = 10.0 * (50.0 + 2000.0 + 3.0 * s.cable_reports()[0].total_length);
  EXPECT_NEAR(up, weight, 1e-9 * weight);
}

TEST(HeavyRun, RunsAwayFromTheMiddleAtTheRateOfItsWeight) {
  // Two equal weights on equal lengths are an equilibrium, from which the rope runs off:
  // k^2 = 2 rho g / (m1 + m2) = 1.
  for (const std::string link : {R"({"type": "rolling", "body": "wheel", "winding": "clockwise"})",
                                 R"({"type": "pinhole", "body": "world", "point": [0, 0.5, 0]})"}) {
    Simulation s = simulation_of(
        R"("bodies": [
      {"name": "wheel", "mobility": "rotor", "mass": 1, "spin_inertia": 0, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
      {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 10, "position": [-0.5, -20, 0]},
      {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 10, "position": [0.5, -20, 0]}],
      "cables": [{"name": "rope", "linear_density": 1, "axial_stiffness": 1e9, "links": [
      {"type": "attachment", "body": "light"}, )" +
        link + R"(, {"type": "attachment", "body": "heavy"}]}])");
    ASSERT_TRUE(find_equilibrium(s).converged);
    const Modes modes = find_modes(s);
    ASSERT_FALSE(modes.modes.empty());
    // Differences of forces of 300 N by 1e-4 m or less. The falls to the eye lean by 0.5 m in 20 m: a
    // share of 0.5^2 / 20^2 = 6e-4 of their geometry.
    EXPECT_NEAR(modes.modes[0].eigenvalue, -1.0, 2e-3);
  }
}

}  // namespace
}  // namespace sheave
