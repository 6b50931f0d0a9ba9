// The tangent formula against geometry done the long way.

#include "cable/span_geometry.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace sheave {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

struct Random {
  std::mt19937 source{7};
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(source()) / 4294967296.0);
  }
  Vector3 unit() {
    Vector3 v;
    do {
      v = {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
    } while (v.squaredNorm() > 1.0 || v.squaredNorm() < 0.01);
    return v.normalized();
  }
};

// What a span must be, whatever formula made it. The cable runs along `direction`; round a circle
// of signed radius q it moves counter-clockwise for q > 0, so at the tangent point a the direction
// of travel is sign(q) n x (a - c)/|q|, i.e. n x (a - c) = q u; for points a = c. All quantities
// are of the order of the distance, and a handful of operations round: 16 eps of it. The length
// comes from d^2 - q^2 and so loses digits as 1/l.
void expect_tangent(const Vector3& c1, double q1, const Vector3& c2, double q2, const Vector3& n,
                    const SpanGeometry& span) {
  const double size = c1.norm() + c2.norm() + std::abs(q1) + std::abs(q2);
  const double tolerance = 16.0 * eps * size * std::max(1.0, size / span.length);
  EXPECT_TRUE(span.has_tangent);
  EXPECT_NEAR(span.direction.norm(), 1.0, tolerance / size);
  EXPECT_NEAR((span.end - span.start).norm(), span.length, tolerance);
  EXPECT_LE((span.end - span.start - span.length * span.direction).norm(), tolerance);
  EXPECT_LE((n.cross(span.start - c1) - q1 * span.direction).norm(), tolerance);
  EXPECT_LE((n.cross(span.end - c2) - q2 * span.direction).norm(), tolerance);
  EXPECT_NEAR((span.start - c1).norm(), std::abs(q1), tolerance);
  EXPECT_NEAR((span.end - c2).norm(), std::abs(q2), tolerance);
}

TEST(PlanarSpan, TouchesBothCirclesInTheDirectionOfTheirWindings) {
  Random random;
  for (int i = 0; i < 20000; ++i) {
    const Vector3 n = random.unit();
    const Vector3 along = any_perpendicular(n);
    const Vector3 c1{random(-2, 2), random(-2, 2), random(-2, 2)};
    // All four tangents, points and circles, radii from a millionth to a million.
    const double scale = std::pow(10.0, random(-6, 6));
    const double q1 = i % 3 == 0 ? 0.0 : scale * random(-1, 1);
    const double q2 = i % 5 == 0 ? 0.0 : scale * random(-1, 1);
    const double d = std::abs(q2 - q1) * (1.0 + std::pow(10.0, random(-3, 3))) + 1e-3 * scale;
    const Vector3 c2 = c1 * scale + d * (rotation_by(random(0, 2 * pi) * n) * along);
    const SpanGeometry span = planar_span(c1 * scale, q1, c2, q2, n);
    expect_tangent(c1 * scale, q1, c2, q2, n, span);
    if (HasFailure()) FAIL() << "case " << i;
  }
}

TEST(PlanarSpan, IsTheTangentFoundByBruteForce) {
  // Brute force: among 2 pi of directions u, the one for which the line from c1 - q1 left(u) along
  // u passes c2 at the signed distance q2: bisection on f(phi) = left(u).(c2 - c1) + q2 - q1 ... =
  // 0, forwards (u.(c2 - c1) > 0).
  Random random;
  const Vector3 n = Vector3::UnitZ();
  for (int i = 0; i < 500; ++i) {
    const Vector3 c1{random(-1, 1), random(-1, 1), 0.0};
    const Vector3 c2{c1.x() + random(2, 4), c1.y() + random(-1, 1), 0.0};
    const double q1 = random(-0.9, 0.9);
    const double q2 = random(-0.9, 0.9);
    const double base = std::atan2(c2.y() - c1.y(), c2.x() - c1.x());
    const auto miss = [&](double phi) {
      const Vector3 u{std::cos(phi), std::sin(phi), 0.0};
      const Vector3 l = n.cross(u);
      return l.dot((c2 - q2 * l) - (c1 - q1 * l));
    };
    double low = base - pi / 2;
    double high = base + pi / 2;
    ASSERT_LT(miss(low) * miss(high), 0.0);
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (miss(low) * miss(middle) <= 0.0 ? high : low) = middle;
    }
    const Vector3 u{std::cos(low), std::sin(low), 0.0};
    const SpanGeometry span = planar_span(c1, q1, c2, q2, n);
    // The bisection ends at the rounding of miss, 4 eps of lengths of about 5.
    EXPECT_LE((span.direction - u).norm(), 100.0 * eps);
    EXPECT_LE((span.start - (c1 - q1 * n.cross(u))).norm(), 100.0 * eps);
    EXPECT_LE((span.end - (c2 - q2 * n.cross(u))).norm(), 100.0 * eps);
  }
}

