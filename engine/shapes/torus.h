#pragma once

#include "engine/shape.h"

namespace sheave {

/// A ring of round section about z, about its centre.
class Torus final : public Shape {
 public:
  double radius = 0.5;       ///< of the circle in the middle of the tube [m], > tube_radius
  double tube_radius = 0.1;  ///< [m], > 0

  static constexpr std::string_view type_name = "torus";
  static constexpr std::string_view type_meaning = "ring of round section about z";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  [[nodiscard]] MassProperties unit_density() const override;
  void append_contact_points(const Vector3& down, std::vector<Vector3>& points) const override;
  void append_section(const SectionPlane& plane, std::vector<Vector3>& points) const override;
  /// Empty: the shape meets cables and the ground, but no other body.
  [[nodiscard]] ConvexSolid solid() const override { return {}; }
  [[nodiscard]] Vector3 half_extent() const override {
    return {radius + tube_radius, radius + tube_radius, tube_radius};
  }
};

}  // namespace sheave
