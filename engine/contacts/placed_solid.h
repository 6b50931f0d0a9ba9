#pragma once
// A convex solid at its present pose, with the queries that contacts need.

#include <cmath>
#include <vector>

#include "engine/index.h"
#include "engine/shapes/solid.h"

namespace sheave {

/// World frame, lengths in m.
struct PlacedSolid {
  const ConvexSolid* solid = nullptr;
  Matrix3 rotation = Matrix3::Identity();
  std::vector<Vector3> vertices;  ///< corners of the core

  void place(const ConvexSolid& form, const Vector3& position, const Quaternion& orientation) {
    solid = &form;
    rotation = orientation.toRotationMatrix();
    vertices.resize(form.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      vertices[i] = position + times(rotation, form.vertices[i]);
    }
  }
  [[nodiscard]] bool is(ConvexSolid::Kind kind) const { return solid->kind == kind; }
  /// Whether the solid is a ball or a capsule.
  [[nodiscard]] bool is_round() const {
    return is(ConvexSolid::Kind::rounded) && solid->faces.empty();
  }
  [[nodiscard]] const Vector3& first() const { return vertices.front(); }
  [[nodiscard]] const Vector3& last() const { return vertices.back(); }
  /// Axis of a cylinder.
  [[nodiscard]] Vector3 axis() const { return rotation.col(2); }
  [[nodiscard]] Vector3 face_normal(std::size_t face) const {
    return times(rotation, solid->faces[face].normal);
  }
  [[nodiscard]] const Vector3& face_point(std::size_t face) const {
    return vertices[at(solid->faces[face].corners.front())];
  }
  [[nodiscard]] Vector3 edge_vector(const ConvexSolid::Edge& edge) const {
    return vertices[at(edge.to)] - vertices[at(edge.from)];
  }
  /// Index of the core's corner that is farthest along `direction`.
  [[nodiscard]] std::size_t extreme(const Vector3& direction) const {
    std::size_t best = 0;
    double farthest = dot(direction, vertices.front());
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const double way = dot(direction, vertices[i]);
      if (!(way > farthest)) continue;
      farthest = way;
      best = i;
    }
    return best;
  }
  /// The extent beyond the core along a unit vector: the radius, or for a cylinder that of its rim.
  [[nodiscard]] double round_reach(const Vector3& direction) const {
    if (!is(ConvexSolid::Kind::cylinder)) return solid->radius;
    const double along = dot(direction, axis());
    return solid->radius * std::sqrt(std::max(0.0, 1.0 - along * along));
  }
  /// The largest direction . x of the points x of the solid, which must be bounded.
  [[nodiscard]] double reach(const Vector3& direction) const {
    return dot(direction, vertices[extreme(direction)]) + round_reach(direction);
  }
};

/// The distance between the supporting planes of `a` and `b` along the unit vector `normal`;
/// negative if their projections overlap. The largest value over all directions is the distance of
/// convex solids, or minus the depth of their overlap.
[[nodiscard]] inline double gap_along(const PlacedSolid& a, const PlacedSolid& b,
                                      const Vector3& normal) {
  return -a.reach(-normal) - b.reach(normal);
}

}  // namespace sheave
