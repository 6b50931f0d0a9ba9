#pragma once
// Sections of solids with a plane, as points whose convex hull is the hull of the section.

#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// Corners of the polygons that stand for a curved section. They lie on the curve, so the polygon
/// is too small by 1 - cos(pi / 256) = 8e-5 of its radius at most.
inline constexpr int curved_section_corners = 256;

/// The plane through `point` [m] with the unit normal `normal`.
struct SectionPlane {
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();
};

/// Appends the section of the convex hull of `corners` [m]: where the plane meets the line between
/// any corner on one side and any on the other, and the corners in the plane. (Every edge of the
/// hull is such a line, and no such line leaves the hull.) Nothing if the plane misses it. Cost:
/// the square of the number of corners.
void append_hull_section(std::span<const Vector3> corners, const SectionPlane& plane,
                         std::vector<Vector3>& points);

/// Appends the section of a ball: a circle as a polygon.
void append_ball_section(const Vector3& center, double radius, const SectionPlane& plane,
                         std::vector<Vector3>& points);

/// Appends the section of a cylinder along z from -length / 2 to length / 2.
void append_cylinder_section(double radius, double length, const SectionPlane& plane,
                             std::vector<Vector3>& points);

}  // namespace sheave
