#include "engine/shape.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <string>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/polyhedron.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"
#include "engine/shapes/torus.h"
#include "tests/support/rounding.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): builders of shapes

using test::eps;

// Mass properties are sums of up to a few dozen products of about five factors each, all below
// mass * size^2, and every operation rounds once: 100 eps of that bound, where not said otherwise.
constexpr double summed = 100.0 * eps;

void expect_same(const MassProperties& a, const MassProperties& b, double size, double relative) {
  EXPECT_NEAR(a.mass, b.mass, relative * b.mass);
  EXPECT_LE((a.center_of_mass - b.center_of_mass).norm(), relative * size);
  EXPECT_LE((a.inertia - b.inertia).norm(), relative * b.mass * size * size);
}

TEST(MassProperties, OfABoxAsPrismAndAsPolyhedron) {
  const Vector3 size(0.3, 1.1, 2.7);
  for (const double distance : {0.0, 1.0, 1e3}) {
    const Vector3 center = distance * Vector3(0.6, -0.48, 0.64);
    MassProperties expected = box(size)->unit_density();
    expected.center_of_mass = center;
    // A corner is rounded by half an eps of the distance; the shortest edge, 0.3, makes that a
    // relative error of 3.3 eps distance in the volume and up to three times that in the inertia.
    const double relative = summed + 20.0 * eps * distance;
    expect_same(polyhedron(box_corners(size, center))->unit_density(), expected, size.norm(),
                relative);
    const Vector3 in_plane(center.x(), center.y(), 0.0);
    std::vector<Vector3> outline = box_corners({size.x(), size.y(), 0.0}, in_plane);
    expected.center_of_mass = in_plane;
    expect_same(polygon(outline, size.z())->unit_density(), expected, size.norm(), relative);
  }
}

TEST(MassProperties, OfACornerTetrahedron) {
  // The tetrahedron 0, a x, b y, c z by direct integration: V = abc/6, mean x = a/4, integral of
  // x^2 = V a^2/10, of x y = V ab/20.
  const Vector3 legs(0.7, 1.9, 3.1);
  const double volume = legs.prod() / 6.0;
  const Vector3 center = legs / 4.0;
  Matrix3 second = volume / 20.0 * legs * legs.transpose();
  second.diagonal() *= 2.0;
  const Matrix3 spread = second - volume * center * center.transpose();
  const MassProperties expected{volume, center, spread.trace() * Matrix3::Identity() - spread};
  const auto shape = polyhedron(
      {Vector3::Zero(), {legs.x(), 0, 0}, {0, legs.y(), 0}, {0, 0, legs.z()}, 0.1 * legs});
  expect_same(shape->unit_density(), expected, legs.norm(), summed);
}

TEST(MassProperties, OfAPolyhedronEqualsThatOfThePrismWithTheSameCorners) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<Vector3> outline = random_points(9, seed);
    std::vector<Vector3> corners;
    for (Vector3& point : outline) {
      point.z() = 0.0;
      corners.push_back(point + Vector3(0.0, 0.0, 0.8));
      corners.push_back(point - Vector3(0.0, 0.0, 0.8));
    }
    const MassProperties prism = polygon(outline, 1.6)->unit_density();
    expect_same(polyhedron(corners)->unit_density(), prism, 3.0, summed);
    EXPECT_GE(prism.center_of_mass.norm(), 1e-3) << "not the case this test is for";
  }
}

TEST(MassProperties, OfRegularPrismsApproachTheCylinderInSecondOrder) {
  // With t = 2 pi / n the area is sin(t)/t and the spin sin(t)(2 + cos t)/(3t) of the circle's:
  // relative errors t^2/6 (1 - t^2/20 ...) and t^2/3 (1 - 0.15 t^2 ...). Halving t gives the order
  // 2 with an error below 0.15 (3/4) t^2 / ln 2 < t^2. The tilt mixes both.
  const double length = 0.4;
  const MassProperties round =
      make<Cylinder>([&](Cylinder& c) { c.radius = 1.3, c.length = length; })->unit_density();
  const auto errors = [&](int n) {
    const MassProperties p = polygon(ring(n, 1.3, 0.0), length)->unit_density();
    return Vector3(1.0 - p.mass / round.mass, 1.0 - p.inertia(2, 2) / round.inertia(2, 2),
                   1.0 - p.inertia(0, 0) / round.inertia(0, 0));
  };
  for (int n = 8; n <= 256; n *= 2) {
    const Vector3 coarse = errors(n);
    const Vector3 fine = errors(2 * n);
    const double t = 2.0 * pi / n;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::log2(coarse[k] / fine[k]), 2.0, t * t) << n;
    }
  }
  EXPECT_NEAR(errors(256).x(), 4.0 * pi * pi / (6.0 * 256 * 256), 1e-7);
}

