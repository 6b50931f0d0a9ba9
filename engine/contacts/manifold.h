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
  double due = 0.0;  ///< the gap at the end of the substep, if both solids go on as they move [m]
};

/// How a solid goes on.
struct SolidMotion {
  Vector3 center = Vector3::Zero();    ///< about which it turns [m], world frame
  Vector3 way = Vector3::Zero();       ///< of that point [m]
  Matrix3 turn = Matrix3::Identity();  ///< world frame
  [[nodiscard]] Vector3 moved(const Vector3& point) const {
    return center + way + times(turn, point - center);
  }
};

struct Manifold {
  static constexpr std::size_t most_points = 8;
  Vector3 normal = Vector3::UnitY();  ///< unit length, from B to A
  std::vector<ContactPoint> points;   ///< at most most_points
};

/// The points of A and B whose gap is at most `margin` [m]. A half-space must be B. Of flat sides
/// that lie on one another the corners of their overlap, four that span it; of round ones the ends
/// of the line, or the point, in which they touch; of what is nearly round, such as a prism of many
/// sides, the corner that will be nearest at the end of the substep, and those beside it.
void find_contacts(const PlacedSolid& a, const PlacedSolid& b, double margin, Manifold& manifold,
                   const SolidMotion& motion_a = {}, const SolidMotion& motion_b = {});

/// Keeps at most most_points of the points: four that span about the same area, the deepest, the one
/// farthest from it, and the farthest to both sides of the line between them; and, where the solids
/// do not lie flat on each other, those on which they will come to lie: the one with the least
/// ContactPoint::due, and those that are next if they tip about it.
void reduce_points(Manifold& manifold);

}  // namespace sheave
