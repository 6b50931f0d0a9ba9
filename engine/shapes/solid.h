#pragma once
// A convex solid as contacts see it: corners, edges and faces of a core, and what is put round the
// core.

#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// In the frame of a shape.
struct ConvexSolid {
  enum class Kind {
    rounded,   ///< all points within `radius` of the core; of a box and a hull the radius is 0
    cylinder,  ///< about the core, a segment along z between the centres of the flat ends
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
    int left = -1;  ///< the face that runs along it from `from` to `to`; -1: the core is a segment
    int right = -1;
    bool repeats = false;  ///< it is parallel to an edge before it
  };

  Kind kind = Kind::rounded;
  double radius = 0.0;            ///< [m]
  std::vector<Vector3> vertices;  ///< [m]; a single one: the core is a point
  std::vector<Face> faces;
  std::vector<Edge> edges;
};

/// A ball, a capsule or a cylinder: the core is the segment between two points on the z axis, or a
/// point if it is 0 long.
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
