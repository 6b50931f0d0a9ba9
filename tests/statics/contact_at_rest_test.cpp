// Bodies that the search for equilibrium lays onto rigid contacts, from above and from below.
//
// Lengths are those of one Newton step from the last iteration, whose residual is below 1e-12 of the
// scene's size, and forces follow from the balance of two numbers of the same size.

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/supports.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

constexpr double laid_within = 1e-11;

/// A planar ball of 2 kg and 0.1 m at `height` above the floor, on an arm about the point (0, 0.3) if
/// `hinged`.
std::string ball_above_floor(double height, bool hinged, double tilt) {
  const double half = 0.5 * tilt;
  return fmt::format(
      R"("bodies": [{{"name": "ball", "mobility": "planar", "mass": 2, "position": [0.5, {}, 0],
        "shape": {{"type": "sphere", "radius": 0.1}}}},
      {{"name": "floor", "mobility": "static", "orientation": [{}, 0, 0, {}], "shape": {{"type": "half-space"}}}}],
      {}
      "colliders": [{{"body": "ball"}}, {{"body": "floor"}}])",
      height, std::cos(half), std::sin(half),
      hinged ? R"("joints": [{"type": "hinge", "name": "foot", "body_a": "world", "body_b": "ball",
        "anchor": [0, 0.3, 0], "axis": [0, 0, 1]}],)"
             : "");
}

// The rows of contacts that begin a substep open at a bounded speed in a motion. The search, whose
// bodies may pass the floor in a limited step, is no motion.
TEST(ContactAtRest, ABallIsLaidOntoTheFloorFromAnywhere) {
  for (const double height : {-0.3, 0.0, 0.09, 0.1, 0.11, 0.2, 1.0, 5.0}) {
    SCOPED_TRACE(height);
    Simulation s = simulation_of(ball_above_floor(height, false, 0.0));
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    EXPECT_NEAR(s.world.position({0}).y(), 0.1, laid_within);
    EXPECT_NEAR(s.world.position({0}).x(), 0.5, laid_within);
    const auto supports = support_reactions(s, rest.forces);
    ASSERT_EQ(supports.size(), 1U);
    EXPECT_NEAR(supports[0].force.y(), 20.0, 20.0 * laid_within);
  }
}

// On a floor with the slope t the force N acts along the normal n, and the arm a of the ball carries
// the rest: a x (W + N n) = 0.
TEST(ContactAtRest, AnArmIsLaidOntoASlope) {
  for (const double tilt : {0.0, 0.2, -0.3}) {
    for (const double height : {0.05, 0.3, 0.7}) {
      SCOPED_TRACE(::testing::Message() << "tilt " << tilt << ", height " << height);
      Simulation s = simulation_of(ball_above_floor(height, true, tilt));
      const Equilibrium rest = find_equilibrium(s);
      ASSERT_TRUE(rest.converged) << rest.message;
      const Vector3 normal(-std::sin(tilt), std::cos(tilt), 0.0);
      const Vector3 arm = s.world.position({0}) - Vector3(0.0, 0.3, 0.0);
      EXPECT_NEAR(normal.dot(s.world.position({0})), 0.1, laid_within);
      EXPECT_NEAR(arm.norm(), std::hypot(0.5, height - 0.3), laid_within);
      const double pressed = 20.0 * arm.x() / arm.cross(normal).z();
      const auto supports = support_reactions(s, rest.forces);
      ASSERT_FALSE(supports.empty());
      EXPECT_NEAR(supports[0].force.dot(normal), pressed, 1e-9);
    }
  }
}

}  // namespace
}  // namespace sheave
