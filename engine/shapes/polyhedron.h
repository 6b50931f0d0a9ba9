#pragma once

#include "engine/shape.h"
#include "engine/shapes/convex_hull.h"

namespace sheave {

/// The convex hull of points. Its centre of mass need not be at the origin.
class Polyhedron final : public Shape {
 public:
  std::vector<Vector3> points;  ///< 4 to 4096 points [m], in any order

  static constexpr std::string_view type_name = "polyhedron";
  static constexpr std::string_view type_meaning = "convex hull of points";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  /// Mass 0 if the points are not valid.
  [[nodiscard]] MassProperties unit_density() const override;
  /// Appends all points; points inside the hull and repeated points do not change contacts.
  void append_contact_points(const Vector3& down, std::vector<Vector3>& contacts) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& section) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  [[nodiscard]] Vector3 half_extent() const override;

  /// The surface, computed anew in each call; empty if the points are not valid.
  [[nodiscard]] Hull hull() const;
};

}  // namespace sheave
