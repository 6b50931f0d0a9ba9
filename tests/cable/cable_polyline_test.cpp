#include "cable/cable_polyline.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace sheave {
namespace {

/// A cable from a point down on the left over a wheel (radius 1 at the origin, clockwise: over the
/// top) to a point down on the right.
CableReport over_the_wheel() {
  CableReport cable;
  cable.links.resize(3);
  cable.links[0].center = cable.links[0].entry = cable.links[0].exit = {-1, -2, 0};
  LinkReport& wheel = cable.links[1];
  wheel.radius = 1.0;
  wheel.winding = -1;
  wheel.entry = {-1, 0, 0};
  wheel.exit = {1, 0, 0};
  wheel.wrap_angle = wheel.stored_length = pi;
  cable.links[2].center = cable.links[2].entry = cable.links[2].exit = {1, -2, 0};
  cable.spans.resize(2);
  cable.spans[0] = {{-1, -2, 0}, {-1, 0, 0}, 2.0, 2.0, 10.0};
  cable.spans[1] = {{1, 0, 0}, {1, -2, 0}, 2.0, 2.0, 5.0};
  return cable;
}

std::vector<Vector3> line_of(const CableReport& cable, std::size_t span,
                             const PolylineOptions& options) {
  std::vector<Vector3> line(cable_polyline(cable, span, options, {}));
  EXPECT_EQ(cable_polyline(cable, span, options, line), line.size());
  return line;
}

double length_of(const std::vector<Vector3>& line) {
  double sum = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
  return sum;
}

TEST(CablePolyline, ArcsKeepTheToleranceWithFewPoints) {
  for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-6}) {
    std::vector<Vector3> arc(link_polyline(over_the_wheel(), 1, {.tolerance = tolerance}, {}));
    link_polyline(over_the_wheel(), 1, {.tolerance = tolerance}, arc);
    for (std::size_t k = 1; k < arc.size(); ++k) {
      EXPECT_NEAR(arc[k].norm(), 1.0, 1e-14);
      EXPECT_GE((0.5 * (arc[k] + arc[k - 1])).norm(), 1.0 - tolerance * (1.0 + 1e-9));
    }
    // The sagitta of a step a is a^2 / 8, so an arc of pi needs pi / sqrt(8 tolerance) steps.
    EXPECT_LE(static_cast<double>(arc.size()), pi / std::sqrt(8.0 * tolerance) + 3.0);
  }
}

TEST(CablePolyline, SpansInOrderAreTheWholeCable) {
  const CableReport cable = over_the_wheel();
  const std::vector<Vector3> first = line_of(cable, 0, {.tolerance = 1e-5});
  const std::vector<Vector3> second = line_of(cable, 1, {.tolerance = 1e-5});
  EXPECT_EQ(first, (std::vector<Vector3>{{-1, -2, 0}, {-1, 0, 0}}));
  EXPECT_LE((second.front() - first.back()).norm(), 1e-12);
  EXPECT_EQ(second.back(), Vector3(1, -2, 0));
  // An arc is longer than its chords by (sagitta / radius) / 3 of its length.
  EXPECT_NEAR(length_of(first) + length_of(second), 4.0 + pi, 1e-5 * pi);
}

TEST(CablePolyline, WrapsBelongToTheSpanBeforeThem) {
  CableReport cable = over_the_wheel();
  const CableReport listed = cable;
  cable.wraps = {{0, cable.links[1], cable.spans[1]}};
  cable.links.erase(cable.links.begin() + 1);
  cable.spans.erase(cable.spans.begin() + 1);
  const std::vector<Vector3> line = line_of(cable, 0, {.tolerance = 1e-4});
  std::vector<Vector3> expected = line_of(listed, 0, {.tolerance = 1e-4});
  for (const Vector3& p : line_of(listed, 1, {.tolerance = 1e-4})) expected.push_back(p);
  EXPECT_EQ(line, expected);
}

TEST(CablePolyline, ASmallBufferGetsTheFirstPoints) {
  const std::vector<Vector3> whole = line_of(over_the_wheel(), 1, {.tolerance = 1e-3});
  for (std::size_t room = 0; room < whole.size(); ++room) {
    std::vector<Vector3> some(room);
    EXPECT_EQ(cable_polyline(over_the_wheel(), 1, {.tolerance = 1e-3}, some), whole.size());
    EXPECT_EQ(some, std::vector<Vector3>(whole.begin(),
                                         whole.begin() + static_cast<std::ptrdiff_t>(room)));
  }
}

TEST(CablePolyline, SlackCableLiesOnTheFloor) {
  CableReport cable = over_the_wheel();
  cable.spans[0].rest_length = 4.0;
  cable.spans[0].tension = 0.0;
  PolylineOptions options{.tolerance = 1e-3, .gravity = {0, -9.81, 0}, .radius = 0.02};
  EXPECT_NEAR(length_of(line_of(cable, 0, options)), 4.0, 1e-9);  // straight down and up again
  options.floor = PolylineFloor{{0, -2.5, 0}};
  const std::vector<Vector3> line = line_of(cable, 0, options);
  ASSERT_EQ(line.size(), 3U);
  EXPECT_NEAR(line[1].y(), -2.5 + 0.02, 1e-15);
}

TEST(CablePolyline, PiecesOfACutCableHangFromTheEnds) {
  CableReport cable = over_the_wheel();
  cable.cut = true;
  cable.pieces = {3.0, 1.0};
  cable.spans[0].tension = cable.spans[1].tension = 0.0;
  EXPECT_EQ(line_of(cable, 0, {}), (std::vector<Vector3>{{-1, -2, 0}, {-1, -5, 0}}));
  EXPECT_EQ(line_of(cable, 1, {}), (std::vector<Vector3>{{1, -3, 0}, {1, -2, 0}}));
  EXPECT_TRUE(line_of(cable, 2, {}).empty());
  // Cable that reaches the floor is not gone.
  PolylineOptions options;
  options.floor = PolylineFloor{{0, -4, 0}};
  const std::vector<Vector3> lying = line_of(cable, 0, options);
  EXPECT_NEAR(length_of(lying), 3.0, 1e-12);
  for (const Vector3& p : lying) EXPECT_GE(p.y(), -4.0 - 1e-12);
  cable.closed = true;  // nothing holds a belt
  EXPECT_TRUE(line_of(cable, 0, {}).empty());
}

TEST(CablePolyline, CableStaysOnTheDrumOfACutEnd) {
  CableReport cable = over_the_wheel();
  cable.links.erase(cable.links.begin());
  cable.spans.erase(cable.spans.begin());
  cable.cut = true;
  cable.links[0].wrap_angle = cable.links[0].stored_length = 3.0;
  cable.pieces = {5.0, 0.5};
  const std::vector<Vector3> line = line_of(cable, 0, {.tolerance = 1e-6});
  EXPECT_NEAR(length_of(line), 5.0, 1e-5);
  EXPECT_EQ(line.back(), Vector3(1, -2, 0));  // the clockwise drum lets it down on its right
}

TEST(CablePolyline, AnyToleranceGivesABoundedLine) {
  const double nan = std::nan("");
  CableReport cable = over_the_wheel();
  cable.spans[1].rest_length = 3.0;
  cable.spans[1].tension = 0.0;
  cable.spans[1].end.x() = 1.5;
  for (const double tolerance : {0.0, -1.0, 1e-300, nan}) {
    EXPECT_LE(cable_polyline(cable, 1, {.tolerance = tolerance}, {}), 8000U + 2001U);
  }
}

}  // namespace
}  // namespace sheave
