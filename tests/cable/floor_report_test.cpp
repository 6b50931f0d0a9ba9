// Reports and drawn lines of ropes with weight on a floor.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_polyline.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

constexpr double floor_height = 3.0;

/// A stiff rope of 1 kg/m between ends at these heights above the floor, 30 m apart.
CableReport floor_report(double start, double end, double length) {
  test::Machine m;
  m.model.gravity = {0.0, -10.0, 0.0};
  m.model.add(test::lump("load", {30.0, floor_height + end, 0.0}, 100.0));
  CableDef rope = test::cable(
      "rope", {test::attach(BodyId::world(), {0.0, floor_height + start, 0.0}), test::attach({0})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e9;
  rope.rest_lengths = {length};
  rope.floor = floor_height;
  m.cables.push_back(rope);
  return test::start(m).cable_reports()[0];
}

TEST(FloorReport, HasTheTensionAlongTheRope) {
  const SpanReport span = floor_report(4.0, 9.0, 36.0).spans[0];
  ASSERT_GT(span.floored, 5.0);
  const double h = std::abs(span.start_force.x());
  // From the floor up the tension of a stiff rope is H + w z.
  EXPECT_NEAR(span.tension_at(0.0), h + 40.0, 1e-5);
  EXPECT_NEAR(span.tension_at(1.0), h + 90.0, 1e-5);
  const double first = -span.start_force.y() / 10.0;
  const double last = 36.0 - first - span.floored;
  EXPECT_NEAR(span.tension_at(first / 36.0), h, 1e-9 * h);
  EXPECT_NEAR(span.tension_at((36.0 - last) / 36.0), h, 1e-9 * h);
  EXPECT_NEAR(span.tension_at((36.0 - 0.5 * last) / 36.0), std::hypot(h, 5.0 * last), 1e-9 * h);
  EXPECT_NEAR(span.largest_tension(), h + 90.0, 1e-5);
}

TEST(FloorReport, DrawsTheRopeOnTheFloor) {
  for (const auto& [start, end] :
       {std::pair{4.0, 9.0}, std::pair{0.0, 6.0}, std::pair{5.0, 0.0}, std::pair{0.0, 0.0}}) {
    for (const double length : {36.0, 60.0}) {
      const CableReport report = floor_report(start, end, length);
      const PolylineOptions options{.tolerance = 1e-5};
      std::vector<Vector3> line(cable_polyline(report, 0, options, {}));
      ASSERT_EQ(cable_polyline(report, 0, options, line), line.size());
      EXPECT_EQ(line.front(), report.spans[0].start);
      EXPECT_EQ(line.back(), report.spans[0].end);
      double lowest = 1e9;
      double drawn = 0.0;
      for (std::size_t k = 0; k < line.size(); ++k) {
        lowest = std::min(lowest, line[k].y());
        if (k > 0) drawn += (line[k] - line[k - 1]).norm();
      }
      EXPECT_NEAR(lowest, floor_height, 1e-6);
      // The loose rest of a slack rope is not drawn.
      const bool slack = std::abs(report.spans[0].start_force.x()) == 0.0;
      EXPECT_NEAR(drawn, slack ? 30.0 + start + end : length, 1e-3);
    }
  }
}

TEST(FloorReport, LiesOnTheFloorFromATautRopeOn) {
  // The foot of the lowest point of a free rope is the place where it will touch.
  const SpanReport span = floor_report(8.0, 8.0, 31.0).spans[0];
  EXPECT_EQ(span.floored, 0.0);
  for (const Vector3& touch : span.touches) {
    EXPECT_LE((touch - Vector3(15.0, floor_height, 0.0)).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace sheave
