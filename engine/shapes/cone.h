#pragma once

#include "engine/shape.h"

namespace sheave {

/// A cone or a frustum about z, its origin half way between the flat ends.
class Cone final : public Shape {
 public:
  double radius = 0.5;      ///< of the end at -z [m], > 0
  double top_radius = 0.0;  ///< of the end at +z [m], >= 0; not that of the other end
  double length = 1.0;      ///< along z [m], > 0
  /// Smallest difference of the radii per length; below it the tip is too far away to count from.
  static constexpr double least_slope = 1e-3;

  static constexpr std::string_view type_name = "cone";
  static constexpr std::string_view type_meaning =
      "cone or frustum about z, its origin half way between the ends";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  [[nodiscard]] MassProperties unit_density() const override;
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  /// Empty: the shape meets cables and the ground, but no other body.
  [[nodiscard]] ConvexSolid solid() const override { return {}; }
  [[nodiscard]] Vector3 half_extent() const override;
};

}  // namespace sheave
