#pragma once

#include "engine/shape.h"

namespace sheave {

/// The convex hull of an outline in the plane z = 0, extruded along z to both sides of that plane.
/// Its centre of mass need not be at the origin.
class Prism final : public Shape {
 public:
  std::vector<Vector3> outline;  ///< 3 to 4096 points [x, y, 0] [m], in any order
  double length = 1.0;           ///< along z, from -length/2 to length/2 [m], > 0

  static constexpr std::string_view type_name = "prism";
  static constexpr std::string_view type_meaning =
      "convex hull of an outline in the plane z = 0, extruded along z to both sides";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  /// Mass 0 if the outline is not valid.
  [[nodiscard]] MassProperties unit_density() const override;
  /// Appends all outline points at both ends; points inside the hull do not change contacts.
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  [[nodiscard]] Vector3 half_extent() const override;

  /// Corners of the cross-section at z = 0, counter-clockwise about z, without those on a line
  /// between their neighbours. Computed anew in each call; empty if the outline is not valid.
  [[nodiscard]] std::vector<Vector3> hull() const;
};

}  // namespace sheave