TEST(PlanarSpan, IsContinuousWhereTheTangentEnds) {
  const Vector3 n = Vector3::UnitZ();
  for (const auto& [q1, q2] : {std::pair{0.3, -0.4}, std::pair{0.2, 0.9}, std::pair{-0.9, -0.2},
                               std::pair{0.0, 0.5}, std::pair{-0.5, 0.0}}) {
    const double limit = std::abs(q2 - q1);
    // With d = limit (1 + e), l = limit sqrt(2 e) and everything else moves by at most as much.
    for (const double e : {1e-4, 1e-8, 1e-12}) {
      const SpanGeometry out = planar_span(Vector3::Zero(), q1, {limit * (1 + e), 0, 0}, q2, n);
      const SpanGeometry in = planar_span(Vector3::Zero(), q1, {limit * (1 - e), 0, 0}, q2, n);
      EXPECT_TRUE(out.has_tangent);
      EXPECT_FALSE(in.has_tangent);
      EXPECT_EQ(in.length, 0.0);
      const double change = 2.0 * limit * std::sqrt(2.0 * e) + 10.0 * eps;
      EXPECT_LE(out.length, change);
      EXPECT_LE((out.direction - in.direction).norm(), change / limit);
      EXPECT_LE((out.start - in.start).norm(), change);
      EXPECT_LE((out.end - in.end).norm(), change);
      EXPECT_NEAR(in.direction.norm(), 1.0, 4.0 * eps);
    }
  }
}

TEST(PlanarSpan, IsFiniteForConcentricCircles) {
  for (const auto& [q1, q2] : {std::pair{0.3, -0.4}, std::pair{0.2, 0.2}, std::pair{0.0, 0.0}}) {
    const SpanGeometry span =
        planar_span(Vector3::Zero(), q1, Vector3::Zero(), q2, Vector3::UnitZ());
    EXPECT_EQ(span.length, 0.0);
    EXPECT_TRUE(span.start.allFinite() && span.end.allFinite() && span.direction.allFinite());
  }
}

TEST(PlanarSpan, ReversedCableIsTheSameSpan) {
  // Walking the cable backwards swaps the links and reverses the windings.
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Vector3 n = random.unit();
    const Vector3 c2 = 3.0 * any_perpendicular(n);
    const double q1 = random(-1, 1);
    const double q2 = random(-1, 1);
    const SpanGeometry there = planar_span(Vector3::Zero(), q1, c2, q2, n);
    const SpanGeometry back = planar_span(c2, -q2, Vector3::Zero(), -q1, n);
    EXPECT_NEAR(there.length, back.length, 8.0 * eps);
    EXPECT_LE((there.start - back.end).norm() + (there.end - back.start).norm(), 32.0 * eps);
  }
}

TEST(SpatialSpan, AgreesWithThePlanarFormulaInOnePlane) {
  // The alternation stops at 4e-15 of the size; its contraction (r1/d)(r2/d) <= 1/4 here leaves at
  // most a third of that as error.
  Random random;
  double worst = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 n = random.unit();
    const Vector3 c1{random(-1, 1), random(-1, 1), random(-1, 1)};
    const Vector3 c2 =
        c1 + random(2.0, 5.0) * (rotation_by(random(0, 2 * pi) * n) * any_perpendicular(n));
    const double q1 = i % 4 == 0 ? 0.0 : random(-0.95, 0.95);
    const double q2 = i % 7 == 0 ? 0.0 : random(-0.95, 0.95);
    const SpanGeometry plane = planar_span(c1, q1, c2, q2, n);
    // A normal of the other sign is the same plane with the other winding.
    const bool flip = i % 2 == 0;
    const SpanGeometry space =
        spatial_span({c1, n, q1}, {c2, flip ? Vector3(-n) : n, flip ? -q2 : q2});
    EXPECT_TRUE(space.has_tangent);
    worst = std::max({worst, (plane.start - space.start).norm(), (plane.end - space.end).norm(),
                      std::abs(plane.length - space.length),
                      (plane.direction - space.direction).norm()});
  }
  EXPECT_LT(worst, 1e-13);
}

