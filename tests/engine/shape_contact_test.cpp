// Where shapes can touch, how far they reach and whether their mass is physical, against points
// sampled densely on their surfaces.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <set>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "engine/shape.h"
#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"
#include "tests/support/effort.h"
#include "tests/support/rounding.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): builders of shapes

using test::eps;

/// A shape with points of its surface, among them one no deeper than `coarseness` above the deepest
/// in any direction: rings of 1000 points miss a circle by at most r (1 - cos(pi/1000)) < 5e-6 r.
struct Specimen {
  std::shared_ptr<const Shape> shape;
  std::vector<Vector3> surface;
  double coarseness = 1e-14;
};

std::vector<Specimen> specimens() {
  std::vector<Vector3> ball;
  std::vector<Vector3> capsule;
  for (int i = 0; i <= 500; ++i) {
    for (const Vector3& point : ring(1000, std::sin(pi * i / 500), std::cos(pi * i / 500))) {
      ball.push_back(0.6 * point);
      capsule.push_back(0.6 * point + Vector3(0.0, 0.0, point.z() < 0.0 ? -0.5 : 0.5));
    }
  }
  std::vector<Vector3> rims = ring(1000, 0.6, -0.5);
  std::ranges::copy(ring(1000, 0.6, 0.5), std::back_inserter(rims));
  const std::vector<Vector3> cloud = random_points(60, 9);
  std::vector<Vector3> outline = random_points(20, 3);
  std::vector<Vector3> ends;
  for (Vector3& point : outline) {
    point.z() = 0.0;
    for (const double z : {-0.7, 0.7}) {
      ends.emplace_back(point.x(), point.y(), z);
    }
  }
  const Vector3 size(0.4, 1.0, 1.6);
  return {{box(size), box_corners(size, Vector3::Zero())},
          {make<Sphere>([](Sphere& s) { s.radius = 0.6; }), ball, 1e-5},
          {make<Cylinder>([](Cylinder& c) { c.radius = 0.6, c.length = 1.0; }), rims, 1e-5},
          {make<Capsule>([](Capsule& c) { c.radius = 0.6, c.length = 1.0; }), capsule, 1e-5},
          {polygon(outline, 1.4), ends},
          {polyhedron(cloud), cloud}};
}

std::vector<Vector3> directions() {
  std::vector<Vector3> result = random_points(instrumented ? 6 : 60, 21);
  for (Vector3& direction : result) {
    direction.normalize();
  }
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      result.emplace_back(sign * Vector3::Unit(k));
    }
  }
  result.push_back(Vector3(1e-7, -1e-8, -1.0).normalized());
  result.push_back(Vector3(1e-10, 0.0, 1.0));
  return result;
}

TEST(ContactPoints, IncludeTheDeepestPointOfTheShape) {
  for (const Specimen& specimen : specimens()) {
    for (const Vector3& down : directions()) {
      std::vector<Vector3> points{Vector3(1.0, 2.0, 3.0)};
      specimen.shape->append_contact_points(down, points);
      EXPECT_EQ(points.front(), Vector3(1.0, 2.0, 3.0)) << "must append";
      double deepest = -1e9;
      for (std::size_t i = 1; i < points.size(); ++i) {
        deepest = std::max(deepest, down.dot(points[i]));
      }
      double sampled = -1e9;
      for (const Vector3& point : specimen.surface) {
        sampled = std::max(sampled, down.dot(point));
      }
      // Never above the sample; below it at most by what the sample misses. A cylinder ignores a
      // slope under 1e-9, which costs 1e-9 of its radius.
      EXPECT_GE(deepest, sampled - 1e-9) << specimen.shape->type() << ' ' << down.transpose();
      EXPECT_LE(deepest, sampled + specimen.coarseness) << specimen.shape->type();
    }
  }
}

TEST(ContactPoints, SupportAFlatFaceOnAllSides) {
  // A cylinder standing upright must not tip: its centre is inside the points it stands on.
  std::vector<Vector3> points;
  const auto shape = make<Cylinder>([](Cylinder& c) { c.radius = 0.6, c.length = 1.0; });
  shape->append_contact_points(-Vector3::UnitZ(), points);
  for (const Vector3& side : {Vector3(1, 1, 0), Vector3(-1, 1, 0), Vector3(-1, -1, 0)}) {
    EXPECT_TRUE(std::ranges::any_of(
        points, [&](const Vector3& point) { return point.z() == -0.5 && point.dot(side) > 0.3; }));
  }
}

TEST(HalfExtent, ContainsTheShapeTightly) {
  for (const Specimen& specimen : specimens()) {
    Vector3 reach = Vector3::Zero();
    for (const Vector3& point : specimen.surface) {
      reach = reach.cwiseMax(point.cwiseAbs());
    }
    const Vector3 excess = specimen.shape->half_extent() - reach;
    EXPECT_GE(excess.minCoeff(), -4.0 * eps) << specimen.shape->type();
    EXPECT_LE(excess.maxCoeff(), specimen.coarseness) << specimen.shape->type();
  }
}

TEST(ShapeMass, IsPhysicalForAllShapes) {
  for (const Specimen& specimen : specimens()) {
    const MassProperties mass = specimen.shape->unit_density();
    EXPECT_GT(mass.mass, 0.0);
    EXPECT_EQ(mass.inertia, mass.inertia.transpose()) << specimen.shape->type();
    // Principal moments of a solid: each is less than the sum of the other two.
    const Vector3 moments = mass.inertia.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(moments.minCoeff(), 0.0);
    EXPECT_LT(2.0 * moments.maxCoeff(), moments.sum()) << specimen.shape->type();
    EXPECT_TRUE(specimen.shape->validate("").empty());
  }
}

TEST(WheelRadius, IsDefinedForRoundShapesOnly) {
  for (const Specimen& specimen : specimens()) {
    const std::set<std::string_view> round{"sphere", "cylinder", "capsule"};
    const double radius = specimen.shape->wheel_radius();
    if (round.contains(specimen.shape->type())) {
      EXPECT_EQ(radius, 0.6);
    } else {
      EXPECT_TRUE(std::isnan(radius));
    }
  }
}

}  // namespace
}  // namespace sheave
