#pragma once
// Contacts between bodies that move in one plane, where fewer points and rows are sufficient.
//
// Points that lie behind one another along the plane's normal k have the same motion, so one of
// them can carry the force of all. A tangent along k is a direction without motion. A box on a
// floor then has two points instead of four, with one friction row each: 4 rows instead of 12, none
// of them redundant.

#include <optional>

#include "engine/body_set.h"
#include "engine/contacts/manifold.h"

namespace sheave {

/// Unit normal of the plane to which the relative motion of these bodies, given by index, is
/// restricted; nothing if there is none.
[[nodiscard]] std::optional<Vector3> plane_of_motion(const BodySet& bodies, int a, int b);

/// Replaces points that lie behind one another along `axis` by one in their middle. `size` [m] is
/// the size of the smaller form. A manifold whose normal is not in the plane does not change.
void merge_behind(const Vector3& axis, double size, Manifold& manifold);

/// Whether `normal` lies in the plane with the unit normal `axis`; otherwise the contact cannot
/// affect the motion.
[[nodiscard]] inline bool lies_in_plane(const Vector3& normal, const Vector3& axis) {
  return std::abs(dot(normal, axis)) < 1e-9;
}

}  // namespace sheave
