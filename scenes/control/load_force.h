#pragma once

#include <optional>

#include "scenes/control/load.h"

namespace sheave {

/// A force and a torque over time. Over each substep they have their mean, so the impulse is exact.
class ForceLoad final : public LoadDef {
 public:
  std::vector<double> times;     ///< [s], increasing; as many as values, or none for a constant
  std::vector<Vector3> forces;   ///< [N]
  std::vector<Vector3> torques;  ///< in addition to the moment of the force [N m]
  Interpolation interpolation = Interpolation::linear;
  std::optional<Vector3> point;  ///< [m], body frame; default: the centre of mass
  ForceFrame frame = ForceFrame::world;

  static constexpr std::string_view type_name = "force";
  static constexpr std::string_view type_meaning = "a force and a torque over time";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] bool is_central() const override { return !point && frame == ForceFrame::world; }
  [[nodiscard]] Errors validate(const LoadScope& scope, const std::string& path) const override;
  [[nodiscard]] std::shared_ptr<const ActingLoad> prepare(const LoadScope& scope) const override;
};

}  // namespace sheave
