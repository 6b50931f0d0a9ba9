#pragma once

#include "scenes/control/controller.h"

namespace sheave {

/// Switches between two outputs: `high` when the measured value is more than half of the hysteresis
/// below the setpoint, `low` when it is more than that above; in between the output stays as it is.
class BangBangController final : public ControllerDef {
 public:
  double low = 0.0;         ///< [control]
  double high = 0.0;        ///< [control]
  double hysteresis = 0.0;  ///< full width, in the observable's unit, >= 0

  static constexpr std::string_view type_name = "bang-bang";
  static constexpr std::string_view type_meaning =
      "one of two outputs, by whether the observable is below or above its setpoint";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] std::array<std::optional<double>, 2> range() const override { return {low, high}; }
  [[nodiscard]] std::size_t memory_size() const override { return 1; }
  [[nodiscard]] double output(const ControllerInput& input,
                              std::span<double> memory) const override;
};

}  // namespace sheave
