#pragma once

#include "engine/shape.h"

namespace sheave {

/// A cylinder along z with half balls at its ends, about its centre.
class Capsule final : public Shape {
 public:
  double radius = 0.1;  ///< [m], > 0
  double length = 1.0;  ///< of the cylindrical part along z [m], > 0; the whole is 2 radii longer

  static constexpr std::string_view type_name = "capsule";
  static constexpr std::string_view type_meaning =
      "cylinder along z with half balls at both ends, about its centre";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] MassProperties unit_density() const override;
  [[nodiscard]] double wheel_radius() const override { return radius; }
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  [[nodiscard]] Vector3 half_extent() const override {
    return {radius, radius, 0.5 * length + radius};
  }
};

}  // namespace sheave
