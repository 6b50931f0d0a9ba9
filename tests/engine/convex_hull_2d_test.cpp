#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/shapes/convex_hull.h"

namespace sheave {
namespace {

using Points = std::vector<Vector3>;

double polygon_area(const Points& corners) {
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    area += 0.5 * corners[i].cross(corners[(i + 1) % corners.size()]).z();
  }
  return area;
}

Points placed(Points points, double angle, double scale, const Vector3& shift) {
  const Quaternion turn = rotation_by({0.0, 0.0, angle});
  for (Vector3& point : points) {
    point = shift + scale * (turn * point);
  }
  return points;
}

TEST(Hull2d, KeepsOnlyTheCornersInCounterClockwiseOrder) {
  const Points points{{2, 1, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0.5, 0},
                      {0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0.5, 0}};
  const auto hull = hull_2d(points);
  ASSERT_TRUE(hull.ok());
  EXPECT_EQ(*hull, (Points{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
}

TEST(Hull2d, IgnoresZ) {
  const auto hull = hull_2d(Points{{0, 0, 5}, {1, 0, -5}, {0, 1, 7}});
  ASSERT_TRUE(hull.ok());
  EXPECT_EQ(*hull, (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Hull2d, RemovesEdgePointsThatRoundingPushedOutwards) {
  Points square;
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      square.emplace_back(0.1 * i, 0.1 * j, 0.0);
    }
  }
  for (int step = 1; step < 50; ++step) {
    const Points points = placed(square, 0.1257 * step, 3.0, {5.0, -7.0, 0.0});
    const auto hull = hull_2d(points);
    ASSERT_TRUE(hull.ok());
    EXPECT_EQ(hull->size(), 4U) << step;
    // Coordinates up to 10 with 1 eps relative error each along edges of 3.
    EXPECT_NEAR(polygon_area(*hull), 9.0, 2e-13);
  }
}

TEST(Hull2d, KeepsOneOfSeveralPointsWithinRoundingOfACorner) {
  const double speck = 1e-13;
  Points points;
  for (const Vector3& corner :
       {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(0, 1, 0)}) {
    points.push_back(corner);
    points.push_back(corner + Vector3(speck, 0, 0));
    points.push_back(corner + Vector3(0, speck, 0));
    points.push_back(corner + Vector3(-speck, -2.0 * speck, 0));
  }
  const auto hull = hull_2d(points);
  ASSERT_TRUE(hull.ok());
  EXPECT_EQ(hull->size(), 4U);
  EXPECT_NEAR(polygon_area(*hull), 1.0, 8.0 * speck);
  // The first and the last corner of the chain, some cells apart: one of them must stay.
  const double cell = 0x1p-40;
  const auto triangle = hull_2d(Points{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {cell, 3 * cell, 0}});
  ASSERT_TRUE(triangle.ok());
  EXPECT_EQ(triangle->size(), 3U);
}

TEST(Hull2d, IsConvexAndContainsAllPoints) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (int trial = 0; trial < 30; ++trial) {
    Points points(200, Vector3::Zero());
    for (Vector3& point : points) {
      point.head<2>() << coordinate(random), coordinate(random);
    }
    const auto hull = hull_2d(points);
    ASSERT_TRUE(hull.ok());
    for (std::size_t i = 0; i < hull->size(); ++i) {
      const Vector3 corner = (*hull)[i];
      const Vector3 edge = (*hull)[(i + 1) % hull->size()] - corner;
      EXPECT_NE(std::ranges::find(points, corner), points.end());
      EXPECT_GT(edge.cross((*hull)[(i + 2) % hull->size()] - corner).z(), 0.0);
      for (const Vector3& point : points) {
        // The 4 grid cells that may be left out and the rounding to the grid: 6 cells of 2 x 2^-40.
        EXPECT_GE(edge.normalized().cross(point - corner).z(), -12.0 * 0x1p-40);
      }
    }
  }
}

TEST(Hull2d, KeepsAllCornersOfAFinePolygon) {
  Points circle;
  for (int i = 0; i < 4096; ++i) {
    const double angle = 2.0 * pi * i / 4096;
    circle.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  const auto hull = hull_2d(circle);
  ASSERT_TRUE(hull.ok());
  EXPECT_EQ(hull->size(), 4096U);
}

TEST(Hull2d, RefusesPointsWithoutAnArea) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Points line;
  for (int i = 0; i < 50; ++i) {
    line.emplace_back(0.1 * i, 0.3 * i, 0.0);
  }
  for (const Points& points :
       {Points{}, Points{{1, 2, 0}}, Points(5, Vector3(1, 2, 0)), Points{{0, 0, 0}, {1, 1, 0}},
        Points{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, line, placed(line, 0.7, 1e6, {3, 4, 0}),
        Points{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, Points{{0, 0, 0}, {1, 0, 0}, {0, infinity, 0}},
        Points{{-1.5e308, 0, 0}, {1.5e308, 0, 0}, {0, 1, 0}}}) {
    const auto hull = hull_2d(points);
    ASSERT_FALSE(hull.ok());
    EXPECT_EQ(hull.errors().size(), 1U);
  }
  // Height over four times the extent is what is compared with 1e-9.
  EXPECT_FALSE(hull_2d(Points{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-10, 0}}).ok());
  EXPECT_TRUE(hull_2d(Points{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-8, 0}}).ok());
  EXPECT_NE(hull_2d(line).errors()[0].message.find("enclose no area"), std::string::npos);
}

}  // namespace
}  // namespace sheave
