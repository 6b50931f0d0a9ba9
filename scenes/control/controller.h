#pragma once
// Interface of all controllers. A new type is a file in scenes/control/ and a line in
// controller_registry.cpp.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/field.h"
#include "engine/result.h"
#include "engine/time_table.h"

namespace sheave {

/// Input of a controller when it acts.
struct ControllerInput {
  double setpoint = 0.0;
  /// mean until the next sample [per s]; setpoint_quantity has no part in it
  double setpoint_rate = 0.0;
  double measured = 0.0;
  double interval = 0.0;  ///< time since it acted last [s], or its sample time
  bool first = false;     ///< whether it acts for the first time after being switched on
};

/// Leads an observable to a setpoint by a control. The controller acts at each multiple of its
/// sample time, or, if that is shorter than a substep, at the start of each substep. Its output
/// holds until it acts again. Settings; derived types add their own.
class ControllerDef {
 public:
  virtual ~ControllerDef() = default;

  std::string name;  ///< unique among the controllers
  /// name of an observable (scenes/observables.h) that follows from the state alone, or an
  /// expression (scenes/expression.h) of such ones
  std::string measures;
  std::string control;                 ///< name of a control (scenes/control/control_point.h)
  std::optional<double> setpoint;      ///< constant setpoint, in the unit of the observable
  std::vector<double> setpoint_times;  ///< [s], increasing; as many as values
  std::vector<double> setpoint_values;
  Interpolation setpoint_interpolation = Interpolation::linear;
  /// another observable or expression; added to a constant or changing setpoint; empty: none
  std::string setpoint_quantity;
  std::optional<double> sample_time;  ///< [s], > 0; default: dt
  bool on = true;                     ///< whether it is on at time 0; triggers can switch it

  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "pid"
  /// this, as a pointer to the derived type
  [[nodiscard]] virtual const void* settings() const = 0;
  /// Faults beyond the ranges of the field tables. `path` is the prefix of their paths.
  [[nodiscard]] virtual Errors validate(const std::string& path) const;
  /// The smallest and the largest value that it may set; none: unlimited.
  [[nodiscard]] virtual std::array<std::optional<double>, 2> range() const = 0;
  /// Number of values in its memory; all are 0 when it is switched on.
  [[nodiscard]] virtual std::size_t memory_size() const = 0;
  [[nodiscard]] virtual double output(const ControllerInput& input,
                                      std::span<double> memory) const = 0;

  [[nodiscard]] TimeTable setpoint_table() const;

 protected:
  ControllerDef() = default;
  ControllerDef(const ControllerDef&) = default;
  ControllerDef& operator=(const ControllerDef&) = default;
};

/// All types of controllers, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<ControllerDef>> controller_types();

}  // namespace sheave
