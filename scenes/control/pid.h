#pragma once

#include "scenes/control/controller.h"

namespace sheave {

/// Proportional, integral and derivative action on e = setpoint - measured, with feed-forward:
///
///   u = feed_forward + setpoint_gain r + rate_gain r' + proportional e + I + D,   lower <= u <= upper
///   I' = integral e,   but not while u is at a limit and I would push it further (no wind-up)
///   D + derivative_filter D' = derivative e'
///
/// With the interval T between samples, I grows by integral e T after u has been set, and D is
/// (derivative_filter D + derivative (e - e before)) / (derivative_filter + T).
class PidController final : public ControllerDef {
 public:
  double proportional = 0.0;       ///< [control per quantity]
  double integral = 0.0;           ///< [control per quantity and s]
  double derivative = 0.0;         ///< [control s per quantity]
  double derivative_filter = 0.0;  ///< [s], >= 0
  double feed_forward = 0.0;       ///< [control]
  double setpoint_gain = 0.0;      ///< [control per quantity]
  double rate_gain = 0.0;          ///< [control s per quantity]
  std::optional<double> lower;     ///< [control]
  std::optional<double> upper;     ///< [control]

  static constexpr std::string_view type_name = "pid";
  static constexpr std::string_view type_meaning =
      "proportional, integral and derivative action on setpoint - measured, with feed-forward; the "
      "integral does not wind up at the limits";
  static std::span<const Field> field_table();

  [[nodiscard]] std::string_view type() const override { return type_name; }
  [[nodiscard]] const void* settings() const override { return this; }
  [[nodiscard]] Errors validate(const std::string& path) const override;
  [[nodiscard]] std::array<std::optional<double>, 2> range() const override {
    return {lower, upper};
  }
  [[nodiscard]] std::size_t memory_size() const override { return 3; }
  [[nodiscard]] double output(const ControllerInput& input,
                              std::span<double> memory) const override;
};

}  // namespace sheave
