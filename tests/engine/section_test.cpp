#include "engine/shapes/section.h"

#include <gtest/gtest.h>

#include "engine/math/turn_between.h"
#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/convex_hull.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"
#include "engine/shapes/torus.h"

namespace sheave {
namespace {

struct Measured {
  double area = 0.0;
  double farthest_from_plane = 0.0;
  std::size_t points = 0;
};

/// Area of the hull of a section, seen along the plane's normal.
Measured measure(const Shape& shape, const SectionPlane& plane) {
  std::vector<Vector3> points;
  shape.append_section(plane, points);
  Measured result;
  result.points = points.size();
  if (points.size() < 3) return result;
  const Quaternion to_plane = turn_between(plane.normal, Vector3::UnitZ());
  for (Vector3& point : points) {
    point = to_plane * (point - plane.point);
    result.farthest_from_plane = std::max(result.farthest_from_plane, std::abs(point.z()));
  }
  const Result<std::vector<Vector3>> hull = hull_2d(points);
  if (!hull) return result;
  for (std::size_t i = 2; i < hull->size(); ++i) {
    result.area += 0.5 * ((*hull)[i - 1] - (*hull)[0]).cross((*hull)[i] - (*hull)[0]).z();
  }
  return result;
}

/// A polygon with n corners on a circle has the area of the circle times sin(a) / a, a = 2 pi / n.
double polygon_share() {
  const double a = 2.0 * pi / curved_section_corners;
  return std::sin(a) / a;
}

TEST(Section, ConesToriAndEllipsoidsHaveTheirCircles) {
  Cone cone;
  cone.radius = 0.4;
  cone.top_radius = 0.1;
  cone.length = 1.0;
  EXPECT_NEAR(measure(cone, {Vector3::Zero(), Vector3::UnitZ()}).area,
              polygon_share() * pi * 0.25 * 0.25, 1e-14);
  EXPECT_NEAR(measure(cone, {Vector3::Zero(), Vector3::UnitX()}).area, 0.5, 1e-14);
  Torus torus;
  torus.radius = 0.5;
  torus.tube_radius = 0.2;
  EXPECT_NEAR(measure(torus, {Vector3::Zero(), Vector3::UnitZ()}).area, polygon_share() * pi * 0.49,
              1e-14);
  EXPECT_EQ(measure(torus, {{0.0, 0.0, 0.21}, Vector3::UnitZ()}).points, 0U);
  Ellipsoid egg;
  egg.half_axes = {0.3, 0.4, 0.7};
  EXPECT_NEAR(measure(egg, {Vector3::Zero(), Vector3::UnitY()}).area, polygon_share() * pi * 0.21,
              1e-14);
  // At half the height the section is smaller by the factor 3/4.
  EXPECT_NEAR(measure(egg, {{0.0, 0.2, 0.0}, Vector3::UnitY()}).area,
              polygon_share() * pi * 0.21 * 0.75, 1e-14);
}

TEST(Section, BoxAcrossAnAxisIsARectangle) {
  Box box;
  box.size = {1.0, 2.0, 3.0};
  const Measured cut = measure(box, {{0.2, 5.0, 7.0}, Vector3::UnitX()});
  EXPECT_NEAR(cut.area, 6.0, 1e-12);
  EXPECT_LT(cut.farthest_from_plane, 1e-14);
}

TEST(Section, CubeAcrossItsSpaceDiagonalIsAHexagon) {
  Box box;
  box.size = {1.0, 1.0, 1.0};
  const Measured cut = measure(box, {Vector3::Zero(), Vector3(1, 1, 1).normalized()});
  EXPECT_NEAR(cut.area, 0.75 * std::sqrt(3.0), 1e-12);  // side 1 / sqrt 2
}

TEST(Section, FaceInThePlaneCounts) {
  Box box;
  box.size = {1.0, 2.0, 3.0};
  EXPECT_NEAR(measure(box, {{0.5, 0.0, 0.0}, Vector3::UnitX()}).area, 6.0, 1e-12);
}

TEST(Section, NothingWhereThePlaneMisses) {
  Box box;
  box.size = {1.0, 2.0, 3.0};
  EXPECT_EQ(measure(box, {{0.51, 0.0, 0.0}, Vector3::UnitX()}).points, 0U);
  Sphere sphere;
  sphere.radius = 0.5;
  EXPECT_EQ(measure(sphere, {{0.51, 0.0, 0.0}, Vector3::UnitX()}).points, 0U);
}

TEST(Section, BallOffCentreIsTheSmallerCircle) {
  Sphere sphere;
  sphere.radius = 0.5;
  const Measured cut = measure(sphere, {{0.0, 0.3, 0.0}, Vector3::UnitY()});
  EXPECT_NEAR(cut.area, pi * 0.16 * polygon_share(), 1e-12);
}

TEST(Section, TiltedCylinderIsAnEllipse) {
  Cylinder cylinder;
  cylinder.radius = 0.5;
  cylinder.length = 10.0;
  const double tilt = 1.0;
  const Measured cut = measure(cylinder, {Vector3::Zero(), {std::sin(tilt), 0.0, std::cos(tilt)}});
  EXPECT_NEAR(cut.area, pi * 0.25 / std::cos(tilt) * polygon_share(), 1e-12);
}

TEST(Section, CylinderAlongItsAxisIsARectangleBetweenItsEnds) {
  Cylinder cylinder;
  cylinder.radius = 0.5;
  cylinder.length = 2.0;
  // At a distance of 0.3 from the axis the chord is 0.8.
  EXPECT_NEAR(measure(cylinder, {{0.3, 0.0, 0.0}, Vector3::UnitX()}).area, 1.6, 1e-12);
}

TEST(Section, CapsuleAlongItsAxisIsAStadium) {
  Capsule capsule;
  capsule.radius = 0.5;
  capsule.length = 2.0;
  EXPECT_NEAR(measure(capsule, {Vector3::Zero(), Vector3::UnitX()}).area,
              2.0 + pi * 0.25 * polygon_share(), 1e-12);
}

TEST(Section, PrismAndPolyhedronOfTheSameSolidAgree) {
  Prism prism;
  prism.outline = {{0, 0, 0}, {2, 0, 0}, {1, 1.5, 0}, {0.2, 1.0, 0}};
  prism.length = 1.0;
  Polyhedron polyhedron;
  for (const Vector3& point : prism.outline) {
    for (const double end : {-0.5, 0.5}) polyhedron.points.emplace_back(point.x(), point.y(), end);
  }
  const SectionPlane plane{{0.6, 0.4, 0.1}, Vector3(0.3, -0.2, 0.9).normalized()};
  const double area = measure(prism, plane).area;
  EXPECT_GT(area, 0.5);
  EXPECT_NEAR(measure(polyhedron, plane).area, area, 1e-12);
}

}  // namespace
}  // namespace sheave
