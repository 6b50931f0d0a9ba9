// The way of a cable through an opening: against a search over the surface, closed forms and finite
// differences.

#include "cable/opening.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace sheave {
namespace {

SmoothSurface surface_of(bool ball, double radius) {
  SmoothSurface surface;
  surface.form = ball ? SurfaceForm::rounded : SurfaceForm::cylinder;
  surface.center = {0.1 * radius, -0.3 * radius, 0.2 * radius};
  surface.axis = Vector3(1.0, 2.0, -0.5).normalized();
  surface.radius = radius;
  return surface;
}

double length(const SmoothSurface& surface, const Vector3& from, const Vector3& to) {
  const Vector3 point = opening_point(surface, from, to);
  return (point - from).norm() + (to - point).norm();
}

/// Distance from the centre or the axis.
double distance(const SmoothSurface& surface, const Vector3& point) {
  const Vector3 arm = point - surface.center;
  if (surface.is_ball()) return arm.norm();
  return (arm - surface.axis.dot(arm) * surface.axis).norm();
}

/// The least length by another method: the point moves along the gradient of the length and is put
/// back into the body (projected gradient), which converges for a convex function on a convex set.
double searched_length(const SmoothSurface& surface, const Vector3& from, const Vector3& to) {
  Vector3 point = surface.center;
  double step = surface.radius;
  const auto sum = [&](const Vector3& at) { return (at - from).norm() + (to - at).norm(); };
  double least = sum(point);
  for (int round = 0; round < 4000 && step > 1e-14 * surface.radius; ++round) {
    const Vector3 pull = (point - from).normalized() + (point - to).normalized();
    Vector3 next = point - step * pull;
    Vector3 arm = next - surface.center;
    if (!surface.is_ball()) arm -= surface.axis.dot(arm) * surface.axis;
    if (arm.norm() > surface.radius) next += (surface.radius / arm.norm() - 1.0) * arm;
    const double now = sum(next);
    if (now < least) {
      least = now;
      point = next;
      step = std::min(1.5 * step, surface.radius);  // far points are put back with an error
    } else {
      step *= 0.5;
    }
  }
  return least;
}

// No way that the search finds is shorter by more than the rounding of some sums, 1e-14. The search
// comes near the minimum, where the length is flat, by its slow way along the surface.
TEST(Opening, TheWayIsTheShortestThatASearchFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  int bent = 0;
  for (int i = 0; i < 4000; ++i) {
    const double radius = std::pow(10.0, 3.0 * number(random));
    const SmoothSurface surface = surface_of(i % 2 == 0, radius);
    const double wide = radius * std::pow(10.0, 0.3 + 0.7 * number(random));
    const auto draw = [&]() -> Vector3 {
      return wide * Vector3(number(random), number(random), number(random));
    };
    const Vector3 from = draw();
    const Vector3 to = draw();
    const Vector3 point = opening_point(surface, from, to);
    const double own = length(surface, from, to);
    EXPECT_LE(distance(surface, point), radius * (1.0 + 1e-14) + 1e-15 * wide);
    EXPECT_NEAR(own, searched_length(surface, from, to), 1e-8 * (own + radius)) << i;
    EXPECT_LE(own, searched_length(surface, from, to) + 1e-14 * (own + radius)) << i;
    EXPECT_NEAR(own, length(surface, to, from), 1e-15 * 16.0 * (own + radius));
    if (own > (to - from).norm() * (1.0 + 1e-12)) ++bent;
  }
  EXPECT_GT(bent, 1000);
}

// On an axis of symmetry the way turns in the middle; with the height h of both points above the
// surface and the distance 2 c it is 2 sqrt(c^2 + h^2) long. On a cylinder also obliquely.
TEST(Opening, BetweenEqualHeightsItTurnsInTheMiddle) {
  for (const double size : {1e-3, 1.0, 1e3}) {
    SmoothSurface ball;
    ball.radius = 0.2 * size;
    const double h = 0.3 * size;
    const double c = 0.7 * size;
    const Vector3 from(-c, 0.0, 0.5 * size);
    const Vector3 to(c, 0.0, 0.5 * size);
    EXPECT_LT((opening_point(ball, from, to) - Vector3(0.0, 0.0, 0.2 * size)).norm(), 1e-15 * size);
    EXPECT_NEAR(length(ball, from, to), 2.0 * std::sqrt(c * c + h * h), 1e-15 * size);
    SmoothSurface bar = ball;
    bar.form = SurfaceForm::cylinder;
    bar.axis = Vector3::UnitY();
    const Vector3 along(0.0, 0.9 * size, 0.0);
    EXPECT_LT((opening_point(bar, from, to + along) - Vector3(0.0, 0.45 * size, 0.2 * size)).norm(),
              1e-15 * size);
    EXPECT_NEAR(length(bar, from, to + along),
                std::sqrt(4.0 * (c * c + h * h) + along.squaredNorm()), 1e-15 * size);
  }
}

TEST(Opening, AStraightLineThroughTheBodyStaysOne) {
  const SmoothSurface ball = surface_of(true, 1.0);
  const SmoothSurface bar = surface_of(false, 1.0);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> number(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    for (const SmoothSurface& surface : {ball, bar}) {
      const Vector3 inside(number(random), number(random), number(random));
      const Vector3 way = 20.0 * Vector3(number(random), number(random), number(random));
      for (const double beyond : {0.0, 1.0}) {
        const Vector3 from = surface.center + inside - beyond * way;
        const Vector3 to = surface.center + inside + way;
        EXPECT_NEAR(length(surface, from, to), (to - from).norm(), 1e-14 * (to - from).norm());
        const Vector3 point = opening_point(surface, from, to);
        EXPECT_LE(distance(surface, point), 1.0 + 1e-14);
      }
    }
  }
  // Both points in one place, outside and inside.
  const Vector3 outside(3.0, 0.0, 0.0);
  EXPECT_NEAR(length(SmoothSurface{.radius = 1.0}, outside, outside), 4.0, 1e-15);
  EXPECT_EQ(length(SmoothSurface{.radius = 1.0}, Vector3::Zero(), Vector3::Zero()), 0.0);
}

// A line that just touches and one that just misses pass at the same point. Inside, the middle of
// the chord is the foot of the line exactly; outside, the place moves in proportion to the gap.
TEST(Opening, ThePlaceIsContinuousWhereTheLineComesOff) {
  for (const bool ball : {true, false}) {
    SmoothSurface surface;
    surface.form = ball ? SurfaceForm::rounded : SurfaceForm::cylinder;
    surface.axis = Vector3::UnitY();
    surface.radius = 1.0;
    const Vector3 foot(0.0, ball ? 0.0 : 2.0, 1.0);
    for (const double gap : {-1e-9, -1e-12, 0.0, 1e-12, 1e-9}) {
      const Vector3 from(-2.0, 0.0, 1.0 + gap);
      const Vector3 to(5.0, ball ? 0.0 : 7.0, 1.0 + gap);
      EXPECT_LT((opening_point(surface, from, to) - foot).norm(), 1e-8) << ball << " " << gap;
    }
  }
}

// By the envelope theorem the derivative of the length is the direction of the spans. The
// difference of fourth order with the step h has an error of h^4 / d^4 and eps / h, with the size d
// of the scene.
TEST(Opening, TheDerivativeOfTheLengthIsTheDirectionOfTheSpans) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const double h = 1e-3;
  for (int i = 0; i < 2000; ++i) {
    const SmoothSurface surface = surface_of(i % 2 == 0, 0.5);
    const auto draw = [&]() -> Vector3 {
      return 2.0 * Vector3(number(random), number(random), number(random));
    };
    const Vector3 from = draw();
    const Vector3 to = draw();
    // Away from the kinks of higher order: a line that touches, and a point near the surface.
    const double gap = length(surface, from, to) - (to - from).norm();
    if (gap < 0.05 || distance(surface, from) < 0.7 || distance(surface, to) < 0.7) continue;
    const Vector3 direction = (from - opening_point(surface, from, to)).normalized();
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](double step) {
        return length(surface, from + step * Vector3::Unit(k), to);
      };
      const double slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
      EXPECT_NEAR(slope, direction[k], 1e-8) << i;
    }
  }
}

}  // namespace
}  // namespace sheave
