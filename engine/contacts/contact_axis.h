#pragma once
// The direction along which two solids touch, or would first separate.
//
// The distance of convex solids, or minus the depth of their overlap, is the largest gap_along() of
// all directions. For each pair of forms the candidates for the largest gap are known: the normals
// of faces, the cross products of edges, the lines between the nearest points of cores. All
// candidates are tried (the method of separating axes). The result is therefore exact where forms
// are flat or round, does not depend on the tolerance of an iteration, and is equally precise for
// solids that touch and for solids apart. Only between the rim of a cylinder and an edge or a rim,
// an iteration finds the direction. The gap along that direction is used, which never exceeds the
// true one.

#include "engine/contacts/placed_solid.h"

namespace sheave {

struct ContactAxis {
  enum class Kind {
    face_a,  ///< the normal is that of a face of A
    face_b,  ///< the normal is that of a face of B
    points,  ///< `core_a` and `core_b` are the points that touch
    other,   ///< a contact with a cylinder, whose features determine the points
  };
  Kind kind = Kind::other;
  Vector3 normal = Vector3::UnitY();  ///< unit length, from B to A
  double gap = 0.0;                   ///< along the normal [m]; < 0: depth of the overlap
  int face = -1;
  Vector3 core_a = Vector3::Zero();  ///< on the cores [m]
  Vector3 core_b = Vector3::Zero();
};

/// The axis of two bounded solids. If the gap exceeds `margin`, the result is any direction whose
/// gap does, too.
[[nodiscard]] ContactAxis contact_axis(const PlacedSolid& a, const PlacedSolid& b, double margin);

// The axis for each family of forms; contact_axis() chooses among these functions.
[[nodiscard]] ContactAxis axis_of_round(const PlacedSolid& a, const PlacedSolid& b);
/// `a` is a ball or a capsule, `b` has faces.
[[nodiscard]] ContactAxis axis_of_round_and_faces(const PlacedSolid& a, const PlacedSolid& b);
/// Both have faces.
[[nodiscard]] ContactAxis axis_of_faces(const PlacedSolid& a, const PlacedSolid& b, double margin);
/// `b` is a cylinder.
[[nodiscard]] ContactAxis axis_of_cylinder(const PlacedSolid& a, const PlacedSolid& b,
                                           double margin);

/// The nearest points of the segments p0 p1 and q0 q1, each of which may be a point; for parallel
/// segments the middle of the nearest parts.
struct NearestPoints {
  Vector3 p;
  Vector3 q;
};
[[nodiscard]] NearestPoints nearest_points(const Vector3& p0, const Vector3& p1, const Vector3& q0,
                                           const Vector3& q1);

}  // namespace sheave
