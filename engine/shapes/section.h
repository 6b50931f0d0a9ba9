#pragma once
// Sections of solids with a plane, as points whose convex hull is the hull of the section.

#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// Number of corners of the polygon for a curved section. The corners lie on the curve, so the
/// polygon is too small by at most 1 - cos(pi / 256) = 8e-5 of its radius.
inline constexpr int curved_section_corners = 256;

/// The plane through `point` [m] with the unit normal `normal`.
struct SectionPlane {
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();
};

/// Appends the section of the convex hull of `corners` [m]: the points at which the plane meets the
/// lines between corners on either side, and the corners in the plane. (Every edge of the hull is
/// such a line, and no such line leaves the hull.) Appends nothing if the plane misses the hull.
/// Cost: the square of the number of corners.
void append_hull_section(std::span<const Vector3> corners, const SectionPlane& plane,
                         std::vector<Vector3>& points);

/// Appends the section of a ball: a circle as a polygon.
void append_ball_section(const Vector3& center, double radius, const SectionPlane& plane,
                         std::vector<Vector3>& points);

/// Appends the section of a cylinder along z from -length / 2 to length / 2.
void append_cylinder_section(double radius, double length, const SectionPlane& plane,
                             std::vector<Vector3>& points);

}  // namespace sheave
