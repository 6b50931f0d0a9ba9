#pragma once
// Actions that are carried out when a condition becomes true.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

/// The action of a trigger.
enum class TriggerAction {
  set,      ///< sets a control (scenes/control/control_point.h) to a value
  clear,    ///< restores the control's value of the scene
  release,  ///< a joint no longer holds, as if it had broken
  lock,     ///< a released joint holds again, in the present pose (World::lock_joint())
  cut,      ///< a cable is cut as soon as it has a tension
  on,       ///< a controller acts from now on, as if it were new
  off,      ///< a controller no longer acts; its last output stays
  stop,     ///< the run ends
};
inline constexpr std::array<std::string_view, 8> trigger_action_names{
    "set", "clear", "release", "lock", "cut", "on", "off", "stop"};

/// Acts at its own instant, within a substep, too (engine/instants.h); a condition that comes and
/// goes within one substep is not seen.
struct TriggerDef {
  std::string name;          ///< unique among the triggers
  std::optional<double> at;  ///< [s]
  /// name of an observable that follows from the state alone, or an expression of such ones; with
  /// above or below
  std::string quantity;
  std::optional<double> above;  ///< the quantity rises above this value
  std::optional<double> below;  ///< the quantity falls below this value
  bool repeats = false;  ///< acts each time the condition becomes true, not only the first time
  TriggerAction action = TriggerAction::stop;
  std::string target;           ///< name of the control, joint, cable or controller; not of stop
  std::optional<double> value;  ///< of set
  std::optional<double> place;  ///< of cut: length from the cable's first link [m], > 0
  double over = 0.0;  ///< of set: time that a drive or a feed takes to reach the value [s], >= 0

  static std::span<const Field> field_table();
  /// Faults beyond the ranges of the fields and the names. `path` is the prefix of their paths.
  [[nodiscard]] Errors validate(const std::string& path) const;
};

}  // namespace sheave
