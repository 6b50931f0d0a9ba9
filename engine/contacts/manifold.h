#pragma once
// The points in which two solids touch or are about to.

#include <vector>

#include "engine/contacts/placed_solid.h"

namespace sheave {

/// A pair of points of the two cores, one above the other along the manifold's normal. The points
/// that touch lie on the surfaces: core_a - radius_a n and core_b + radius_b n. Bodies turn about
/// contacts by way of the cores, so that a ball rolls on its surface and not on the corner that a
/// fixed point of it would be.
struct ContactPoint {
  Vector3 core_a = Vector3::Zero();  ///< [m], world frame
  Vector3 core_b = Vector3::Zero();
  double radius_a = 0.0;  ///< [m]
  double radius_b = 0.0;
  double gap = 0.0;  ///< n . (core_a - core_b) - radius_a - radius_b [m]; < 0: overlap
};

struct Manifold {
  static constexpr std::size_t most_points = 4;
  Vector3 normal = Vector3::UnitY();  ///< unit length, from B to A
  std::vector<ContactPoint> points;   ///< at most most_points
};

/// The points of A and B whose gap is at most `margin` [m]. A half-space must be B. Of flat sides
/// that lie on one another the corners of their overlap, four that span it; of round ones the ends
/// of the line, or the point, in which they touch.
void find_contacts(const PlacedSolid& a, const PlacedSolid& b, double margin, Manifold& manifold);

/// Keeps most_points of the points, which span about the same area: the deepest, the one farthest
/// from it, and the farthest to both sides of the line between them.
void reduce_points(Manifold& manifold);

}  // namespace sheave
