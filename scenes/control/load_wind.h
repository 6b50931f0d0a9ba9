#pragma once

#include <optional>

#include "scenes/control/load.h"

namespace sheave {

/// The drag of a wind: the force 1/2 density drag_area |u - v| (u - v), where u is the velocity of
/// the wind and v that of the point. The velocity at the middle of a substep is extrapolated from
/// that at its start and at the start of the substep before, so the error is of second order.
class WindLoad final : public LoadDef {
 public:
  double drag_area = 0.0;           ///< drag coefficient times area [m2], > 0
  double density = 1.225;           ///< of the air [kg/m3], > 0
  std::vector<double> times;        ///< [s], increasing; as many as values, or none for a constant
  std::vector<Vector3> velocities;  ///< of the wind [m/s]; none: still air
  Interpolation interpolation = Interpolation::linear;
  std::optional<Vector3> point;  ///< [m], body frame; default: the centre of mass

  static constexpr std::string_view type_name = "wind";
  static constexpr std::string_view type_meaning = "the drag of a wind on a body, by its drag area";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_central() const override { return !point; }
  [[nodiscard]] Errors validate(const LoadScope& scope, const std::string& path) const override;
  [[nodiscard]] std::shared_ptr<const ActingLoad> prepare(const LoadScope& scope) const override;
};

}  // namespace sheave
