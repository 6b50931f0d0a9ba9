#pragma once
// What every type of controller must provide. Adding one: a file in scenes/control/ and a line in
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

/// What a controller knows when it acts.
struct ControllerInput {
  double setpoint = 0.0;
  double setpoint_rate = 0.0;  ///< mean until the next sample [per s]; 0 of a quantity
  double measured = 0.0;
  double interval = 0.0;  ///< since it acted last [s], or its sample time
  bool first = false;     ///< whether it acts for the first time since it was switched on
};

/// Leads an observable to a setpoint by a control. It acts at the first substep's start at or
/// behind each multiple of its sample time, and what it sets holds until it acts again. Settings;
/// derived types add their own.
class ControllerDef {
 public:
  virtual ~ControllerDef() = default;

  std::string name;  ///< unique among the controllers
  std::string
      measures;  ///< name of an observable (scenes/observables.h) that follows from the state
  std::string control;                 ///< name of a control (scenes/control/control_point.h)
  std::optional<double> setpoint;      ///< constant, in the unit of the observable
  std::vector<double> setpoint_times;  ///< [s], increasing; as many as values
  std::vector<double> setpoint_values;
  Interpolation setpoint_interpolation = Interpolation::linear;
  std::string setpoint_quantity;      ///< name of another observable; empty: none
  std::optional<double> sample_time;  ///< [s], > 0; default: dt
  bool on = true;                     ///< at time 0; triggers switch it

  static std::span<const Field> common_field_table();
  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry, e.g. "pid"
  [[nodiscard]] virtual const void* settings() const = 0;   ///< this, as its own type
  /// Faults beyond the ranges of the field tables; `path` is prepended to theirs.
  [[nodiscard]] virtual Errors validate(const std::string& path) const;
  /// The smallest and the largest value that it may set; none: any.
  [[nodiscard]] virtual std::array<std::optional<double>, 2> range() const = 0;
  /// How many numbers it remembers; they are 0 when it is switched on.
  [[nodiscard]] virtual std::size_t memory_size() const = 0;
  [[nodiscard]] virtual double output(const ControllerInput& input,
                                      std::span<double> memory) const = 0;

  [[nodiscard]] TimeTable setpoint_table() const;

 protected:
  ControllerDef() = default;
  ControllerDef(const ControllerDef&) = default;
  ControllerDef& operator=(const ControllerDef&) = default;
};

/// All types, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<ControllerDef>> controller_types();

}  // namespace sheave
