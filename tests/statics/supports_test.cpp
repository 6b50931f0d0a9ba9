// What supports bear at rest, against sums of weights.

#include "statics/supports.h"

#include <vector>

#include "statics/equilibrium.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;
using testing::tension;

/// Newton's method ends where rounding is left: 1e-11 of forces.
constexpr double exact_support = 1e-9;

TEST(Supports, BearingBearsBothPartsOfARope) {
  // Two weights of 1 kg over a wheel of 0.5 kg: 10 + 10 + 5 N. The wheel may stand as it likes.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "wheel", "mobility": "rotor", "mass": 0.5, "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "l", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-0.5, -2, 0]},
    {"name": "r", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0.5, -2, 0]}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "l"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "r"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_EQ(rest.neutral_motions, 1);
  const std::vector<SupportReaction> supports = support_reactions(simulation, rest.forces);
  ASSERT_FALSE(supports.empty());
  EXPECT_EQ(supports[0].body.index, 0);
  EXPECT_NEAR(supports[0].force.y(), 25.0, 25.0 * exact_support);
}

TEST(Supports, GuideBearsMountedBodiesToo) {
  // A block of 3 kg on a level guide, pulled by 10 N, with a sheave of 0.5 kg in a level rope of
  // two parts: 5 N each. The bearing bears 10 N and 5 N of weight, the guide all the weight, 35 N.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "block", "mobility": "slider", "axis": [1, 0, 0], "mass": 3, "force": [10, 0, 0]},
    {"name": "sheave", "mobility": "rotor", "mount": "block", "mass": 0.5,
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "world", "point": [-2, -0.5, 0]},
      {"type": "rolling", "body": "sheave", "winding": "counter-clockwise"},
      {"type": "attachment", "body": "world", "point": [-2, 0.5, 0]}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(tension(simulation, 0, 0), 5.0, 5.0 * exact_support);
  const std::vector<SupportReaction> supports = support_reactions(simulation, rest.forces);
  ASSERT_EQ(supports.size(), 3U);  // and the world's, by which the rope is held
  EXPECT_LE((supports[0].force - Vector3(0.0, 35.0, 0.0)).norm(), 35.0 * exact_support);
  EXPECT_LE((supports[1].force - Vector3(10.0, 5.0, 0.0)).norm(), 35.0 * exact_support);
}

TEST(Supports, StandBearsTheWheelThatIsMountedOnIt) {
  // Two weights of 1 kg over a wheel of 0.5 kg on a stand: 10 + 10 + 5 N, for both.
  Simulation simulation = simulation_of(R"("bodies": [
    {"name": "stand", "mobility": "static"},
    {"name": "wheel", "mobility": "rotor", "mount": "stand", "mass": 0.5,
     "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
    {"name": "l", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [-0.5, -2, 0]},
    {"name": "r", "mobility": "slider", "axis": [0, 1, 0], "mass": 1, "position": [0.5, -2, 0]}],
    "cables": [{"name": "rope", "links": [{"type": "attachment", "body": "l"},
      {"type": "rolling", "body": "wheel", "winding": "clockwise"}, {"type": "attachment", "body": "r"}]}])");
  const Equilibrium rest = find_equilibrium(simulation);
  ASSERT_TRUE(rest.converged) << rest.message;
  const std::vector<SupportReaction> supports = support_reactions(simulation, rest.forces);
  ASSERT_EQ(supports.size(), 2U);
  for (const SupportReaction& support : supports) {
    EXPECT_LE((support.force - Vector3(0.0, 25.0, 0.0)).norm(), 25.0 * exact_support);
  }
}

}  // namespace
}  // namespace sheave
