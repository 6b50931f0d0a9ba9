#pragma once
// Convex hulls of point sets, in the plane and in space.
//
// Both functions round the points to a grid of 2^40 cells across their extent and then decide with
// exact integers. Neither the order of points nor repeated or coplanar points can therefore lead to
// a wrong topology, and the same points give the same hull on every machine. The results hold the
// given coordinates, not the rounded ones. No given point lies outside a hull by more than a few
// cells (1e-12 of the extent each). Points that stand out by less are left out.

#include <array>
#include <span>
#include <vector>

#include "engine/result.h"
#include "engine/vector.h"

namespace sheave {

/// Surface of a convex solid.
struct Hull {
  std::vector<Vector3> vertices;              ///< [m], in lexicographic order up to rounding
  std::vector<std::array<int, 3>> triangles;  ///< vertex indices, counter-clockwise from outside

  /// Outward normal of a triangle; its length is the area [m2].
  [[nodiscard]] Vector3 area_vector(const std::array<int, 3>& triangle) const;
};

/// Corners of the convex hull of the points' projections on the plane z = 0, in
/// counter-clockwise order. An error if the points are not finite or lie on one line.
[[nodiscard]] Result<std::vector<Vector3>> hull_2d(std::span<const Vector3> points);

/// Convex hull in space. An error if the points are not finite or in one plane, which means that
/// the solid is thinner than about 1e-9 of its extent.
[[nodiscard]] Result<Hull> hull_3d(std::span<const Vector3> points);

}  // namespace sheave