/// Largest deviation of a span between circles from what its ends must be [m]: in the plane of the
/// circle, perpendicular to the radius there, and with the moment of the circle's radius about the
/// axle.
double tangency_error(const LinkCircle& a, const LinkCircle& b, const SpanGeometry& span) {
  const auto error = [&](const LinkCircle& circle, const Vector3& at) {
    const Vector3 arm = at - circle.center;
    if (circle.signed_radius == 0.0) return arm.norm();
    const double moment = circle.normal.dot(arm.cross(span.direction));
    return std::abs(moment - circle.signed_radius) + std::abs(arm.dot(circle.normal)) +
           std::abs(arm.dot(span.direction));
  };
  return std::max(error(a, span.start), error(b, span.end));
}

/// Length of the span as seen along the normal of the circle; 1 for a point.
double seen_length(const LinkCircle& circle, const SpanGeometry& span) {
  if (circle.signed_radius == 0.0) return 1.0;
  return (span.length * span.direction).cross(circle.normal).norm();
}

TEST(SpatialSpan, HasTheMomentsOfBothCirclesAboutTheirAxles) {
  Random random;
  int checked = 0;
  int unsolved = 0;
  double worst = 0.0;
  for (int i = 0; i < 50000; ++i) {
    const LinkCircle a{{0, 0, 0}, random.unit(), i % 5 == 0 ? 0.0 : random(-0.5, 0.5)};
    const LinkCircle b{2.0 * random.unit(), random.unit(), i % 3 == 0 ? 0.0 : random(-0.5, 0.5)};
    const SpanGeometry span = spatial_span(a, b);
    if (!span.has_tangent) continue;
    ++checked;
    EXPECT_NEAR(span.length, (span.end - span.start).norm(), 1e-14);
    // A tangent that is short in this view loses digits, as 1/l, at both ends.
    const double sharpness = seen_length(a, span) * seen_length(b, span);
    const double error = tangency_error(a, b, span) * std::min(1.0, sharpness * sharpness);
    // An end is rounded to 1 ulp of its distance, 2 m, and moves by more than the direction turns
    // where the span leans far: by q / cos^2.
    if (error > 1e-12) ++unsolved;
    worst = std::max(worst, error);
    for (const auto& [circle, at] : {std::pair{a, span.start}, std::pair{b, span.end}}) {
      if (circle.signed_radius == 0.0 || error > 1e-12) continue;
      // It runs with the winding.
      EXPECT_GT(circle.signed_radius * circle.normal.cross(at - circle.center).dot(span.direction),
                0.0);
    }
  }
  EXPECT_GT(checked, 40000);
  EXPECT_EQ(unsolved, 0) << "largest error " << worst << " m";
}

TEST(SpatialSpan, AGuessDoesNotChangeTheResult) {
  // Guesses from as near as rounding to anywhere on the rims. Both searches end within 1e-14 of the
  // solution, times the condition 1/l of a tangent that is short as seen along a normal, at either
  // end.
  Random random;
  int without = 0;
  for (int i = 0; i < 50000; ++i) {
    const LinkCircle a{{0, 0, 0}, random.unit(), random(-0.9, 0.9)};
    const LinkCircle b{random(0.5, 3.0) * random.unit(), random.unit(), random(-0.9, 0.9)};
    const SpanGeometry span = spatial_span(a, b);
    const double off = std::pow(10.0, random(-16.0, 0.5));
    const SpanGuess guess{span.start + off * random.unit(), span.end + off * random.unit()};
    const SpanGeometry again = spatial_span(a, b, &guess);
    ASSERT_EQ(again.has_tangent, span.has_tangent) << i;
    if (!span.has_tangent) {
      ++without;
      continue;
    }
    const double sharpness = std::min(1.0, seen_length(a, span) * seen_length(b, span));
    const double allowed = 1e-13 / sharpness;
    EXPECT_LT((again.start - span.start).norm(), allowed) << i;
    EXPECT_LT((again.end - span.end).norm(), allowed) << i;
  }
  EXPECT_GT(without, 1000);
}

