#include "cable/outline.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave {
namespace {

constexpr double digits = 1e-14;

Outline outline_of(const std::vector<Vector3>& points, double corner_radius = 0.0) {
  Result<Outline> outline = Outline::create(points, corner_radius);
  if (!outline) throw std::runtime_error(test::text(outline.errors()));
  return std::move(*outline);
}

Outline square(double corner_radius) {
  return outline_of({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {1, 0.5, 0}}, corner_radius);
}

std::vector<Vector3> random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(within(random), within(random), 0.0);
  return points;
}

TEST(Outline, DropsPointsInsideTheHull) { EXPECT_EQ(square(0.0).corner_count(), 4); }

TEST(Outline, PerimeterIsTheSumOfEdgesAndCornerArcs) {
  EXPECT_NEAR(square(0.0).perimeter(), 6.0, digits);
  EXPECT_NEAR(square(0.5).perimeter(), 6.0 + pi, digits);
}

TEST(Outline, RefusesPointsOnALineAndNegativeRadii) {
  const std::vector<Vector3> line{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
  EXPECT_FALSE(Outline::create(line));
  const std::vector<Vector3> triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_FALSE(Outline::create(triangle, -0.1));
}

TEST(Outline, SupportIsTheFarthestCornerForAnyStartOfTheSearch) {
  const Outline outline = outline_of(random_points(60, 1));
  ASSERT_GT(outline.corner_count(), 5);
  for (int i = 0; i < 360; ++i) {
    const double x = std::cos(i * pi / 180.0);
    const double y = std::sin(i * pi / 180.0);
    double highest = -2.0;
    for (int k = 0; k < outline.corner_count(); ++k) {
      highest = std::max(highest, x * outline.corner(k).x() + y * outline.corner(k).y());
    }
    for (int near = 0; near < outline.corner_count(); ++near) {
      const Vector3& found = outline.corner(outline.support(x, y, near));
      EXPECT_EQ(x * found.x() + y * found.y(), highest) << i << " from " << near;
    }
  }
}

TEST(Outline, OneTurnIsOnePerimeterAtEveryCornerAndAngle) {
  const Outline outline = outline_of(random_points(40, 2), 0.1);
  for (int k = 0; k < outline.corner_count(); ++k) {
    for (double angle = -20.0; angle < 20.0; angle += 0.37) {
      // Some 10 perimeters of 6 m are summed and subtracted.
      EXPECT_NEAR(outline.distance(k, angle + 2.0 * pi) - outline.distance(k, angle),
                  outline.perimeter(), 100.0 * digits);
    }
  }
}

TEST(Outline, DistanceIsTheLengthOfTheCurve) {
  // Walked along in small steps of the normal angle, corners and edges alike.
  const Outline outline = outline_of(random_points(25, 3), 0.2);
  const auto contact = [&](double angle, int& corner) -> Vector3 {
    const Vector3 outward(std::cos(angle), std::sin(angle), 0.0);
    corner = outline.support(outward.x(), outward.y(), 0);
    return outline.corner(corner) + outline.corner_radius() * outward;
  };
  int corner = 0;
  constexpr int steps = 40000;
  const double from = -7.3;
  const double to = 9.1;  // over two turns
  Vector3 last = contact(from, corner);
  const double start = outline.distance(corner, from);
  double walked = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const Vector3 here = contact(from + (to - from) * i / steps, corner);
    walked += (here - last).norm();
    last = here;
  }
  // A chord of the angle a falls short of its arc by r a^3 / 24; and where a step crosses an edge,
  // the chord cuts the two corners' arcs, at most 2 r a each, in 2.6 turns at most 26 times per
  // corner.
  const double angle = (to - from) / steps;
  EXPECT_NEAR(outline.distance(corner, to) - start, walked,
              4.0 * outline.corner_count() * outline.corner_radius() * angle * angle +
                  steps * outline.corner_radius() * std::pow(angle, 3) / 24.0);
}

}  // namespace
}  // namespace sheave
