// A load that hangs on a drum with a groove: rest, torque, and small motions against closed forms.
//
// Small motions. Let the load move by x across the axle and by z along it, and the rope of length l
// turn by a and b. The rope leaves at R - c b from the axle, with c = z' = lead / 2 pi, and winds by -a,
// so its end moves by -c b across and by -c a along the axle:
//   l a = x + c b,   l b = z + c a.
// The forces m g a and m g b are those of a symmetric stiffness, as a potential needs. Along x + z and
// x - z the rope turns by the displacement over l - c and l + c: w^2 = g / (l - c) and g / (l + c).

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cable/reactions.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// A drum of 0.3 m that a drive holds, and 2 kg on its rope. Lengths in m.
Simulation hanging(const std::string& winding, double lead, const std::string& more = "") {
  return simulation_of(fmt::format(
      R"("bodies": [
      {{"name": "drum", "mobility": "rotor", "axis": [0, 0, 1], "drive": "speed", "drive_values": [0],
       "mass": 1, "shape": {{"type": "cylinder", "radius": 0.3, "length": 0.5}}}},
      {{"name": "load", "mobility": "free", "mass": 2, "inertia": [1, 1, 1], "position": [{}, -2, 0.1]}}],
      "cables": [{{"name": "rope", {} "links": [
      {{"type": "spool", "body": "drum", "winding": "{}", "stored_length": 1.5, "lead": {}, "groove_start": 0}},
      {{"type": "attachment", "body": "load"}}]}}])",
      winding == "clockwise" ? 0.4 : -0.4, more, winding, lead));
}

TEST(GroovedDrumAtRest, ALoadHangsWhereTheRopeLeavesItsHelix) {
  for (const std::string winding : {"clockwise", "counter-clockwise"}) {
    for (const double lead : {0.5, -1.2}) {
      Simulation simulation = hanging(winding, lead);
      const Equilibrium rest = find_equilibrium(simulation);
      ASSERT_TRUE(rest.converged) << rest.message;
      const CableReport report = simulation.cable_reports()[0];
      const GrooveReport& groove = *report.links[0].groove;
      const double gain = std::hypot(0.3, lead / (2.0 * pi));
      const Vector3 load = simulation.world.position({1});
      // The search leaves 1e-9 of the weight.
      EXPECT_NEAR(groove.axial_position, lead * groove.wound / (2.0 * pi), 1e-12);
      EXPECT_NEAR(load.z(), groove.axial_position, 1e-8);
      EXPECT_NEAR(std::abs(load.x()), gain, 1e-8);
      EXPECT_NEAR(report.links[0].stored_length, gain * groove.wound, 1e-12);
      EXPECT_NEAR(report.spans[0].tension, 20.0, 1e-7);
      EXPECT_EQ(report.length_error, 0.0);
    }
  }
}

TEST(GroovedDrumAtRest, ALoadSwingsAcrossTheDiagonalsOfTheDrum) {
  for (const std::string winding : {"clockwise", "counter-clockwise"}) {
    for (const double lead : {0.4 * pi, -0.8 * pi}) {
      for (const std::string more : {"", R"("axial_stiffness": 1e9,)"}) {
        Simulation simulation = hanging(winding, lead, more);
        const Equilibrium rest = find_equilibrium(simulation);
        ASSERT_TRUE(rest.converged) << rest.message;
        const double length = simulation.cable_reports()[0].spans[0].length;
        const Modes modes = find_modes(simulation);
        ASSERT_GE(modes.modes.size(), 5U);
        const double along = std::abs(lead) / (2.0 * pi);
        // Three rotations of the load have no stiffness.
        // Differences of forces leave some 1e-10; 1e9 N stretch by 4e-8 m.
        EXPECT_NEAR(modes.modes[3].eigenvalue, 10.0 / (length + along), 1e-5);
        EXPECT_NEAR(modes.modes[4].eigenvalue, 10.0 / (length - along), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace sheave
