#include "render/coil.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sheave::render {
namespace {

const Vector3 start{1.0, 2.0, 3.0};
const Vector3 end{1.0, 4.0, 3.0};
constexpr CoilShape shape{.coils = 6, .radius = 0.2, .lead = 0.1};

double distance_from_axis(const Vector3& point) {
  return std::hypot(point.x() - start.x(), point.z() - start.z());
}

TEST(Coil, GoesFromEndToEndWithinItsRadius) {
  const auto points = coil_points(start, end, Vector3::UnitX(), shape);
  EXPECT_EQ(points.front(), start);
  EXPECT_EQ(points.back(), end);
  double widest = 0.0;
  double height = start.y() - 1e-12;
  for (const Vector3& point : points) {
    widest = std::max(widest, distance_from_axis(point));
    EXPECT_GE(point.y(), height) << "it never turns back";
    height = point.y() - 1e-12;
  }
  EXPECT_NEAR(widest, shape.radius, 1e-12);
}

TEST(Coil, HasItsNumberOfCoilsAtAnyLength) {
  for (const double length : {0.5, 2.0, 20.0}) {
    const auto points =
        coil_points(start, start + length * Vector3::UnitY(), Vector3::UnitX(), shape);
    // The angle about the axis, unwrapped, where the wire has left it.
    double turned = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vector3 a = points[i - 1] - start;
      const Vector3 b = points[i] - start;
      if (std::hypot(a.x(), a.z()) < 1e-9 || std::hypot(b.x(), b.z()) < 1e-9) continue;
      turned += std::atan2(a.z() * b.x() - a.x() * b.z(), a.x() * b.x() + a.z() * b.z());
    }
    // Of 20 pieces per coil the first and the last begin on the axis, where there is no angle.
    EXPECT_NEAR(std::abs(turned), 2.0 * pi * (shape.coils - 0.1), 1e-9) << length;
  }
}

TEST(Coil, StaysOnItsSideWhenTheLineTurns) {
  // The first point off the axis.
  const auto first = [&](const Vector3& side) {
    const auto points = coil_points(start, end, side, shape);
    return Vector3((points[11] - start).normalized());
  };
  EXPECT_GT(first(Vector3::UnitX()).dot(first({1.0, 5.0, 0.0})), 1.0 - 1e-12)
      << "what of the side is along the line does not count";
  EXPECT_LT(first(Vector3::UnitX()).dot(Vector3::UnitX()), 0.0) << "half a coil further";
}

}  // namespace
}  // namespace sheave::render
