#pragma once
// The points at which two solids touch or are about to touch.

#include <vector>

#include "engine/contacts/placed_solid.h"

namespace sheave {

/// A pair of points of the two cores, one above the other along the manifold's normal. The points
/// that touch are on the surfaces: core_a - radius_a n and core_b + radius_b n. Rows use the core
/// points, so a ball rolls on its surface; a fixed point of the surface would act as a corner.
struct ContactPoint {
  Vector3 core_a = Vector3::Zero();  ///< [m], world frame
  Vector3 core_b = Vector3::Zero();
  double radius_a = 0.0;  ///< [m]
  double radius_b = 0.0;
  double gap = 0.0;  ///< n . (core_a - core_b) - radius_a - radius_b [m]; < 0: overlap
  double due = 0.0;  ///< gap at the end of the substep if both solids keep their velocities [m]
};

/// A rigid displacement of a solid.
struct SolidMotion {
  Vector3 center = Vector3::Zero();    ///< centre of the rotation [m], world frame
  Vector3 way = Vector3::Zero();       ///< displacement of the centre [m]
  Matrix3 turn = Matrix3::Identity();  ///< rotation, world frame
  [[nodiscard]] Vector3 moved(const Vector3& point) const {
    return center + way + times(turn, point - center);
  }
};

struct Manifold {
  static constexpr std::size_t most_points = 8;
  Vector3 normal = Vector3::UnitY();  ///< unit length, from B to A
  std::vector<ContactPoint> points;   ///< at most most_points
};

/// Finds the points of A and B whose gap is at most `margin` [m]. A half-space must be B. Flat
/// sides touch at four corners that span their overlap. Round sides touch at a point, or at the
/// ends of a line. Nearly round forms, such as a prism with many sides, also touch at the corner
/// that will be nearest at the end of the substep, and at those beside it.
void find_contacts(const PlacedSolid& a, const PlacedSolid& b, double margin, Manifold& manifold,
                   const SolidMotion& motion_a = {}, const SolidMotion& motion_b = {});

/// Keeps at most most_points of the points. Four of them span about the same area as all: the
/// deepest, the one farthest from it, and the farthest to both sides of the line between these two.
/// If the solids are tilted relative to each other, the points on which they will come to rest are
/// kept, too: the one with the least ContactPoint::due, and the next ones when the solid tips about
/// it.
void reduce_points(Manifold& manifold);

}  // namespace sheave
