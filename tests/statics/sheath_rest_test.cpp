// A weight on a rope through a sheath at rest: the tensions, and the frequency about the rest.

#include <cmath>
#include <string>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "statics/supports.h"
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

// The rope at the mouth draws the hand of the scene towards the finger with T, and the spring of the
// finger pushes the hand away with T. Along the rail both forces cancel, and the rail holds the rest.
TEST(ConduitAtRest, HoldsItsHandByTheTensionAtTheMouth) {
  Simulation s = simulation_of(testing::scene_file("analytic/conduit.json"));
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  constexpr double tension = 5.0 * 9.81;
  EXPECT_NEAR(testing::tension(s, 0, 0), tension, 1e-9 * tension);
  EXPECT_NEAR(testing::tension(s, 0, 1), tension, 1e-9 * tension);
  // The entry hangs the weight on the world.
  double up = 0.0;
  for (const SupportReaction& one : support_reactions(s, rest.forces)) up += one.force.y();
  EXPECT_NEAR(up, tension, 1e-8);
}

TEST(ConduitAtRest, LetsFingerAndWeightVibrateOnOneRope) {
  // The finger of 0.2 kg on 981 N/m and the weight of 5 kg, on a rope of k = EA / L0: with the stretch
  // q - u of the rope, l^2 - l (s + k + k m / M) / m + s k / (m M) = 0 for the squares l.
  Simulation s = simulation_of(testing::scene_file("analytic/conduit.json"));
  ASSERT_TRUE(find_equilibrium(s).converged);
  const double k = 50e3 / s.cable_reports()[0].total_length;
  constexpr double finger = 0.2;
  constexpr double weight = 5.0;
  constexpr double spring = 981.0;
  const double half = 0.5 * ((spring + k) / finger + k / weight);
  const double root = std::sqrt(half * half - spring * k / (finger * weight));
  const Modes modes = find_modes(s);
  for (const double square : {half - root, half + root}) {
    double nearest = 1e300;
    for (const Mode& mode : modes.modes) {
      if (std::abs(mode.eigenvalue - square) < std::abs(nearest - square))
        nearest = mode.eigenvalue;
    }
    EXPECT_NEAR(nearest, square, 1e-6 * square);
  }
}

}  // namespace
}  // namespace sheave
