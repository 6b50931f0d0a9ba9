#include "engine/shapes/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// A closed convex surface whose vertices are given points and outside of which no given point lies
// is the convex hull: containment gives one inclusion, the choice of vertices the other. So the
// tests check these properties and need no second hull algorithm.

namespace sheave {
namespace {

using Points = std::vector<Vector3>;

// What may lie outside a face: the 4 grid cells of 2^-40 of the extent that the algorithm leaves
// out, and the 0.87 cells by which rounding moves the face's corners and the point.
constexpr double outside_tolerance = 6 * 0x1p-40;

double extent_of(const Points& points) {
  Vector3 low = points.front();
  Vector3 high = points.front();
  for (const Vector3& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).maxCoeff();
}

double volume(const Hull& hull) {
  double sum = 0.0;
  for (const auto& [a, b, c] : hull.triangles) {
    sum += hull.area_vector({a, b, c}).dot(hull.vertices[a] - hull.vertices[0]) / 3.0;
  }
  return sum;
}

bool among(const Vector3& point, const Points& points) {
  return std::ranges::any_of(points, [&](const Vector3& other) { return other == point; });
}

void expect_is_hull(const Hull& hull, const Points& points) {
  // A closed, oriented surface: every edge once in each direction, and Euler's formula of a ball.
  std::set<std::pair<int, int>> edges;
  for (const auto& [a, b, c] : hull.triangles) {
    EXPECT_TRUE(edges.insert({a, b}).second);
    EXPECT_TRUE(edges.insert({b, c}).second);
    EXPECT_TRUE(edges.insert({c, a}).second);
  }
  std::set<int> used;
  for (const auto& [from, to] : edges) {
    EXPECT_TRUE(edges.contains({to, from}));
    used.insert(from);
  }
  EXPECT_EQ(used.size(), hull.vertices.size()) << "a vertex without a face";
  EXPECT_EQ(hull.triangles.size(), 2 * hull.vertices.size() - 4);
  for (const Vector3& vertex : hull.vertices) {
    EXPECT_TRUE(among(vertex, points));
  }
  const double extent = extent_of(points);
  double worst = 0.0;
  for (const auto& [a, b, c] : hull.triangles) {
    const Vector3 u = hull.vertices[b] - hull.vertices[a];
    const Vector3 v = hull.vertices[c] - hull.vertices[a];
    const Vector3 normal = u.cross(v);
    // The corners of a triangle fix its plane at a distance only as well as its height allows.
    const double height = normal.norm() / std::max({u.norm(), v.norm(), (u - v).norm()});
    for (const Vector3& point : points) {
      const double distance = normal.normalized().dot(point - hull.vertices[a]);
      worst = std::max(worst, distance * std::min(1.0, height / extent));
    }
  }
  EXPECT_LE(worst, outside_tolerance * extent) << "a given point is outside";
}

Points random_in_ball(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  Points points;
  while (static_cast<int>(points.size()) < count) {
    const Vector3 point(coordinate(random), coordinate(random), coordinate(random));
    if (point.norm() <= 1.0) points.push_back(point);
  }
  return points;
}

Points on_sphere(int count, unsigned seed) {
  Points points = random_in_ball(count, seed);
  for (Vector3& point : points) {
    point.normalize();
  }
  return points;
}

/// n^3 points of the unit cube: all faces and edges full of coplanar and collinear points.
Points lattice(int n) {
  Points points;
  for (int i = 0; i < n * n * n; ++i) {
    points.push_back(Vector3(i % n, i / n % n, i / (n * n)) / (n - 1));
  }
  return points;
}

Points drum(int sides) {
  Points points;
  for (const double z : {0.0, 0.5, 1.0}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * pi * i / sides;
      points.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  }
  return points;
}

Points moved(Points points, const Vector3& turn, double scale, const Vector3& shift) {
  for (Vector3& point : points) {
    point = shift + scale * (rotation_by(turn) * point);
  }
  return points;
}

Points stretched(Points points, const Vector3& factors) {
  for (Vector3& point : points) {
    point = point.cwiseProduct(factors);
  }
  return points;
}

const Vector3 some_turn(0.3, -1.1, 0.7);

TEST(Hull3d, LatticeHasEightCornersAndTwelveTriangles) {
  for (const int n : {2, 3, 6}) {
    const Points points = lattice(n);
    const auto hull = hull_3d(points);
    ASSERT_TRUE(hull.ok());
    expect_is_hull(*hull, points);
    EXPECT_EQ(hull->vertices.size(), 8U);
    EXPECT_NEAR(volume(*hull), 1.0, 12 * 2.2e-16);  // 12 terms below 1, each rounded
  }
}

TEST(Hull3d, TakesHardlyMoreThanTheCornersOfTurnedFlatFaces) {
  // 152 of the 216 points lie in flat faces up to rounding. Exactly, dozens of them stick out; the
  // tolerance leaves the corners, and at most the first few points chosen, which are lowest or
  // highest by rounding only.
  for (int step = 1; step <= 20; ++step) {
    const auto hull = hull_3d(moved(lattice(6), step * some_turn, 1.0, Vector3::Zero()));
    ASSERT_TRUE(hull.ok());
    EXPECT_LE(hull->vertices.size(), 12U) << step;
  }
}

TEST(Hull3d, IsTheHullOfPointsInEveryPosition) {
  const std::vector<std::pair<const char*, Points>> sets{
      {"tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {"octahedron", {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}},
      {"ball", random_in_ball(300, 1)},
      {"sphere", on_sphere(300, 2)},
      {"lattice", lattice(6)},
      {"drum", drum(24)},
      {"needle", stretched(drum(7), {1e-4, 1e-3, 1.0})}};
  for (const auto& [name, points] : sets) {
    SCOPED_TRACE(name);
    const double exact = volume(*hull_3d(points));
    for (const double scale : {1e-9, 1.0, 1e9}) {
      for (const double distance : {0.0, 1e3}) {
        const Points placed = moved(points, some_turn, scale, scale * distance * Vector3::Ones());
        const auto hull = hull_3d(placed);
        ASSERT_TRUE(hull.ok());
        expect_is_hull(*hull, placed);
        // Coordinates are known to half an eps of their size, at most 1002 (at the origin 2): the
        // volume changes by surface (at most 13) times that, per coordinate 3; and by what lies
        // outside by 4 cells.
        const double tolerance =
            (13.0 * 3.0 * 0.5 * 2.2e-16 * (distance + 2.0)) + 13.0 * outside_tolerance;
        EXPECT_NEAR(volume(*hull) / (scale * scale * scale), exact, tolerance);
      }
    }
  }
}

TEST(Hull3d, DoesNotDependOnTheOrderOfThePoints) {
  std::mt19937 random(7);
  for (Points points : {random_in_ball(60, 3), drum(12), lattice(4)}) {
    points.insert(points.end(), points.begin(), points.begin() + 20);  // repeated points
    const Hull first = *hull_3d(points);
    for (int trial = 0; trial < 20; ++trial) {
      std::ranges::shuffle(points, random);
      const Hull again = *hull_3d(points);
      EXPECT_EQ(again.vertices, first.vertices);
      EXPECT_EQ(again.triangles, first.triangles);
    }
  }
}

TEST(Hull3d, SmallIntegerPointsGiveExactTies) {
  // Many coplanar quadruples and repeated points; 500 sets.
  std::mt19937 random(11);
  std::uniform_int_distribution<int> coordinate(0, 3);
  int solid = 0;
  for (int trial = 0; trial < 500; ++trial) {
    Points points;
    for (int i = 0; i < 14; ++i) {
      points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    }
    const auto hull = hull_3d(points);
    if (!hull) continue;
    ++solid;
    expect_is_hull(*hull, points);
  }
  EXPECT_GE(solid, 490);
}

TEST(Hull3d, KeepsAllPointsOfASphere) {
  const Points points = on_sphere(4096, 5);
  const auto hull = hull_3d(points);
  ASSERT_TRUE(hull.ok());
  EXPECT_EQ(hull->vertices.size(), 4096U);
  EXPECT_EQ(hull->triangles.size(), 2U * 4096U - 4U);
}

TEST(Hull3d, RefusesPointsWithoutAVolume) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Points square;
  for (int i = 0; i < 100; ++i) {
    square.emplace_back(0.1 * (i % 10), 0.1 * (i / 10), 0.0);
  }
  Points line;
  for (int i = 0; i < 50; ++i) {
    line.emplace_back(0.1 * i, 0.3 * i, -0.7 * i);
  }
  for (const Points& points :
       {Points{}, Points(7, Vector3(1, 2, 3)), Points{{0, 0, 0}, {1, 1, 0}}, line, square,
        moved(square, some_turn, 1.0, Vector3::Zero()), moved(square, some_turn, 1e-5, {1, 1, 1}),
        Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, nan}}}) {
    EXPECT_FALSE(hull_3d(points).ok());
  }
  EXPECT_NE(hull_3d(square).errors()[0].message.find("enclose no volume"), std::string::npos);
}

TEST(Hull3d, AcceptsAThinPlate) {
  const Points plate = stretched(lattice(3), {1.0, 1.0, 1e-7});
  const auto hull = hull_3d(moved(plate, some_turn, 1.0, Vector3::Zero()));
  ASSERT_TRUE(hull.ok());
  // The faces are known to some 1e-12 of the width, so the thickness to 1e-5 of itself.
  EXPECT_NEAR(volume(*hull), 1e-7, 1e-5 * 1e-7);
}

}  // namespace
}  // namespace sheave
