#pragma once
// A convex solid for contacts: corners, edges and faces of a core, and a radius around the core.

#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// In the frame of a shape.
struct ConvexSolid {
  enum class Kind {
    rounded,  ///< all points within `radius` of the core; 0 for a box and a hull
    /// Within `radius` of the core's axis, a segment along z between the centres of the flat ends
    cylinder,
    /// All points beneath the plane through `vertices[0]` with the normal of `faces[0]`
    half_space,
  };
  /// A flat side of the core.
  struct Face {
    Vector3 normal = Vector3::Zero();  ///< outward, unit length
    std::vector<int> corners;          ///< counter-clockwise from outside
  };
  struct Edge {
    int from = 0;
    int to = 0;
    /// The face on the left of the edge, seen from outside; -1: the core is a segment
    int left = -1;
    int right = -1;
    bool repeats = false;  ///< whether the edge is parallel to an earlier one
  };

  Kind kind = Kind::rounded;
  double radius = 0.0;            ///< [m]
  std::vector<Vector3> vertices;  ///< [m]; a single one if the core is a point
  std::vector<Face> faces;
  std::vector<Edge> edges;
};

/// A ball, a capsule or a cylinder: the core is a segment on the z axis, centred at the origin, or
/// a point if `length` is 0.
[[nodiscard]] ConvexSolid solid_about_segment(ConvexSolid::Kind kind, double length, double radius);
/// A solid with flat sides only. `loops` are the corners of the faces, counter-clockwise from
/// outside.
[[nodiscard]] ConvexSolid solid_of_faces(std::span<const Vector3> vertices,
                                         std::vector<std::vector<int>> loops);
/// The prism over a convex outline [x, y, 0], counter-clockwise about z.
[[nodiscard]] ConvexSolid solid_of_outline(std::span<const Vector3> outline, double length);

struct Hull;
/// The solid of a hull; triangles in one plane become one face.
[[nodiscard]] ConvexSolid solid_of_hull(const Hull& hull);

}  // namespace sheave
