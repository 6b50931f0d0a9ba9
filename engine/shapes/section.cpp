#include "engine/shapes/section.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/portable.h"
#include "engine/shapes/frustum_section.h"

namespace sheave {
namespace {

/// Any unit vector perpendicular to the unit vector `normal`.
Vector3 across(const Vector3& normal) {
  int smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  return normal.cross(Vector3::Unit(smallest)).normalized();
}

}  // namespace

void append_hull_section(std::span<const Vector3> corners, const SectionPlane& plane,
                         std::vector<Vector3>& points) {
  std::vector<double> heights;
  double extent = 0.0;
  for (const Vector3& corner : corners) {
    heights.push_back(plane.normal.dot(corner - plane.point));
    extent = std::max(extent, (corner - corners[0]).norm());
  }
  // Rounding of the heights must not decide whether a face in the plane belongs to the section.
  const double thickness = 1e-12 * extent;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (std::abs(heights[i]) <= thickness) points.push_back(corners[i]);
    if (heights[i] <= thickness) continue;
    for (std::size_t j = 0; j < corners.size(); ++j) {
      if (heights[j] >= -thickness) continue;
      const double share = heights[i] / (heights[i] - heights[j]);
      points.emplace_back(corners[i] + share * (corners[j] - corners[i]));
    }
  }
}

void append_ball_section(const Vector3& center, double radius, const SectionPlane& plane,
                         std::vector<Vector3>& points) {
  const double height = plane.normal.dot(plane.point - center);
  const double square = radius * radius - height * height;
  if (!(square > 0.0)) return;
  const Vector3 middle = center + height * plane.normal;
  const Vector3 x = std::sqrt(square) * across(plane.normal);
  const Vector3 y = plane.normal.cross(x);
  for (int i = 0; i < curved_section_corners; ++i) {
    const double angle = 2.0 * pi * i / curved_section_corners;
    points.emplace_back(middle + portable::cos(angle) * x + portable::sin(angle) * y);
  }
}

void append_cylinder_section(double radius, double length, const SectionPlane& plane,
                             std::vector<Vector3>& points) {
  append_frustum_section(radius, radius, length, plane, points);
}

void append_frustum_section(double radius, double top_radius, double length,
                            const SectionPlane& plane, std::vector<Vector3>& points) {
  // The section of each line along the mantle, then those of the two end discs. The cost is linear;
  // the hull of all rim points would be quadratic.
  const Vector3 half(0.0, 0.0, 0.5 * length);
  const Vector3& n = plane.normal;
  for (int i = 0; i < curved_section_corners; ++i) {
    const double angle = 2.0 * pi * i / curved_section_corners;
    const Vector3 out(portable::cos(angle), portable::sin(angle), 0.0);
    const std::array<Vector3, 2> line{radius * out - half, top_radius * out + half};
    append_hull_section(line, plane, points);
  }
  const double slope = portable::hypot(n.x(), n.y());
  if (!(slope > 1e-12)) return;
  const Vector3 steepest(n.x() / slope, n.y() / slope, 0.0);
  const Vector3 level(-steepest.y(), steepest.x(), 0.0);
  for (const double end : {-0.5, 0.5}) {
    const double rim = end < 0.0 ? radius : top_radius;
    const Vector3 disc(0.0, 0.0, end * length);
    const double away = n.dot(plane.point - disc) / slope;
    const double square = rim * rim - away * away;
    if (!(square >= 0.0)) continue;
    for (const double side : {-1.0, 1.0}) {
      points.emplace_back(disc + away * steepest + side * std::sqrt(square) * level);
    }
  }
}

}  // namespace sheave
