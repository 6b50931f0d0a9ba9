#pragma once

#include "engine/shape.h"

namespace sheave {

/// All points beneath a plane through the shape's origin: a floor, a wall or a slope for colliders.
/// A half-space has no mass, so only static and kinematic bodies can have one, and no cable can be
/// laid round it.
class HalfSpace final : public Shape {
 public:
  Vector3 normal = Vector3::UnitY();  ///< away from the solid side; any length but 0

  static constexpr std::string_view type_name = "half-space";
  static constexpr std::string_view type_meaning =
      "everything beneath a plane through its origin, for static and kinematic bodies: a floor, a "
      "wall, a slope for colliders";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  /// Mass 0, because the volume is infinite.
  [[nodiscard]] MassProperties unit_density() const override { return {}; }
  [[nodiscard]] bool bounded() const override { return false; }
  /// Appends nothing, because a half-space never rests on a floor.
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  /// Appends nothing, because cables do not touch half-spaces.
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  /// 0, so that a half-space does not change the size of a scene.
  [[nodiscard]] Vector3 half_extent() const override { return Vector3::Zero(); }
};

}  // namespace sheave
