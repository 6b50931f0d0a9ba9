// A weight on a rope through a sheath at rest: the tensions, and the frequency about the rest.

#include <cmath>
#include <string>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

/// 20 kg on a rope of 20 kN that runs from a wall through a sheath with friction x bend = 0.4; the
/// rope has 100 N everywhere at the start.
Simulation hung_through_sheath() {
  return simulation_of(
      R"("bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "position": [1, -1, 0], "mass": 20, "shape": {"type": "sphere", "radius": 0.1}}],
      "cables": [{"name": "rope", "axial_stiffness": 20000, "pretension": 100, "links": [
        {"type": "attachment", "body": "world", "point": [-1, -1, 0]},
        {"type": "sheath", "body": "world", "points": [[-1, 0, 0], [1, 0, 0]], "length": 3, "bend": 4, "friction": 0.1},
        {"type": "attachment", "body": "load"}]}])");
}

TEST(SheathAtRest, HasTheTensionOfItsLoadAndOneThatFrictionHolds) {
  Simulation s = hung_through_sheath();
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const CableReport rope = s.cable_reports()[0];
  EXPECT_NEAR(rope.spans[1].tension, 200.0, 1e-6);
  // The pull grows at the load's end, so the ratio is that of friction unless the front has not
  // reached the other end: ln(200 / 100) exceeds 0.4, so the whole rope has slid.
  EXPECT_NEAR(rope.spans[0].tension, 200.0 * std::exp(-0.4), 1e-6);
  // Forces of 200 N with residuals of 1e-9 and a spring of about 5 kN/m.
  double have = 0.0;
  for (const SpanReport& span : rope.spans) have += span.rest_length;
  have += rope.links[1].stored_length;
  EXPECT_NEAR(have, 5.0 / 1.005, 1e-12);
}

TEST(SheathAtRest, VibratesOnTheSpanBesideTheStuckRope) {
  Simulation s = hung_through_sheath();
  ASSERT_TRUE(find_equilibrium(s).converged);
  const SpanReport span = s.cable_reports()[0].spans[1];
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 1U);
  // The spring of the free span: EA / rest length.
  const double square = 20000.0 / span.rest_length / 20.0;
  EXPECT_NEAR(modes.modes[0].eigenvalue, square, 1e-6 * square);
}

}  // namespace
}  // namespace sheave
