// A damper has no force at rest: a rope that slides over a post rests where it would without one.
// The rope of the unstretched length U over a smooth post has the tension m g everywhere, on the arc,
// too, so its load sinks by U m g / EA.

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

constexpr double post_radius = 0.2;    // [m]
constexpr double rope_load = 20.0;     // m g [N]
constexpr double rope_material = 4e3;  // EA [N]

/// A weight on a rope over a post, both ends 1 m below it.
Simulation over_a_post(double friction, double damping, const std::string& post) {
  return simulation_of(fmt::format(
      R"("step": {{"dt": 1e-4, "substeps": 1}}, "bodies": [
    {{"name": "post", "mobility": "static", "shape": {}}},
    {{"name": "weight", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0.2, -1, 0]}}],
    "cables": [{{"name": "rope", "axial_stiffness": {}, "damping": {}, "links": [
      {{"type": "attachment", "body": "world", "point": [-0.2, -1, 0]}},
      {{"type": "rolling", "body": "post", "winding": "clockwise", "friction": {}}},
      {{"type": "attachment", "body": "weight"}}]}}])",
      post, rope_material, damping, friction));
}

const std::string round_post = R"({"type": "cylinder", "radius": 0.2, "length": 0.1})";
const std::string square_post = R"({"type": "box", "size": [0.4, 0.4, 0.1]})";

TEST(DampedRopeAtRest, SinksByItsStretchOverASmoothPost) {
  for (const double damping : {0.0, 5.0, 500.0}) {
    SCOPED_TRACE(damping);
    Simulation s = over_a_post(0.0, damping, round_post);
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    // Residuals of 1e-8 of the load at most stretch the rope by 1e-8 of its stretch.
    const double sunk = (2.0 + pi * post_radius) * rope_load / rope_material;
    EXPECT_NEAR(s.world.position({1}).y(), -1.0 - sunk, 1e-8 * sunk);
    EXPECT_NEAR(testing::tension(s, 0, 0), rope_load, 1e-8 * rope_load);
    EXPECT_NEAR(testing::tension(s, 0, 1), rope_load, 1e-8 * rope_load);
    // One spring from end to end.
    const double square = rope_material / (2.0 + pi * post_radius) / 2.0;
    EXPECT_NEAR(find_modes(s).modes[0].eigenvalue, square, 1e-8 * square);
  }
}

TEST(DampedRopeAtRest, DampersMoveNoRestAndLeaveItInPeace) {
  for (const std::string& post : {round_post, square_post}) {
    for (const double friction : {0.0, 0.05, 0.3}) {
      SCOPED_TRACE(post + fmt::format(", friction {}", friction));
      Simulation without = over_a_post(friction, 0.0, post);
      ASSERT_TRUE(find_equilibrium(without).converged);
      const double place = without.world.position({1}).y();
      for (const double damping : {5.0, 500.0}) {
        Simulation with = over_a_post(friction, damping, post);
        ASSERT_TRUE(find_equilibrium(with).converged) << damping;
        EXPECT_NEAR(with.world.position({1}).y(), place, 1e-10) << damping;
        ASSERT_TRUE(with.world.step().ok());
        // Residuals of 1e-8 of the load, over 1e-4 s.
        EXPECT_LT(with.world.velocity({1}).norm(), 1e-8 * 10.0 * 1e-4 + 1e-12) << damping;
      }
    }
  }
}

}  // namespace
}  // namespace sheave
