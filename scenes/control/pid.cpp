#include "scenes/control/pid.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "engine/field_check.h"

namespace sheave {

std::span<const Field> PidController::field_table() {
  static const std::array table{
      field<&PidController::proportional>("proportional", "", any_number(), optional,
                                          "control per error"),
      field<&PidController::integral>("integral", "1/s", any_number(), optional,
                                      "control per error and second"),
      field<&PidController::derivative>("derivative", "s", any_number(), optional,
                                        "control per rate of the error"),
      field<&PidController::derivative_filter>("derivative_filter", "s", at_least(0.0), optional,
                                               "time constant of a lag that the derivative has"),
      field<&PidController::feed_forward>("feed_forward", "", any_number(), optional,
                                          "is added to the output"),
      field<&PidController::setpoint_gain>("setpoint_gain", "", any_number(), optional,
                                           "the setpoint times this, too"),
      field<&PidController::rate_gain>(
          "rate_gain", "s", any_number(), optional,
          "and the mean rate until the next sample, of a setpoint by table, times this"),
      field<&PidController::lower>("lower", "", any_number(), optional,
                                   "the least output (default: any)"),
      field<&PidController::upper>("upper", "", any_number(), optional,
                                   "the greatest output (default: any)"),
  };
  return table;
}

Errors PidController::validate(const std::string& path) const {
  Errors errors = ControllerDef::validate(path);
  if (lower && upper && !(*lower < *upper)) {
    errors.push_back(
        {path + "/lower", fmt::format("controller \"{}\": the least output {} must be below the "
                                      "greatest, {}",
                                      name, number_text(*lower), number_text(*upper))});
  }
  if (derivative_filter > 0.0 && derivative == 0.0) {
    errors.push_back({path + "/derivative_filter",
                      fmt::format("controller \"{}\": there is no derivative to filter", name)});
  }
  if (rate_gain != 0.0 && !setpoint_quantity.empty() && setpoint_values.empty()) {
    errors.push_back({path + "/rate_gain",
                      fmt::format("controller \"{}\": only the rate of a table is known", name)});
  }
  return errors;
}

double PidController::output(const ControllerInput& input, std::span<double> memory) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double& sum = memory[0];
  double& error_before = memory[1];
  double& slope = memory[2];
  const double error = input.setpoint - input.measured;
  if (input.first) {
    slope = 0.0;
  } else {
    slope = (derivative_filter * slope + derivative * (error - error_before)) /
            (derivative_filter + input.interval);
  }
  error_before = error;
  const double wanted = feed_forward + setpoint_gain * input.setpoint +
                        rate_gain * input.setpoint_rate + proportional * error + sum + slope;
  const double given = std::clamp(wanted, lower.value_or(-infinity), upper.value_or(infinity));
  const double growth = integral * error * input.interval;
  const bool winds_up = (wanted - given) * growth > 0.0;
  if (!winds_up) sum += growth;
  return given;
}

}  // namespace sheave
