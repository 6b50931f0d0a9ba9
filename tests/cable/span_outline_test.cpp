// Spans between convex outlines against all pairs of corners, and against the bound on the rounds
// that finding the corners takes (cable/span_row.cpp): a pair of outlines that do not overlap
// always has its tangent found.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/span_row.h"
#include "engine/model.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/rounding.h"

namespace sheave {
namespace {

/// A machine without bodies: everything is fixed to the world.
struct Nothing {
  BodySet bodies = *BodySet::create(Model{});
  State state = bodies.initial_state();
  Substep now{bodies, state, 1.0, 1};
};

/// A random outline about `center` within a circle of `radius`: a point, a circle or a polygon;
/// corners in the world.
LinkGeometry random_link(test::Random& random, const Vector3& center, double radius) {
  LinkGeometry link;
  link.center = center;
  const int kind = random.below(12);
  if (kind == 0) return link;
  link.side = random.chance(0.5) ? 1 : -1;
  if (kind == 1) {
    link.signed_radius = link.side * radius;
    return link;
  }
  const int count = kind == 2 ? 100 + random.below(157) : 3 + random.below(10);
  const double flat = random.chance(0.3) ? 1e-3 : 1.0;
  const double angle = random.between(0.0, pi);
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) {
    const double at = random.between(0.0, 2.0 * pi);
    points.push_back(radius * Vector3(std::cos(at), flat * std::sin(at), 0.0));
    points.back() = rotation_by(angle * Vector3::UnitZ()) * points.back();
  }
  Result<Outline> curve = Outline::create(points);
  if (!curve) return random_link(random, center, radius);
  LinkOutline outline;
  outline.curve = *curve;
  for (int i = 0; i < outline.curve.corner_count(); ++i) {
    outline.corners.emplace_back(center + outline.curve.corner(i));
  }
  link.outline = std::make_shared<const LinkOutline>(outline);
  return link;
}

SpanSetup planar_setup(const LinkGeometry& a, const LinkGeometry& b) {
  SpanSetup setup;
  setup.kind = SpanKind::planar;
  setup.first_radius = a.signed_radius;
  setup.second_radius = b.signed_radius;
  setup.outlined = a.outline || b.outline;
  return setup;
}

/// Corners, or the one centre of a circle or point.
std::vector<Vector3> corners_of(const LinkGeometry& link) {
  return link.outline ? link.outline->corners : std::vector<Vector3>{link.center};
}

/// How far the link reaches beyond the line of the span, to the side where the cable is [m]; <= 0:
/// it does not. Of more than `enough` it says no more than that.
double reach_beyond(const LinkGeometry& link, const SpanGeometry& span, const Vector3& contact,
                    double enough = 1e300) {
  if (!link.outline) return 0.0;  // circles and points are touched by the formula's construction
  const Vector3 outward = -link.side * Vector3::UnitZ().cross(span.direction);
  double reach = -1e300;
  for (const Vector3& corner : link.outline->corners) {
    reach = std::max(reach, outward.dot(corner - contact));
    if (reach > enough) break;
  }
  return reach;
}

/// The tangent with the least overhang among all pairs of corners; its overhang is positive if
/// there is none.
struct BestPair {
  SpanGeometry span;
  double reach = 1e300;
};

BestPair best_pair(const LinkGeometry& a, const LinkGeometry& b) {
  BestPair best;
  for (const Vector3& p : corners_of(a)) {
    for (const Vector3& q : corners_of(b)) {
      const SpanGeometry span =
          planar_span(p, a.signed_radius, q, b.signed_radius, Vector3::UnitZ());
      if (!span.has_tangent) continue;
      double reach = reach_beyond(a, span, span.start, best.reach);
      if (reach > best.reach) continue;
      reach = std::max(reach, reach_beyond(b, span, span.end, best.reach));
      if (reach < best.reach) best = {span, reach};
    }
  }
  return best;
}

/// Random pairs at a distance `gap` of their circumscribed circles, which so are disjoint.
void compare_with_all_pairs(std::uint64_t seed, int pairs, double low_gap, double high_gap) {
  const Nothing nothing;
  test::Random random(seed);
  for (int i = 0; i < pairs; ++i) {
    const double r1 = random.between(0.05, 1.0);
    const double r2 = std::pow(10.0, random.between(-2.0, 0.0));
    const double gap = std::pow(10.0, random.between(low_gap, high_gap));
    const double angle = random.between(0.0, 2.0 * pi);
    const Vector3 apart = (r1 + r2 + gap) * Vector3(std::cos(angle), std::sin(angle), 0.0);
    const LinkGeometry a = random_link(random, Vector3::Zero(), r1);
    const LinkGeometry b = random_link(random, apart, r2);
    const SpanGeometry span = span_geometry(nothing.now, planar_setup(a, b), a, b);
    ASSERT_TRUE(span.has_tangent) << "seed " << seed << ", pair " << i;
    // Heights of corners are compared with an error of 4 eps of their size. The span's direction is
    // exact to that over its length, and an outline of the size 2 r turns with it.
    const double size = apart.norm() + 2.0;
    const double tolerance = 16.0 * test::eps * size * (1.0 + 2.0 / std::max(span.length, 1e-300));
    EXPECT_LE(reach_beyond(a, span, span.start), tolerance) << "seed " << seed << ", pair " << i;
    EXPECT_LE(reach_beyond(b, span, span.end), tolerance) << "seed " << seed << ", pair " << i;
    const BestPair best = best_pair(a, b);
    // The line is the same; on an edge that lies along it the corner may be either one.
    const double along = (span.direction - best.span.direction).norm();
    const double aside =
        std::abs(Vector3::UnitZ().cross(span.direction).dot(span.start - best.span.start));
    const double direction_error =
        tolerance * (1.0 / std::max(span.length, 1e-300) + 1.0 / best.span.length);
    EXPECT_LE(along, direction_error) << "seed " << seed << ", pair " << i;
    EXPECT_LE(aside, tolerance + 2.0 * direction_error) << "seed " << seed << ", pair " << i;
    if (testing::Test::HasFailure()) return;
  }
}

TEST(OutlineSpan, IsTheOnlyPairOfCornersThatNothingReachesBeyond) {
  compare_with_all_pairs(1, test::long_run(100000), -1.0, 1.0);
}

TEST(OutlineSpan, IsFoundForOutlinesThatNearlyTouch) {
  compare_with_all_pairs(2, test::long_run(100000), -9.0, -1.0);
}

TEST(OutlineSpan, IsFoundWhereverOutlinesDoNotOverlap) {
  // Closer than their circumscribed circles allow. Two convex outlines do not overlap if a line
  // along an edge of one has them on different sides.
  const Nothing nothing;
  test::Random random(3);
  int apart_pairs = 0;
  for (int i = 0; i < test::long_run(200000); ++i) {
    const LinkGeometry a = random_link(random, Vector3::Zero(), 1.0);
    const double angle = random.between(0.0, 2.0 * pi);
    const Vector3 place = random.between(0.0, 2.0) * Vector3(std::cos(angle), std::sin(angle), 0.0);
    const LinkGeometry b = random_link(random, place, random.between(0.05, 1.0));
    if (!a.outline || !b.outline) continue;
    const auto separates = [](const LinkGeometry& one, const LinkGeometry& two) {
      const std::vector<Vector3>& corners = one.outline->corners;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vector3 edge = corners[(k + 1) % corners.size()] - corners[k];
        const Vector3 outward = edge.cross(Vector3::UnitZ());
        const bool outside = std::all_of(
            two.outline->corners.begin(), two.outline->corners.end(),
            [&](const Vector3& p) { return outward.dot(p - corners[k]) > 1e-12 * edge.norm(); });
        if (outside) return true;
      }
      return false;
    };
    if (!separates(a, b) && !separates(b, a)) continue;
    ++apart_pairs;
    const SpanGeometry span = span_geometry(nothing.now, planar_setup(a, b), a, b);
    ASSERT_TRUE(span.has_tangent) << "pair " << i;
    const double tolerance = 64.0 * test::eps * (1.0 + 2.0 / span.length);
    ASSERT_LE(reach_beyond(a, span, span.start), tolerance) << "pair " << i;
    ASSERT_LE(reach_beyond(b, span, span.end), tolerance) << "pair " << i;
  }
  EXPECT_GT(apart_pairs, test::long_run(20000));
}

}  // namespace
}  // namespace sheave
