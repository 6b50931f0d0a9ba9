// The way of a tendon over a sphere or a cylinder is the shortest one: a second computation searches
// for it among all ways that are straight, then on the surface, then straight.

#include "scenes/import/mjcf/wrap.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace sheave {
namespace {

using import::mjcf::Geom;
using import::mjcf::GeomType;
using import::mjcf::Wrap;

constexpr double radius = 0.3;

Geom geom_of(GeomType type) {
  Geom geom;
  geom.type = type;
  geom.size = {radius, 5.0, 0.0};
  return geom;
}

/// The least value of a function of two numbers that has one valley, by shrinking steps from a
/// start.
template <class Function>
double least(Function value, double x, double y) {
  double best = value(x, y);
  for (double step = 0.5; step > 1e-9;) {
    bool better = false;
    for (const auto& [dx, dy] :
         {std::pair(step, 0.0), std::pair(-step, 0.0), std::pair(0.0, step), std::pair(0.0, -step),
          std::pair(step, step), std::pair(-step, -step), std::pair(step, -step),
          std::pair(-step, step)}) {
      const double there = value(x + dx, y + dy);
      if (!(there < best)) continue;
      best = there;
      x += dx;
      y += dy;
      better = true;
    }
    if (!better) step *= 0.5;
  }
  return best;
}

/// Points at which straight lines from `eye` touch the sphere: a circle, by an angle.
Vector3 touching(const Vector3& eye, double angle) {
  const Vector3 ahead = eye.normalized();
  const double height = radius * radius / eye.norm();
  const double wide = std::sqrt(radius * radius - height * height);
  const Vector3 x = ahead.unitOrthogonal();
  return height * ahead + wide * (std::cos(angle) * x + std::sin(angle) * ahead.cross(x));
}

double shortest_over_sphere(const Vector3& from, const Vector3& to) {
  const auto length = [&](double a, double b) {
    const Vector3 entry = touching(from, a);
    const Vector3 exit = touching(to, b);
    const double turn = std::atan2(entry.cross(exit).norm(), entry.dot(exit));
    return (entry - from).norm() + radius * turn + (to - exit).norm();
  };
  double best = 1e9;
  constexpr int starts = 8;
  for (int i = 0; i < starts * starts; ++i) {
    const double unit = 2.0 * pi / starts;
    best = std::min(best, least(length, unit * (i % starts), unit * (i / starts)));
  }
  return best;
}

/// Both senses round the axis; the heights of entry and exit are free.
double shortest_over_cylinder(const Vector3& from, const Vector3& to) {
  const auto flat = [](const Vector3& point) { return std::hypot(point.x(), point.y()); };
  const double first = std::sqrt(flat(from) * flat(from) - radius * radius);
  const double last = std::sqrt(flat(to) * flat(to) - radius * radius);
  const double between =
      std::remainder(std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x()), 2.0 * pi);
  double best = 1e9;
  for (const double turn : {std::abs(between), 2.0 * pi - std::abs(between)}) {
    const double arc = turn - std::acos(radius / flat(from)) - std::acos(radius / flat(to));
    if (arc < 0.0) continue;
    const auto length = [&](double a, double b) {
      return std::hypot(first, a - from.z()) + std::hypot(radius * arc, b - a) +
             std::hypot(last, to.z() - b);
    };
    best = std::min(best, least(length, from.z(), to.z()));
  }
  return best;
}

/// Whether the straight line passes through the body, by points of the line.
bool passes_through(GeomType type, const Vector3& from, const Vector3& to) {
  constexpr int points = 20'000;
  for (int i = 0; i <= points; ++i) {
    Vector3 at = from + (to - from) * (static_cast<double>(i) / points);
    if (type == GeomType::cylinder) at.z() = 0.0;
    if (at.norm() < radius) return true;
  }
  return false;
}

TEST(TendonWrap, IsTheShortestWayRoundTheBody) {
  std::mt19937 random(5);
  const auto number = [&] { return 2.0 * (static_cast<double>(random()) / 4294967295.0) - 1.0; };
  for (const GeomType type : {GeomType::sphere, GeomType::cylinder}) {
    int touched = 0;
    for (int i = 0; i < 200; ++i) {
      const Vector3 from(number(), number(), number());
      const Vector3 to(number(), number(), number());
      const bool flat = type == GeomType::cylinder;
      const auto distance = [&](const Vector3& p) { return flat ? p.head<2>().norm() : p.norm(); };
      if (distance(from) < 1.05 * radius || distance(to) < 1.05 * radius) continue;
      const Wrap wrap = wrap_over(geom_of(type), from, to, {});
      const double length = wrap.before + wrap.on + wrap.after;
      if (!passes_through(type, from, to)) {
        EXPECT_FALSE(wrap.touches);
        EXPECT_NEAR(length, (to - from).norm(), 1e-15);
        continue;
      }
      ++touched;
      EXPECT_TRUE(wrap.touches);
      const double shortest =
          flat ? shortest_over_cylinder(from, to) : shortest_over_sphere(from, to);
      // Near its least value a length grows with the square of the step of 1e-9; the search on the
      // sphere, whose valleys may be narrow, ends within 1e-9.
      EXPECT_NEAR(length, shortest, 2e-9) << from.transpose() << " to " << to.transpose();
    }
    EXPECT_GT(touched, 10);
  }
}

