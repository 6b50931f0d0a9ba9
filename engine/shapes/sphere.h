#pragma once

#include "engine/shape.h"

namespace sheave {

/// A solid ball about its centre.
class Sphere final : public Shape {
 public:
  double radius = 0.5;  ///< [m], > 0

  static constexpr std::string_view type_name = "sphere";
  static constexpr std::string_view type_meaning = "solid ball about its centre";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] MassProperties unit_density() const override;
  [[nodiscard]] double wheel_radius() const override { return radius; }
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  [[nodiscard]] Vector3 half_extent() const override { return Vector3::Constant(radius); }
};

}  // namespace sheave
