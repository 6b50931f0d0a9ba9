#pragma once
// Along which direction two solids touch, or would first come apart.
//
// The distance of convex solids, or minus the depth of their overlap, is the largest gap_along() of
// all directions. Which directions can be the largest is known for each pair of forms: the normals
// of faces, the cross products of edges, the lines between the nearest points of cores. They are
// tried one by one (the method of separating axes), so the result is exact where forms are flat or
// round, never depends on a tolerance of an iteration, and is as precise when solids touch as when
// they do not. Only between the rim of a cylinder and an edge or a rim is a direction found by
// iteration; it is then the gap along that direction that counts, which is never more than the true
// one.

#include "engine/contacts/placed_solid.h"

namespace sheave {

struct ContactAxis {
  enum class Kind {
    face_a,  ///< the normal is that of a face of A ...
    face_b,  ///< ... or of B
    points,  ///< `core_a` and `core_b` are the points that touch
    other,   ///< a cylinder: its features tell
  };
  Kind kind = Kind::other;
  Vector3 normal = Vector3::UnitY();  ///< unit length, from B to A
  double gap = 0.0;                   ///< along the normal [m]; < 0: depth of the overlap
  int face = -1;
  Vector3 core_a = Vector3::Zero();  ///< [m], on the cores
  Vector3 core_b = Vector3::Zero();
};

/// The axis of two bounded solids. Whose gap exceeds `margin` may be any that tells so.
[[nodiscard]] ContactAxis contact_axis(const PlacedSolid& a, const PlacedSolid& b, double margin);

// For each family of forms; contact_axis() chooses.
[[nodiscard]] ContactAxis axis_of_round(const PlacedSolid& a, const PlacedSolid& b);
/// `a` is a ball or a capsule, `b` has faces.
[[nodiscard]] ContactAxis axis_of_round_and_faces(const PlacedSolid& a, const PlacedSolid& b);
/// Both have faces.
[[nodiscard]] ContactAxis axis_of_faces(const PlacedSolid& a, const PlacedSolid& b, double margin);
/// `b` is a cylinder.
[[nodiscard]] ContactAxis axis_of_cylinder(const PlacedSolid& a, const PlacedSolid& b,
                                           double margin);

/// The nearest points of the segments p0 p1 and q0 q1, each of which may be a point; of parallel
/// ones the middle ones.
struct NearestPoints {
  Vector3 p;
  Vector3 q;
};
[[nodiscard]] NearestPoints nearest_points(const Vector3& p0, const Vector3& p1, const Vector3& q0,
                                           const Vector3& q1);

}  // namespace sheave
