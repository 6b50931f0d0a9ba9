#pragma once

#include "engine/shape.h"

namespace sheave {

/// A solid cylinder about its centre, axis along z: the shape of a wheel.
class Cylinder final : public Shape {
 public:
  double radius = 0.5;  ///< [m], > 0
  double length = 0.1;  ///< along z [m], > 0

  static constexpr std::string_view type_name = "cylinder";
  static constexpr std::string_view type_meaning =
      "solid cylinder about its centre, axis along z; the shape of a wheel";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] MassProperties unit_density() const override;
  [[nodiscard]] double wheel_radius() const override { return radius; }
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  [[nodiscard]] Vector3 half_extent() const override { return {radius, radius, 0.5 * length}; }
};

}  // namespace sheave
