#include "scenes/control/bang_bang.h"

namespace sheave {

std::span<const Field> BangBangController::field_table() {
  static const std::array table{
      field<&BangBangController::low>("low", "", any_number(), required,
                                      "output while the observable is above its setpoint"),
      field<&BangBangController::high>("high", "", any_number(), required,
                                       "output while it is below"),
      field<&BangBangController::hysteresis>(
          "hysteresis", "", at_least(0.0), optional,
          "the output switches half of this beyond the setpoint, in the observable's unit"),
  };
  return table;
}

double BangBangController::output(const ControllerInput& input, std::span<double> memory) const {
  double& is_high = memory[0];
  const double error = input.setpoint - input.measured;
  if (input.first) is_high = error > 0.0 ? 1.0 : 0.0;
  if (error > 0.5 * hysteresis) is_high = 1.0;
  if (error < -0.5 * hysteresis) is_high = 0.0;
  return is_high != 0.0 ? high : low;
}

}  // namespace sheave