/// A body of revolution about z from discs of the given squared radius, integrated over the pieces
/// between `cuts`. Three Gauss points are exact to degree 5, and the integrands have degree 4.
MassProperties revolved(const std::vector<double>& cuts,
                        const std::function<double(double)>& radius_squared) {
  MassProperties result;
  const double node = std::sqrt(0.6);
  for (std::size_t piece = 1; piece < cuts.size(); ++piece) {
    const double half = 0.5 * (cuts[piece] - cuts[piece - 1]);
    const double middle = 0.5 * (cuts[piece] + cuts[piece - 1]);
    for (const int i : {-1, 0, 1}) {
      const double z = middle + i * node * half;
      const double disc = (i == 0 ? 8.0 : 5.0) / 9.0 * half * pi * radius_squared(z);
      const double tilt = disc * (0.25 * radius_squared(z) + z * z);
      result.mass += disc;
      result.inertia.diagonal() += Vector3(tilt, tilt, 0.5 * disc * radius_squared(z));
    }
  }
  return result;
}

TEST(MassProperties, OfRoundShapesEqualTheIntegralOverDiscs) {
  const double r = 0.35;
  const double half = 0.8;
  const auto in_ball = [&](double z) { return r * r - z * z; };
  const auto capsule = make<Capsule>([&](Capsule& c) { c.radius = r, c.length = 2.0 * half; });
  const auto cylinder = make<Cylinder>([&](Cylinder& c) { c.radius = r, c.length = 2.0 * half; });
  const auto sphere = make<Sphere>([&](Sphere& s) { s.radius = r; });
  expect_same(sphere->unit_density(), revolved({-r, r}, in_ball), r, summed);
  expect_same(cylinder->unit_density(), revolved({-half, half}, [&](double) { return r * r; }),
              half, summed);
  expect_same(capsule->unit_density(),
              revolved({-half - r, -half, half, half + r},
                       [&](double z) { return in_ball(std::max(0.0, std::abs(z) - half)); }),
              half + r, summed);
}

TEST(MassProperties, OfConesAndEllipsoidsEqualTheIntegralOverDiscs) {
  const double half = 0.8;
  for (const double top : {0.0, 0.1, 0.5}) {
    const auto cone =
        make<Cone>([&](Cone& c) { c.radius = 0.35, c.top_radius = top, c.length = 2.0 * half; });
    const auto radius = [&](double z) { return 0.35 + (top - 0.35) * (z + half) / (2.0 * half); };
    const auto square = [&](double z) { return radius(z) * radius(z); };
    MassProperties expected = revolved({-half, half}, square);
    // First moment by Simpson's rule, exact for the cubic z r^2.
    const double first = pi * half / 3.0 * half * (square(half) - square(-half));
    expected.center_of_mass.z() = first / expected.mass;
    expected.inertia -= point_inertia(expected.mass, expected.center_of_mass);
    expect_same(cone->unit_density(), expected, half, summed);
  }
  const auto egg = [](const Vector3& half_axes) {
    return make<Ellipsoid>([&](Ellipsoid& e) { e.half_axes = half_axes; })->unit_density();
  };
  expect_same(egg({0.3, 0.3, 0.7}),
              revolved({-0.7, 0.7}, [](double z) { return 0.09 * (1.0 - z * z / 0.49); }), 0.7,
              summed);
  const MassProperties once = egg({0.3, 0.4, 0.7});
  const MassProperties again = egg({0.7, 0.3, 0.4});
  EXPECT_NEAR(once.inertia(0, 0), again.inertia(1, 1), 1e-16);
  EXPECT_NEAR(once.inertia(1, 1), again.inertia(2, 2), 1e-16);
  // Half the trace is the integral of r^2, the sum of a^2 / 5 times the volume.
  EXPECT_NEAR(0.5 * once.inertia.trace(), once.mass * (0.09 + 0.16 + 0.49) / 5.0, 1e-16);
}