// The way on the side of the side site, also where it is the longer one.
TEST(TendonWrap, LiesOnTheSideOfItsSideSite) {
  const Geom bar = geom_of(GeomType::cylinder);
  const Vector3 from(-1.0, 0.1, 0.0);
  const Vector3 to(1.0, 0.1, 0.0);
  const Wrap above = wrap_over(bar, from, to, Vector3(0.0, 1.0, 0.0));
  const Wrap below = wrap_over(bar, from, to, Vector3(0.0, -1.0, 0.0));
  EXPECT_FALSE(above.counter_clockwise);
  EXPECT_TRUE(below.counter_clockwise);
  EXPECT_GT(below.on, above.on);
  // A line that passes above the bar does not touch it there, and is drawn round it below.
  const Vector3 over(0.0, 0.3, 0.0);
  EXPECT_FALSE(wrap_over(bar, from + over, to + over, Vector3(0.0, 1.0, 0.0)).touches);
  EXPECT_TRUE(wrap_over(bar, from + over, to + over, Vector3(0.0, -1.0, 0.0)).touches);
  // A site within the body: MuJoCo ignores the body then.
  EXPECT_TRUE(wrap_over(bar, Vector3(0.1, 0.0, 0.0), to, {}).inside);
}

// Two bars side by side, under which the way runs: two tangents, two arcs and a level piece.
TEST(TendonWrap, RunsOverGeomsOneBehindTheOther) {
  const Geom bar = geom_of(GeomType::cylinder);
  const Vector3 from(-3.0, 0.0, 0.0);
  const Vector3 to(3.0, 0.0, 0.0);
  const Vector3 left(-1.0, 0.1, 0.0);
  const Vector3 right(1.0, 0.1, 0.0);
  const std::vector<import::mjcf::Obstacle> bars{{&bar, {left, Quaternion::Identity()}, {}},
                                                 {&bar, {right, Quaternion::Identity()}, {}}};
  const std::vector<Wrap> wraps = wrap_over_all(bars, from, to);
  ASSERT_EQ(wraps.size(), 2U);
  const double distance = (left - from).norm();
  const double tangent = std::sqrt(distance * distance - radius * radius);
  // From the tangent point, which lies acos(r / d) off the way to the point, to the lowest point.
  const double arc = std::acos(-1.0) / 2.0 - std::atan2(0.1, 2.0) - std::acos(radius / distance);
  EXPECT_TRUE(wraps[0].counter_clockwise);
  EXPECT_NEAR(wraps[0].before, tangent, 1e-13);
  EXPECT_NEAR(wraps[0].on, radius * arc, 1e-13);
  EXPECT_NEAR(wraps[0].after, 2.0, 1e-13);
  EXPECT_NEAR(wraps[1].before, 2.0, 1e-13);
  EXPECT_NEAR(wraps[1].on, radius * arc, 1e-13);
  EXPECT_NEAR(wraps[1].after, tangent, 1e-13);
  EXPECT_NEAR((wraps[0].leaves - Vector3(0.0, -radius, 0.0)).norm(), 0.0, 1e-13);
}

// A line meets an ellipsoid where the scaled line meets the unit sphere.
TEST(TendonWrap, TouchesAnEllipsoidThatTheLineCrosses) {
  Geom egg;
  egg.type = GeomType::ellipsoid;
  egg.size = {0.5, 0.2, 0.3};
  const auto over = [&](double height, const std::optional<Vector3>& side) {
    return wrap_over(egg, Vector3(-2.0, height, 0.0), Vector3(2.0, height, 0.0), side);
  };
  EXPECT_TRUE(over(0.199, {}).touches);
  EXPECT_FALSE(over(0.201, {}).touches);
  EXPECT_TRUE(over(0.201, Vector3(0.0, -1.0, 0.0)).touches);
  const Wrap wrap = over(0.1, {});
  for (const Vector3& point : {wrap.arrives, wrap.leaves}) {
    EXPECT_NEAR(point.cwiseQuotient(egg.size).norm(), 1.0, 1e-14);
  }
  EXPECT_FALSE(wrap.counter_clockwise == (wrap.normal.z() > 0.0));  // it passes above
}

}  // namespace
}  // namespace sheave
