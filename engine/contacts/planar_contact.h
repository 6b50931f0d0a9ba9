#pragma once
// Contact between bodies that can only move in one plane: fewer points and rows tell the same.
//
// Points that lie behind one another along the plane's normal k move alike, so one of them has the
// force of all, and a tangent along k is a direction in which nothing can move. A box that lies on
// a floor has two points then, not four, and one row of friction each: 4 rows instead of 12, none
// of them redundant.

#include <optional>

#include "engine/body_set.h"
#include "engine/contacts/manifold.h"

namespace sheave {

/// Unit normal of the plane in which alone these bodies, by index, can move relative to one
/// another; nothing if there is none.
[[nodiscard]] std::optional<Vector3> plane_of_motion(const BodySet& bodies, int a, int b);

/// Leaves one point, in their middle, of those that lie behind one another along `axis`. `size`
/// [m]: of the smaller form. Nothing to do for a manifold whose normal is not in the plane.
void merge_behind(const Vector3& axis, double size, Manifold& manifold);

/// Whether `normal` lies in the plane with the unit normal `axis`, so that contact can do anything.
[[nodiscard]] inline bool lies_in_plane(const Vector3& normal, const Vector3& axis) {
  return std::abs(dot(normal, axis)) < 1e-9;
}

}  // namespace sheave