// The section of the tube in polar coordinates: 16 angles and three Gauss points are exact, because
// the integrands have degree 4 in the distance from the middle of the tube.
TEST(MassProperties, OfATorusEqualsTheIntegralOverItsTube) {
  const double ring = 0.5;
  const double tube = 0.2;
  MassProperties expected;
  for (int k = 0; k < 16; ++k) {
    for (const int i : {-1, 0, 1}) {
      const double s = 0.5 * tube * (1.0 + i * std::sqrt(0.6));
      const double area = (i == 0 ? 8.0 : 5.0) / 18.0 * tube * s * 2.0 * pi / 16.0;
      const double out = ring + s * std::cos(2.0 * pi * k / 16.0);
      const double z = s * std::sin(2.0 * pi * k / 16.0);
      const double mass = 2.0 * pi * out * area;
      const double tilt = mass * (0.5 * out * out + z * z);
      expected.mass += mass;
      expected.inertia.diagonal() += Vector3(tilt, tilt, mass * out * out);
    }
  }
  const auto torus = make<Torus>([&](Torus& t) { t.radius = ring, t.tube_radius = tube; });
  expect_same(torus->unit_density(), expected, ring + tube, summed);
}

TEST(Combine, TwoHalfBoxesAreTheWholeBox) {
  const Vector3 size(0.9, 1.4, 2.2);
  MassProperties whole = box(size)->unit_density();
  whole.mass *= 7.5;
  whole.inertia *= 7.5;
  // Halves along x; the second one written with its own axes turned by 90 degrees about z.
  const PlacedShape left{box({0.45, 1.4, 2.2}), {-0.225, 0, 0}, Quaternion::Identity()};
  const PlacedShape right{box({1.4, 0.45, 2.2}), {0.225, 0, 0}, rotation_by({0, 0, 0.5 * pi})};
  const std::array halves{left, right};
  expect_same(combine(halves, 7.5), whole, size.norm(), summed);
}

TEST(Combine, TurnsAndMovesTheMassWithTheShape) {
  const auto shape = polyhedron(random_points(30, 4));
  const MassProperties own = shape->unit_density();
  const Quaternion turn = rotation_by({0.4, -1.3, 2.2});
  const Vector3 shift(5.0, -3.0, 2.0);
  const std::array placed{PlacedShape{shape, shift, turn}};
  const MassProperties moved = combine(placed, 3.0);
  EXPECT_NEAR(moved.mass, 3.0 * own.mass, summed * own.mass);
  EXPECT_LE((moved.center_of_mass - shift - turn * own.center_of_mass).norm(), summed);
  EXPECT_NEAR(moved.inertia.trace(), 3.0 * own.inertia.trace(), summed * own.mass);
  const Vector3 before = own.inertia.selfadjointView<Eigen::Lower>().eigenvalues();
  const Vector3 after = moved.inertia.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_LE((after - 3.0 * before).norm(), 10.0 * summed * own.mass);
  // The kinetic energy of a turn about any axis, an invariant that sees the directions too.
  const Vector3 axis = Vector3(1.0, 2.0, -0.5).normalized();
  const Vector3 turned_axis = turn * axis;
  EXPECT_NEAR(turned_axis.dot(moved.inertia * turned_axis), 3.0 * axis.dot(own.inertia * axis),
              summed * own.mass);
}

TEST(Combine, OfNothingIsNothing) {
  const MassProperties none = combine({}, 1000.0);
  EXPECT_EQ(none.mass, 0.0);
  EXPECT_EQ(none.center_of_mass, Vector3::Zero());
}

TEST(PointInertia, IsMassTimesDistanceFromTheAxisSquared) {
  const Matrix3 inertia = point_inertia(2.0, {3.0, 4.0, 12.0});
  EXPECT_EQ(inertia.diagonal(), Vector3(320.0, 306.0, 50.0));
  EXPECT_EQ(inertia(0, 1), -24.0);
  EXPECT_EQ(inertia(1, 2), -96.0);
  EXPECT_EQ(inertia, inertia.transpose());
}

}  // namespace
}  // namespace sheave
