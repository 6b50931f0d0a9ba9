#pragma once

#include "engine/shape.h"

namespace sheave {

/// A rectangular box about its centre.
class Box final : public Shape {
 public:
  Vector3 size = Vector3::Ones();  ///< full edge lengths [m], > 0

  static constexpr std::string_view type_name = "box";
  static constexpr std::string_view type_meaning = "rectangular box about its centre";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] MassProperties unit_density() const override;
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  [[nodiscard]] ConvexSolid solid() const override;
  [[nodiscard]] Vector3 half_extent() const override { return 0.5 * size; }
};

}  // namespace sheave
