// The shortest way over smooth bodies, against closed forms and against searches that know nothing
// of straightest ways.

#include "cable/geodesic_chain.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/vector.h"

namespace sheave {
namespace {

SmoothSurface surface(const Vector3& center, double radius, double half_length, bool round_ends,
                      const Vector3& axis = Vector3::UnitZ()) {
  SmoothSurface made;
  made.center = center;
  made.axis = axis.normalized();
  made.radius = radius;
  made.half_length = half_length;
  made.form = round_ends ? SurfaceForm::rounded : SurfaceForm::cylinder;
  return made;
}

/// A stop that the rope passes on the side of -y, from about -x to +x.
GeodesicStop below(const SmoothSurface& on) {
  GeodesicStop stop;
  stop.surface = on;
  stop.entry = on.frame(on.center - on.radius * Vector3::UnitY(), Vector3::UnitX());
  return stop;
}

SpanEnd point(const Vector3& where) {
  return [where](const Vector3&) { return where; };
}

double length_of(const std::vector<GeodesicStop>& stops, const Vector3& from, const Vector3& to) {
  double length = 0.0;
  Vector3 last = from;
  for (const GeodesicStop& stop : stops) {
    length += (stop.entry.point - last).norm() + stop.length;
    last = stop.way.end.point;
  }
  return length + (to - last).norm();
}

double shortest(std::vector<GeodesicStop>& stops, const Vector3& from, const Vector3& to) {
  EXPECT_TRUE(find_shortest_way(stops, point(from), point(to)));
  return length_of(stops, from, to);
}

/// The least of a function between two bounds, by golden section.
template <class Function>
double least(int rounds, double low, double high, Function f) {
  const double share = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = high - share * (high - low);
  double b = low + share * (high - low);
  double at_a = f(a);
  double at_b = f(b);
  for (int i = 0; i < rounds; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - share * (high - low);
      at_a = f(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + share * (high - low);
      at_b = f(b);
    }
  }
  return std::min(at_a, at_b);
}

const Vector3 near_end(-1.0, 0.5, 0.1);
const Vector3 far_end(1.2, 0.4, 0.8);

/// Length from one point over a bar along z through the origin to another, by unrolling: the way in
/// the section, and the rise along the axis.
double unrolled(double radius, const Vector3& a, const Vector3& b) {
  const double da = std::hypot(a.x(), a.y());
  const double db = std::hypot(b.x(), b.y());
  const double below_a = std::atan2(-a.x(), -a.y());  // from -y, either way
  const double below_b = std::atan2(b.x(), -b.y());
  const double arc = below_a + below_b - std::acos(radius / da) - std::acos(radius / db);
  const double level =
      std::sqrt(da * da - radius * radius) + std::sqrt(db * db - radius * radius) + radius * arc;
  return std::hypot(level, b.z() - a.z());
}

TEST(GeodesicChain, OverABarItIsTheUnrolledLine) {
  for (const double radius : {0.01, 0.2, 0.39}) {
    std::vector<GeodesicStop> stops{below(surface(Vector3::Zero(), radius, 2.0, false))};
    // Twenty operations round, of the size of the lengths.
    EXPECT_NEAR(shortest(stops, near_end, far_end), unrolled(radius, near_end, far_end), 1e-14);
    // The axial slope is the same all along.
    const Vector3 in = (stops[0].entry.point - near_end).normalized();
    const Vector3 out = (far_end - stops[0].way.end.point).normalized();
    EXPECT_NEAR(in.z(), out.z(), 1e-14);
    EXPECT_NEAR(stops[0].entry.tangent.z(), in.z(), 1e-14);
    // A helix of the slope b has the curvature cos^2 b / r.
    const double turned = stops[0].length * (1.0 - in.z() * in.z()) / radius;
    EXPECT_NEAR(stops[0].way.turned, turned, 1e-13);
  }
}

// Two points of the bar can be joined by a helix. Seen along the axis, the way touches the section at
// its tangents, whatever its heights. The least of all such ways over the heights of both ends, by
// golden section, does not use the slope. After 40 rounds an interval of 0.6 is 3e-9 wide, and the
// length has the square of that.
TEST(GeodesicChain, OverABarNoOtherHelixIsShorter) {
  constexpr int rounds = 40;
  const double radius = 0.2;
  const auto on_bar = [&](double angle, double height) {
    return Vector3(radius * std::sin(angle), -radius * std::cos(angle), height);
  };
  const auto tangent = [&](const Vector3& end) {
    return std::atan2(std::abs(end.x()), -end.y()) -
           std::acos(radius / std::hypot(end.x(), end.y()));
  };
  const double a1 = -tangent(near_end);
  const double a2 = tangent(far_end);
  const auto helix = [&](double z1, double z2) {
    return (on_bar(a1, z1) - near_end).norm() + (far_end - on_bar(a2, z2)).norm() +
           std::hypot(radius * (a2 - a1), z2 - z1);
  };
  const double found = least(rounds, 0.1, 0.7, [&](double z1) {
    return least(rounds, 0.1, 0.8, [&](double z2) { return helix(z1, z2); });
  });
  std::vector<GeodesicStop> stops{below(surface(Vector3::Zero(), radius, 2.0, false))};
  EXPECT_NEAR(shortest(stops, near_end, far_end), found, 1e-14);
}

// The derivatives of the least length by the places of its ends are the directions of the spans. Its
// derivatives by the place and the turn of a body are the force and the torque of both spans on the
// body; the torque about the axis of a bar is 0.
TEST(GeodesicChain, TheGradientOfTheLengthIsTheDirectionOfTheSpans) {
  const Vector3 axis(0.2, 0.1, 1.0);
  for (const bool round_ends : {false, true}) {
    for (const double half_length : {0.0, 0.35}) {
      if (!round_ends && half_length == 0.0) continue;
      const SmoothSurface body = surface({0.1, 0.1, 0.3}, 0.2, half_length, round_ends, axis);
      const auto length = [&](const Vector3& a, const SmoothSurface& on, const Vector3& b) {
        std::vector<GeodesicStop> stops{below(on)};
        return shortest(stops, a, b);
      };
      std::vector<GeodesicStop> stops{below(body)};
      shortest(stops, near_end, far_end);
      const Vector3 in = (stops[0].entry.point - near_end).normalized();
      const Vector3 out = (far_end - stops[0].way.end.point).normalized();
      // Central differences of 1e-5: 1e-10 of the third derivative, 1e-16 / 1e-5 of rounding.
      const double e = 1e-5;
      for (int i = 0; i < 3; ++i) {
        const Vector3 d = e * Vector3::Unit(i);
        EXPECT_NEAR(
            (length(near_end + d, body, far_end) - length(near_end - d, body, far_end)) / (2.0 * e),
            -in[i], 2e-9);
        EXPECT_NEAR(
            (length(near_end, body, far_end + d) - length(near_end, body, far_end - d)) / (2.0 * e),
            out[i], 2e-9);
        SmoothSurface there = body;
        SmoothSurface here = body;
        there.center += d;
        here.center -= d;
        EXPECT_NEAR(
            (length(near_end, there, far_end) - length(near_end, here, far_end)) / (2.0 * e),
            in[i] - out[i], 2e-9);
        there.center = here.center = body.center;
        there.axis = rotation_by(d) * body.axis;
        here.axis = rotation_by(-d) * body.axis;
        const Vector3 torque = (stops[0].entry.point - body.center).cross(in) -
                               (stops[0].way.end.point - body.center).cross(out);
        EXPECT_NEAR(
            (length(near_end, there, far_end) - length(near_end, here, far_end)) / (2.0 * e),
            torque[i], 2e-9);
        EXPECT_NEAR(torque.dot(body.axis), 0.0, 1e-14);
      }
    }
  }
}

// On a ball it is a great circle; a capsule whose core has no length left is one, and beside the
// caps it is a bar.
TEST(GeodesicChain, ACapsuleIsABallOrABar) {
  const Vector3 center(0.1, 0.05, 0.4);
  std::vector<GeodesicStop> ball{below(surface(center, 0.2, 0.0, true))};
  const double over_ball = shortest(ball, near_end, far_end);
  const double d1 = (near_end - center).norm();
  const double d2 = (far_end - center).norm();
  // Round the far side of the ball, by more than half a turn between the ends.
  const double between =
      2.0 * pi - std::acos((near_end - center).dot(far_end - center) / (d1 * d2));
  const double arc = between - std::acos(0.2 / d1) - std::acos(0.2 / d2);
  EXPECT_NEAR(over_ball, std::sqrt(d1 * d1 - 0.04) + std::sqrt(d2 * d2 - 0.04) + 0.2 * arc, 1e-14);
  for (const double half_length : {1e-2, 1e-4, 1e-6, 1e-15}) {
    std::vector<GeodesicStop> capsule{below(surface(center, 0.2, half_length, true))};
    // No point of it is farther from the ball's than the core is long.
    EXPECT_NEAR(shortest(capsule, near_end, far_end), over_ball, 2.0 * half_length + 1e-14);
  }
  std::vector<GeodesicStop> bar{below(surface(center, 0.2, 1.0, false))};
  std::vector<GeodesicStop> capsule{below(surface(center, 0.2, 1.0, true))};
  EXPECT_NEAR(shortest(capsule, near_end, far_end), shortest(bar, near_end, far_end), 1e-14);
}

// A way that comes onto a capsule's side and leaves it on the cap, or crosses both caps, is as long
// as the least over where it crosses a seam, of which each side is a helix and a great circle
// between points: golden section over the ends of the free spans and the crossing.
TEST(GeodesicChain, AGeodesicContinuesOverTheSeamOfACapsule) {
  const SmoothSurface capsule = surface(Vector3::Zero(), 0.2, 0.3, true);
  const Vector3 a(-1.0, 0.41, -0.43);
  const Vector3 b(0.33, 0.2, 0.51);
  std::vector<GeodesicStop> stops{below(capsule)};
  const double length = shortest(stops, a, b);
  ASSERT_LT(capsule.height(stops[0].entry.point), 0.3 - 1e-3);
  ASSERT_GT(capsule.height(stops[0].way.end.point), 0.3 + 1e-3);
  const Vector3 cap(0.0, 0.0, 0.3);
  // From the seam over the cap to b, in closed form; to the seam from a by unrolling.
  const auto over_cap = [&](const Vector3& seam) {
    const double d = (b - cap).norm();
    const double between = std::acos((seam - cap).dot(b - cap) / (0.2 * d));
    return std::sqrt(d * d - 0.04) + 0.2 * (between - std::acos(0.2 / d));
  };
  const auto to_seam = [&](double angle) {
    const double d = std::hypot(a.x(), a.y());
    const double below_a = std::atan2(-a.x(), -a.y());
    const double arc = 0.2 * (below_a + angle - std::acos(0.2 / d));
    return std::hypot(std::sqrt(d * d - 0.04) + arc, 0.3 - a.z());
  };
  const double found = least(60, -0.4, 1.0, [&](double angle) {
    return to_seam(angle) + over_cap({0.2 * std::sin(angle), -0.2 * std::cos(angle), 0.3});
  });
  EXPECT_NEAR(length, found, 1e-13);
}

TEST(GeodesicChain, SeveralInARowAreFoundTogether) {
  // Two bars side by side, 1 mm apart, and a ball between bars, far from where the search begins.
  const SmoothSurface first = surface({-0.101, 0.0, 0.0}, 0.1, 3.0, false);
  const SmoothSurface second = surface({0.1, 0.0, 0.0}, 0.1, 3.0, false);
  const Vector3 a(-3.0, 0.6, -1.0);
  const Vector3 b(4.0, 0.8, 2.0);
  std::vector<GeodesicStop> pair{below(first), below(second)};
  const double length = shortest(pair, a, b);
  const double da = std::hypot(a.x() + 0.101, a.y());
  const double db = std::hypot(b.x() - 0.1, b.y());
  const double level = std::sqrt(da * da - 0.01) + std::sqrt(db * db - 0.01) + 0.201 +
                       0.1 * (std::atan2(-a.x() - 0.101, -a.y()) - std::acos(0.1 / da)) +
                       0.1 * (std::atan2(b.x() - 0.1, -b.y()) - std::acos(0.1 / db));
  EXPECT_NEAR(length, std::hypot(level, 3.0), 2e-14 * 10.0);

  std::vector<GeodesicStop> row{
      below(surface({-1.0, 0.0, 0.0}, 0.1, 3.0, false, {0.1, 0.0, 1.0})),
      below(surface({0.0, -0.1, 0.3}, 0.2, 0.0, true)),
      below(surface({1.0, 0.0, 0.5}, 0.15, 3.0, false, {-0.2, 0.1, 1.0}))};
  const double whole = shortest(row, a, b);
  // Counted from the other end it is the same.
  std::vector<GeodesicStop> back;
  for (std::size_t i = row.size(); i-- > 0;) {
    back.push_back(below(row[i].surface));
    back.back().entry.tangent = -back.back().entry.tangent;
  }
  EXPECT_NEAR(shortest(back, b, a), whole, 1e-13);
  for (const GeodesicStop& stop : row) EXPECT_GT(stop.length, 0.0);
  // Moved and turned it is, too.
  const Quaternion turn = rotation_by({0.3, -1.1, 2.0});
  const Vector3 away(3.0, -2.0, 1.0);
  std::vector<GeodesicStop> turned;
  for (const GeodesicStop& stop : row) {
    GeodesicStop there = below(stop.surface);
    there.surface.center = turn * there.surface.center + away;
    there.surface.axis = turn * there.surface.axis;
    there.entry = {turn * there.entry.point + away, turn * there.entry.tangent,
                   turn * there.entry.outward};
    turned.push_back(there);
  }
  EXPECT_NEAR(shortest(turned, turn * a + away, turn * b + away), whole, 1e-13);
}

TEST(GeodesicChain, ReportsThatNoShortestPathExists) {
  // Over the end of a tilted capsule: the rope would slide off over the cap.
  std::vector<GeodesicStop> stops{
      below(surface({0.0, 0.0752, 0.0684}, 0.1336, 0.4, true, {0.0636, 0.3591, 0.9311}))};
  EXPECT_FALSE(find_shortest_way(stops, point({-2.0, 0.5, 0.4915}), point({2.0, 0.6977, 0.2795})));
}

TEST(SmoothSurface, NeighbouringGeodesicsAgreeWithFiniteDifferences) {
  const SmoothSurface capsule = surface(Vector3::Zero(), 0.1, 0.2, true, {0.3, 0.1, 1.0});
  const SurfaceFrame start = capsule.frame({0.1, 0.02, 0.15}, {0.0, 1.0, 1.5});
  const double e = 1e-6;
  for (const double length : {0.02, 0.2, 0.33, 0.9, -0.4}) {
    const SurfaceWay way = straightest_way(capsule, start, length);
    const Vector3 across = way.end.across();
    SurfaceFrame aside = start;
    aside.tangent = (start.tangent + e * start.across()).normalized();
    // A bend on a seam leaves an error in proportion to e.
    EXPECT_NEAR((straightest_way(capsule, aside, length).end.point - way.end.point).dot(across) / e,
                way.turned_off, 1e-4);
    aside = capsule.frame(start.point + e * start.across(), start.tangent);
    EXPECT_NEAR((straightest_way(capsule, aside, length).end.point - way.end.point).dot(across) / e,
                way.shifted, 1e-4);
    // There and back.
    EXPECT_LT((straightest_way(capsule, way.end, -length).end.point - start.point).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace sheave