// Round a wheel to a point the way is r phi + l, phi being the angle of the tangent point. A rope
// without friction, that nothing but the wheel bends, pulls along itself with its tension: the
// gradient of the way is the span's direction, of size 1. (Left at the radius r it is 1.0042 here,
// as in the scene of tests/statics/equilibrium_test.cpp, with the difference across the rope.)
// Central differences of 1e-5 leave 1e-10 of the third derivative and 1e-11 of rounding.
TEST(SpatialSpan, ThePathRoundAWheelIsThatOfATautString) {
  const LinkCircle wheel{Vector3::Zero(), Vector3::UnitY(), 1.0};
  const auto way = [&](const Vector3& p) {
    const SpanGeometry span = spatial_span(wheel, {p, {}, 0.0});
    return std::atan2(span.start.x(), span.start.z()) + span.length;
  };
  constexpr double d = 1e-5;
  for (const Vector3& p :
       {Vector3(3.0, -3.0, 1.0), Vector3(3.0, 0.4, 0.2), Vector3(1.2, 0.3, 0.9)}) {
    Vector3 gradient;
    for (int i = 0; i < 3; ++i) {
      const Vector3 step = d * Vector3::Unit(i);
      gradient[i] = (way(p + step) - way(p - step)) / (2.0 * d);
    }
    const SpanGeometry span = spatial_span(wheel, {p, {}, 0.0});
    ASSERT_TRUE(span.has_tangent);
    EXPECT_LT((gradient - span.direction).norm(), 1e-8) << p.transpose();
  }
}

TEST(SpatialSpan, IsContinuousWhereNoGrooveHoldsIt) {
  // A point at the height z over a wheel of radius r: the tangent ends at the distance d with
  // d^2 - r^2 = 2 r |z|, where m^2 = (d^2 - r^2) / 2 and the length is sqrt(m^2 + z^2). The root
  // there is of the second order in the distance, so 1e-12 of that is 1e-6 of the length.
  const LinkCircle circle{Vector3::Zero(), Vector3::UnitZ(), 0.5};
  const double z = 0.3;
  const double d = std::sqrt(0.25 + 2.0 * 0.5 * z);
  const SpanGeometry outside = spatial_span({{d * (1 + 1e-12), 0, z}, {}, 0.0}, circle);
  const SpanGeometry inside = spatial_span({{d * (1 - 1e-12), 0, z}, {}, 0.0}, circle);
  EXPECT_TRUE(outside.has_tangent);
  EXPECT_FALSE(inside.has_tangent);
  EXPECT_NEAR(outside.length, std::sqrt(0.15 + z * z), 1e-5);
  EXPECT_NEAR(inside.length, outside.length, 1e-5);
  // On the axle the length is the height.
  const SpanGeometry above = spatial_span({{1e-9, 0, z}, {}, 0.0}, circle);
  EXPECT_FALSE(above.has_tangent);
  EXPECT_NEAR(above.length, z, 1e-8);
}

TEST(AngleBetween, IsAccurateOnBothSidesOfTheSwitchToTheSeries) {
  // The switch is at sine^2 = 1e-3. The inputs' own rounding, eps/2 per component, limits the angle
  // to a few eps absolute.
  const Vector3 n = Vector3::UnitZ();
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = i * (pi - 1e-6) / 4000.0;
    const Vector3 to{std::cos(angle), std::sin(angle), 0.0};
    EXPECT_NEAR(angle_between(Vector3::UnitX(), to, n), angle, 4.0 * eps) << angle;
    EXPECT_NEAR(angle_between(Vector3::UnitX(), to, -n), -angle, 4.0 * eps) << angle;
  }
  const double edge = std::asin(std::sqrt(1e-3));
  for (int i = -1000; i <= 1000; ++i) {
    const double angle = edge * (1.0 + i * 1e-6);
    const Vector3 to{std::cos(angle), std::sin(angle), 0.0};
    // Relative, 2 eps beyond what the rounding of cos and sin allows.
    EXPECT_NEAR(angle_between(Vector3::UnitX(), to, n), angle, 3.0 * eps * angle);
  }
  // Small angles keep all their digits.
  for (const double angle : {1e-3, 1e-6, 1e-9, 1e-15, 1e-100}) {
    const Vector3 to{std::cos(angle), std::sin(angle), 0.0};
    EXPECT_NEAR(angle_between(Vector3::UnitX(), to, n), angle, 2.0 * eps * angle);
  }
}

TEST(Unwrapped, FindsTheTurnClosestToTheExpectedAngle) {
  for (const double expected : {0.0, 3.0, -3.0, 7.0, 31.4, -100.0, 1e4}) {
    for (const double off : {-3.1, -1.0, 0.0, 0.5, 3.1}) {
      const double angle = expected + off;
      const double wrapped = std::remainder(angle, 2.0 * pi);
      // The multiples of 2 pi are rounded to eps of themselves.
      EXPECT_NEAR(unwrapped(wrapped, expected), angle, 4.0 * eps * (10.0 + std::abs(angle)));
    }
  }
}

}  // namespace
}  // namespace sheave
