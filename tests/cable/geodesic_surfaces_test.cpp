// Cones, tori and ellipsoids: geodesics and the shortest way over them, against unrolling, invariants,
// GeographicLib, and a published path over four bodies.

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/geodesic_chain.h"
#include "engine/vector.h"

namespace sheave {
namespace {

SmoothSurface egg_surface(const Vector3& half_axes, const Vector3& center = Vector3::Zero(),
                          const Quaternion& turn = Quaternion::Identity()) {
  SmoothSurface made;
  made.form = SurfaceForm::ellipsoid;
  made.center = center;
  made.axis = turn * Vector3::UnitZ();
  made.side = turn * Vector3::UnitX();
  made.half_axes = half_axes;
  made.radius = std::cbrt(half_axes.prod());
  return made;
}

SmoothSurface torus_surface(double ring, double tube, const Vector3& center = Vector3::Zero(),
                            const Vector3& axis = Vector3::UnitZ()) {
  SmoothSurface made;
  made.form = SurfaceForm::torus;
  made.center = center;
  made.axis = axis.normalized();
  made.ring = ring;
  made.radius = tube;
  return made;
}

SmoothSurface cone_surface(double radius, double slope, double half_length,
                           const Vector3& center = Vector3::Zero(),
                           const Vector3& axis = Vector3::UnitZ()) {
  SmoothSurface made;
  made.form = SurfaceForm::cone;
  made.center = center;
  made.axis = axis.normalized();
  made.radius = radius;
  made.slope = slope;
  made.half_length = half_length;
  return made;
}

SmoothSurface ball_surface(double radius, const Vector3& center) {
  SmoothSurface made;
  made.center = center;
  made.radius = radius;
  return made;
}

SmoothSurface bar_surface(double radius, const Vector3& center) {
  SmoothSurface made = ball_surface(radius, center);
  made.form = SurfaceForm::cylinder;
  made.half_length = 3.0;
  return made;
}

/// A stop of length 0 where the line between two points passes the body, which has it on the side
/// `outward`.
GeodesicStop passed_body(const SmoothSurface& on, const Vector3& from, const Vector3& to,
                         const Vector3& outward) {
  GeodesicStop stop;
  stop.surface = on;
  const Vector3 direction = (to - from).normalized();
  stop.entry =
      touched_frame(on, core_passage(on, from, direction).core, outward.normalized(), direction);
  return stop;
}

SpanEnd fixed_end(const Vector3& where) {
  return [where](const Vector3&) { return where; };
}

double least_length(std::vector<GeodesicStop>& stops, const Vector3& from, const Vector3& to) {
  EXPECT_TRUE(find_shortest_way(stops, fixed_end(from), fixed_end(to)));
  double length = 0.0;
  Vector3 last = from;
  for (const GeodesicStop& stop : stops) {
    length += (stop.entry.point - last).norm() + stop.length;
    last = stop.way.end.point;
  }
  return length + (to - last).norm();
}

struct CurvedCase {
  const char* name;
  SmoothSurface surface;
};

std::vector<CurvedCase> curved_cases() {
  const Vector3 axis(0.2, 0.1, 1.0);
  return {
      {"cone", cone_surface(0.2, 0.35, 0.5, {0.1, 0.1, 0.3}, axis)},
      {"narrowing cone", cone_surface(0.2, -0.35, 0.5, {0.1, 0.1, 0.3}, axis)},
      {"torus", torus_surface(0.6, 0.15, {0.1, 0.7, 0.3}, {1.0, 0.2, 0.1})},
      {"ellipsoid", egg_surface({0.3, 0.2, 0.5}, {0.1, 0.1, 0.3}, rotation_by({0.3, 0.2, 0.5}))},
      {"flat ellipsoid",
       egg_surface({0.4, 0.08, 0.3}, {0.1, 0.1, 0.3}, rotation_by({0.1, 0.4, 0.2}))}};
}

// The published path over a torus, an ellipsoid, a ball and a bar (the test of simbody's CableSpan,
// after Scholz et al. 2016): all in one plane, straight pieces of 1, 3.5, 3, 6 and 1.5 and quarter
// circles of the radii 1, 1, 1.5 and 2. Thirty operations round, of the size of the length.
TEST(GeodesicSurfaces, OverFourBodiesItIsThePublishedPath) {
  const Vector3 from = Vector3::Zero();
  const Vector3 to(-4.0, 0.0, 0.0);
  const std::array<SmoothSurface, 4> bodies{
      torus_surface(10.0, 1.0, {1.0, 11.0, 0.0}, Vector3::UnitX()),
      egg_surface({1.0, 1.0, 0.75}, {4.5, 1.0, 0.0}), ball_surface(1.5, {4.0, -2.0, 0.0}),
      bar_surface(2.0, {-2.0, -1.5, 0.0})};
  for (const double tilt : {0.0, 0.05, 0.2}) {
    std::vector<GeodesicStop> stops{
        passed_body(bodies[0], from, {4.5, 1.0, tilt}, {0.0, 1.0, 0.0}),
        passed_body(bodies[1], {1.0, 1.0, 0.0}, {4.0, -2.0, tilt}, {1.0, 1.0, 0.0}),
        passed_body(bodies[2], {4.5, 1.0, tilt}, {-2.0, -1.5, 0.0}, {0.5, -1.0, tilt}),
        passed_body(bodies[3], {4.0, -2.0, 0.0}, to, {-0.5, -1.0, 0.0})};
    EXPECT_NEAR(least_length(stops, from, to), 15.0 + 5.5 * pi / 2.0, 2e-13);
  }
}

// A point at the polar distance d from the tip and the unrolled angle a. Over the side the way is the
// straight line in the unrolled plane, the free spans included: two points whose planes touch the cone
// along the entry's and the exit's generator unroll with them.
TEST(GeodesicSurfaces, OnAConeItIsTheUnrolledLine) {
  const SmoothSurface body = cone_surface(0.4, 0.5, 0.6);
  const ConeTip tip = tip_of(body);
  const auto on_cone = [&](double far, double angle) -> Vector3 {
    const double level = far * tip.sine;
    return tip.point + Vector3(level * std::cos(angle), level * std::sin(angle), far * tip.cosine);
  };
  for (const double angle : {0.3, 1.5, 3.0, 4.5}) {
    for (const double end : {0.6, 1.0, 1.7}) {
      // Both ends in the planes unrolled: the entry at 0 and the exit at `angle`.
      const double unrolled = angle * tip.sine;
      const double length = std::sqrt(1.0 + end * end - 2.0 * end * std::cos(unrolled));
      // Angle of the line to the generator at the entry.
      const double rise = (end * std::cos(unrolled) - 1.0) / length;
      const double turn = end * std::sin(unrolled) / length;
      SurfaceFrame entry = body.frame(on_cone(1.0, 0.0), Vector3::UnitY());
      const Vector3 out = (entry.point - tip.point).normalized();
      entry.tangent = rise * out + turn * Vector3::UnitY();
      const SurfaceWay way = straightest_way(body, entry, length);
      EXPECT_LT((way.end.point - on_cone(end, angle)).norm(), 2e-15);
      // Straight spans along the tangents at both ends are the same line.
      std::vector<GeodesicStop> stops{passed_body(body, entry.point - 0.3 * entry.tangent,
                                                  way.end.point + 0.2 * way.end.tangent,
                                                  entry.outward + way.end.outward)};
      stops[0].entry = body.frame(entry.point + Vector3(0.01, 0.02, 0.03), entry.tangent);
      stops[0].length = 0.9 * length;
      EXPECT_NEAR(least_length(stops, entry.point - 0.3 * entry.tangent,
                               way.end.point + 0.2 * way.end.tangent),
                  length + 0.5, 4e-15 * 10.0);
    }
  }
}

// A geodesic on a body of revolution keeps radius x cosine of its angle to the parallels (Clairaut).
// On the torus there are two circles besides, whose lengths are known.
TEST(GeodesicSurfaces, OnATorusClairautsMomentIsKept) {
  const SmoothSurface body = torus_surface(1.0, 0.4);
  for (const double angle : {0.0, 0.7, 2.0, 3.0}) {
    for (const double slope : {0.0, 0.3, 1.0, 1.5}) {
      const Vector3 start(1.0 + 0.4 * std::cos(angle), 0.0, 0.4 * std::sin(angle));
      const Vector3 meridian(-std::sin(angle), 0.0, std::cos(angle));
      const SurfaceFrame entry =
          body.frame(start, std::cos(slope) * Vector3::UnitY() + std::sin(slope) * meridian);
      const double moment = cross(entry.point, entry.tangent).z();
      for (const double length : {0.01, 1.0, 5.0, -3.0}) {
        const SurfaceFrame end = straightest_way(body, entry, length).end;
        // Rounding of some hundred evaluations per radian, which neighbours amplify up to tenfold.
        EXPECT_NEAR(cross(end.point, end.tangent).z(), moment, 1e-13) << angle << ' ' << slope;
      }
    }
  }
  // Once round the tube, and once round the outer equator.
  const SurfaceFrame outer = body.frame({1.4, 0.0, 0.0}, Vector3::UnitY());
  EXPECT_LT((straightest_way(body, outer, 2.0 * pi * 1.4).end.point - outer.point).norm(), 1e-13);
  EXPECT_NEAR(straightest_way(body, outer, 1.4).turned, 1.0, 1e-13);
  const SurfaceFrame round = body.frame({1.4, 0.0, 0.0}, Vector3::UnitZ());
  EXPECT_LT((straightest_way(body, round, 2.0 * pi * 0.4).end.point - round.point).norm(), 1e-13);
}

struct SpheroidProblem {
  double flattening;
  double latitude;  ///< at the start, of the normal [degrees]
  double azimuth;   ///< at the start, clockwise from north [degrees]
  double length;
  double end_latitude;
  double end_longitude;
  double end_azimuth;
  double reduced_length;
};

/// Printed by dev/spheroid-geodesics from GeographicLib.
constexpr std::array<SpheroidProblem, 7> spheroid_problems{{
    {0.5, 20.0, 60.0, 0.7, 50.752790954540409, 41.637923153480934, 87.365451671919615,
     0.6022355531},
    {0.5, -35.0, 100.0, 2.5, 25.589193339565927, 145.739829902033392, 107.105851812991034,
     -0.7160178995},
    {0.1, 5.0, 30.0, 3.0, -8.158543942387393, 172.699627251967428, 149.828549839933174,
     0.1790650405},
    {0.8, 40.0, 150.0, 1.5, -78.339322675192008, 110.923613811736672, 43.367056903059805,
     1.2954305094},
    {-0.5, 10.0, 45.0, 2.0, 33.168863133559512, 130.468217053100801, 106.797215020487755,
     1.1533586112},
    {-1.0, -50.0, 70.0, 4.0, 27.403749245904539, 145.672256253905175, 31.580604492862928,
     1.0599751466},
    {-3.0, 25.0, 20.0, 1.0, 41.320028614089537, 166.801939754052881, 143.784183686115739,
     0.3616689733},
}};

SurfaceFrame at_place(const SmoothSurface& body, double latitude, double longitude,
                      double azimuth) {
  const double degree = pi / 180.0;
  const double cosine = std::cos(latitude * degree);
  const Vector3 normal(cosine * std::cos(longitude * degree), cosine * std::sin(longitude * degree),
                       std::sin(latitude * degree));
  const Vector3 east(-std::sin(longitude * degree), std::cos(longitude * degree), 0.0);
  const Vector3 place = body.half_axes.cwiseProduct(body.half_axes).cwiseProduct(normal);
  return {place / std::sqrt(place.dot(normal)),
          std::sin(azimuth * degree) * east + std::cos(azimuth * degree) * normal.cross(east),
          normal};
}

// The table has 10 decimals of a length and 15 of a degree.
TEST(GeodesicSurfaces, OnSpheroidsTheyAreThoseOfGeographicLib) {
  for (const SpheroidProblem& p : spheroid_problems) {
    SCOPED_TRACE(p.flattening);
    const SmoothSurface body = egg_surface({1.0, 1.0, 1.0 - p.flattening});
    const SurfaceFrame start = at_place(body, p.latitude, 0.0, p.azimuth);
    const SurfaceFrame end = at_place(body, p.end_latitude, p.end_longitude, p.end_azimuth);
    const SurfaceWay way = straightest_way(body, start, p.length);
    EXPECT_LT((way.end.point - end.point).norm(), 1e-13);
    EXPECT_LT((way.end.tangent - end.tangent).norm(), 1e-12);
    EXPECT_NEAR(way.turned_off, p.reduced_length, 6e-11);
  }
}

// On any ellipsoid a geodesic keeps |D x|^2 (t.D t) with D = diag(1 / a^2) (Joachimsthal).
TEST(GeodesicSurfaces, OnAnEllipsoidJoachimsthalsNumberIsKept) {
  for (const Vector3& half_axes :
       {Vector3(1.0, 0.7, 0.5), Vector3(2.0, 1.0, 0.3), Vector3(1.0, 1.0, 5.0)}) {
    const SmoothSurface body = egg_surface(half_axes);
    const Vector3 d = half_axes.cwiseProduct(half_axes).cwiseInverse();
    const auto number = [&](const SurfaceFrame& at) {
      return d.cwiseProduct(at.point).squaredNorm() * at.tangent.dot(d.cwiseProduct(at.tangent));
    };
    const SurfaceFrame entry = body.frame({0.4, 0.3, 0.2}, {0.5, -1.0, 0.3});
    for (const double length : {0.1, 2.0, 9.0, -4.0}) {
      const SurfaceWay way = straightest_way(body, entry, length);
      // 1e-14 per unit of length, times the number's sensitivity at the sharp ends.
      EXPECT_NEAR(number(way.end) / number(entry), 1.0, 1e-12) << half_axes << ' ' << length;
      EXPECT_LT((straightest_way(body, way.end, -length).end.point - entry.point).norm(), 1e-12);
    }
  }
}

TEST(GeodesicSurfaces, NeighboursAgreeWithFiniteDifferences) {
  for (const CurvedCase& c : curved_cases()) {
    SCOPED_TRACE(c.name);
    const SmoothSurface& body = c.surface;
    const SurfaceFrame start =
        body.frame(body.center + Vector3(0.1, -0.9, 0.2), Vector3(1.0, 0.1, 0.3));
    const double e = 1e-6;  // central: 1e-12 of the third derivative, 1e-15 / 1e-6 of rounding
    for (const double length : {0.02, 0.3, 0.7, -0.4}) {
      const SurfaceWay way = straightest_way(body, start, length);
      const auto off = [&](double aside, double angle) -> Vector3 {
        const SurfaceFrame moved = body.frame(start.point + aside * start.across(),
                                              start.tangent + std::tan(angle) * start.across());
        return straightest_way(body, moved, length).end.point;
      };
      const Vector3 across = way.end.across();
      EXPECT_NEAR((off(0.0, e) - off(0.0, -e)).dot(across) / (2.0 * e), way.turned_off, 2e-8);
      EXPECT_NEAR((off(e, 0.0) - off(-e, 0.0)).dot(across) / (2.0 * e), way.shifted, 2e-8);
      // Curvatures up to 50 leave 1e-10 / 6 of their cube.
      const auto after = straightest_way(body, start, length + 1e-5);
      const auto before = straightest_way(body, start, length - 1e-5);
      EXPECT_NEAR((after.turned_off - before.turned_off) / 2e-5, way.turned_off_rate, 1e-5);
      EXPECT_NEAR((after.shifted - before.shifted) / 2e-5, way.shifted_rate, 1e-5);
      const Vector3 bend = (after.end.outward - before.end.outward) / 2e-5;
      EXPECT_LT((bend - body.bend(way.end, way.end.tangent)).norm(), 1e-5);
      EXPECT_NEAR((after.turned - before.turned) / 2e-5, bend.dot(way.end.tangent), 1e-5);
    }
  }
}

// The derivatives of the least length by the places of its ends are the directions of the spans; those
// by the place and the turn of the body are the force and the torque of both spans on it.
TEST(GeodesicSurfaces, TheGradientOfTheLengthIsTheDirectionOfTheSpans) {
  const Vector3 near_end(-1.0, 0.1, 0.1);
  const Vector3 far_end(1.2, 0.05, 0.5);
  for (const CurvedCase& c : curved_cases()) {
    SCOPED_TRACE(c.name);
    const bool ring = c.surface.form == SurfaceForm::torus;
    const Vector3 side = ring ? Vector3::UnitY() : Vector3(-Vector3::UnitY());
    const Vector3 low = ring ? Vector3(0.0, 0.05, 0.0) : Vector3::Zero();
    const auto length = [&](const Vector3& a, const SmoothSurface& on, const Vector3& b) {
      std::vector<GeodesicStop> stops{passed_body(on, a, b, side)};
      return least_length(stops, a, b);
    };
    const Vector3 start = near_end + low;
    const Vector3 end = far_end + low;
    std::vector<GeodesicStop> stops{passed_body(c.surface, start, end, side)};
    least_length(stops, start, end);
    EXPECT_GT(stops[0].length, 0.01);
    const Vector3 in = (stops[0].entry.point - start).normalized();
    const Vector3 out = (end - stops[0].way.end.point).normalized();
    const Vector3 torque = (stops[0].entry.point - c.surface.center).cross(in) -
                           (stops[0].way.end.point - c.surface.center).cross(out);
    // Central differences of 1e-5: 1e-10 of the third derivative, 1e-15 / 1e-5 of rounding.
    const double e = 1e-5;
    for (int i = 0; i < 3; ++i) {
      const Vector3 d = e * Vector3::Unit(i);
      const auto slope = [&](double more, double less) { return (more - less) / (2.0 * e); };
      EXPECT_NEAR(slope(length(start + d, c.surface, end), length(start - d, c.surface, end)),
                  -in[i], 1e-8);
      EXPECT_NEAR(slope(length(start, c.surface, end + d), length(start, c.surface, end - d)),
                  out[i], 1e-8);
      SmoothSurface there = c.surface;
      SmoothSurface here = c.surface;
      there.center += d;
      here.center -= d;
      EXPECT_NEAR(slope(length(start, there, end), length(start, here, end)), in[i] - out[i], 1e-8);
      there.center = here.center = c.surface.center;
      for (SmoothSurface* turned : {&there, &here}) {
        const Quaternion turn = rotation_by(turned == &there ? d : Vector3(-d));
        turned->axis = turn * c.surface.axis;
        turned->side = turn * c.surface.side;
      }
      EXPECT_NEAR(slope(length(start, there, end), length(start, here, end)), torque[i], 1e-8);
    }
    if (c.surface.form != SurfaceForm::ellipsoid) {
      EXPECT_NEAR(torque.dot(c.surface.axis), 0.0, 1e-13);
    }
  }
}

// Numbers of other programs: the least of all ways over an unrolled cone by mpmath with 40 digits, and
// shooting with SciPy's DOP853 over an ellipsoid.
TEST(GeodesicSurfaces, OverAConeAndAnEllipsoidTheyAreThoseOfOtherPrograms) {
  const Vector3 from(-0.9, -0.1, -0.1);
  const Vector3 to(0.9, -0.25, 0.15);
  const Vector3 up = Vector3::UnitY();
  std::vector<GeodesicStop> on_cone{passed_body(cone_surface(0.2, -0.2, 0.5), from, to, up)};
  EXPECT_NEAR(least_length(on_cone, from, to), 1.965922470204407256, 4e-15);
  std::vector<GeodesicStop> on_egg{passed_body(egg_surface({0.3, 0.2, 0.4}), from, to, up)};
  EXPECT_NEAR(least_length(on_egg, from, to), 1.9810179177766036, 1e-13);
}

// An ellipsoid of equal half axes is a ball, and a wide, narrow cone a bar.
TEST(GeodesicSurfaces, LimitsAreTheSimplerBodies) {
  const Vector3 from(-1.0, 0.5, 0.1);
  const Vector3 to(1.2, 0.4, 0.8);
  const Vector3 down(0.0, -1.0, 0.0);
  const Vector3 center(0.1, 0.05, 0.4);
  std::vector<GeodesicStop> egg{passed_body(
      egg_surface(Vector3::Constant(0.2), center, rotation_by({0.3, 0.2, 0.1})), from, to, down)};
  std::vector<GeodesicStop> round{passed_body(ball_surface(0.2, center), from, to, down)};
  EXPECT_NEAR(least_length(egg, from, to), least_length(round, from, to), 1e-14);
  std::vector<GeodesicStop> straight{passed_body(bar_surface(0.2, center), from, to, down)};
  const double over_bar = least_length(straight, from, to);
  for (const double slope : {1e-2, 1e-3, 1e-4}) {
    std::vector<GeodesicStop> narrow{
        passed_body(cone_surface(0.2, slope, 1.0, center), from, to, down)};
    // The tip is 0.2 / slope away; rounding counts from there.
    EXPECT_NEAR(least_length(narrow, from, to), over_bar, 2.0 * slope + 1e-15 / slope);
  }
}

}  // namespace
}  // namespace sheave
