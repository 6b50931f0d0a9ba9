// Rest and small vibrations of bodies that a rope passes through openings.

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"

namespace sheave {
namespace {

using testing::simulation_of;

// The closed form is that of tests/physics/opening_link_test.cpp: the centre of the ball moves on
// the parallel surface of an ellipsoid, with the radii of curvature a^2 / b + r and b + r at the
// lowest point. The place at which the rope turns moves along with it, which the geometric
// stiffness has to know: for a hole in the ball at that place both radii would be without r.
TEST(OpeningAtRest, ABallHangsAtTheLowestPointAndSwingsWithItsCurvature) {
  for (const double size : {1.0, 1000.0}) {
    const double c = 0.8 * size;
    const double a = 1.0 * size;
    const double b = 0.6 * size;
    const double r = 0.15 * size;
    Simulation s = simulation_of(fmt::format(
        R"("bodies": [{{"name": "ball", "mass": 2, "inertia": [{0}, {0}, {0}], "position": [{1}, {2}, {3}],
                       "shapes": [{{"type": "sphere", "radius": {4}}}]}}],
           "cables": [{{"name": "rope", "rest_lengths": [{5}, {5}], "links": [
             {{"type": "attachment", "body": "world", "point": [{6}, 0, 0]}},
             {{"type": "opening", "body": "ball"}},
             {{"type": "attachment", "body": "world", "point": [{7}, 0, 0]}}]}}])",
        0.02 * size * size, 0.1 * size, -0.5 * size, 0.07 * size, r, a, -c, c));
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    const Vector3 place = s.world.position({0});
    // Where the height is flat, a search by forces to 1e-9 of the weight finds 1e-9 of the radius.
    EXPECT_NEAR(place.y(), -b - r, 1e-9 * size);
    EXPECT_NEAR(place.x(), 0.0, 1e-7 * size);
    EXPECT_NEAR(place.z(), 0.0, 1e-7 * size);
    // sin of the slope of the spans is b / a.
    EXPECT_NEAR(s.cable_reports()[0].spans[0].tension, 0.5 * 20.0 * a / b, 1e-6);
    const Modes modes = find_modes(s);
    std::vector<double> squares;
    for (const Mode& mode : modes.modes) squares.push_back(mode.eigenvalue);
    std::sort(squares.begin(), squares.end());
    ASSERT_EQ(squares.size(), 5U);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(squares[static_cast<std::size_t>(i)], 0.0, 1e-6 / size);
    // Differences of fourth order leave some 1e-9 (statics/tangent.h).
    EXPECT_NEAR(squares[3], 10.0 / (a * a / b + r), 1e-7 * squares[3]);
    EXPECT_NEAR(squares[4], 10.0 / (b + r), 1e-7 * squares[4]);
  }
}

}  // namespace
}  // namespace sheave
