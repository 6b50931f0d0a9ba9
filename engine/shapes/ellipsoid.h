#pragma once

#include "engine/shape.h"

namespace sheave {

/// A solid ellipsoid about its centre.
class Ellipsoid final : public Shape {
 public:
  Vector3 half_axes = Vector3(0.5, 0.4, 0.3);  ///< along x, y and z [m], > 0
  /// Largest ratio of two half axes; a cable over a sharper edge needs another shape.
  static constexpr double most_ratio = 100.0;

  static constexpr std::string_view type_name = "ellipsoid";
  static constexpr std::string_view type_meaning = "solid ellipsoid about its centre";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  [[nodiscard]] MassProperties unit_density() const override;
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  /// Empty: the shape meets cables and the ground, but no other body.
  [[nodiscard]] ConvexSolid solid() const override { return {}; }
  [[nodiscard]] Vector3 half_extent() const override { return half_axes; }
};

}  // namespace sheave
