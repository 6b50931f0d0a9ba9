#include "scenes/control/controller.h"

#include <array>

#include <fmt/format.h>

namespace sheave {

std::span<const Field> ControllerDef::common_field_table() {
  static const std::array table{
      field<&ControllerDef::name>("name", "", {}, required, "unique name among the controllers"),
      field<&ControllerDef::measures>("measures", "", {}, required,
                                      "the observable or expression to control; no observable on "
                                      "request that is known only for "
                                      "the last substep"),
      field<&ControllerDef::control>("control", "", {}, required,
                                     "the control to set, see Controls"),
      field<&ControllerDef::setpoint>("setpoint", "", any_number(), optional,
                                      "constant, in the observable's unit"),
      field<&ControllerDef::setpoint_times>("setpoint_times", "s", any_number(), optional,
                                            "increasing times of the setpoint's values"),
      field<&ControllerDef::setpoint_values>("setpoint_values", "", any_number(), optional,
                                             "of a setpoint that changes, one per time"),
      choice_field<&ControllerDef::setpoint_interpolation>(
          "setpoint_interpolation", interpolation_names, optional, interpolation_meaning),
      field<&ControllerDef::setpoint_quantity>(
          "setpoint_quantity", "", {}, optional,
          "an observable or expression that is the setpoint, or that is added to it"),
      field<&ControllerDef::sample_time>("sample_time", "s", above(0.0), optional,
                                         "how often it acts, at most once per substep; default: "
                                         "dt"),
      field<&ControllerDef::on>("on", "", {}, optional, "at time 0; triggers switch it"),
  };
  return table;
}

Errors ControllerDef::validate(const std::string& path) const {
  Errors errors;
  const auto fail = [&](std::string_view key, std::string message) {
    errors.push_back(
        {fmt::format("{}/{}", path, key), fmt::format("controller \"{}\": {}", name, message)});
  };
  if (setpoint && !setpoint_values.empty()) {
    fail("setpoint", "setpoint is constant, and setpoint_values change; leave one out");
  } else if (!setpoint && setpoint_values.empty() && setpoint_quantity.empty()) {
    fail("setpoint", "it needs one of setpoint, setpoint_values and setpoint_quantity");
  }
  if (setpoint_times.size() != setpoint_values.size()) {
    fail("setpoint_values", fmt::format("as many values as times are needed, there are {} and {}",
                                        setpoint_values.size(), setpoint_times.size()));
  }
  if (setpoint_values.empty() && setpoint_interpolation != Interpolation::linear) {
    fail("setpoint_interpolation", "only a table of values is interpolated");
  }
  for (std::size_t i = 1; i < setpoint_times.size(); ++i) {
    if (setpoint_times[i] > setpoint_times[i - 1]) continue;
    fail(fmt::format("setpoint_times/{}", i), "times must increase");
    break;
  }
  return errors;
}

TimeTable ControllerDef::setpoint_table() const {
  if (setpoint) return {{}, {*setpoint}};
  return TimeTable::of(setpoint_times, setpoint_values, setpoint_interpolation);
}

}  // namespace sheave
