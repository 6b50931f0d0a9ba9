#pragma once
// What happens once something has happened.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/field.h"
#include "engine/result.h"

namespace sheave {

/// What a trigger does.
enum class TriggerAction {
  set,      ///< a control (scenes/control/control_point.h) to a value
  clear,    ///< the control is again what the scene says
  release,  ///< a joint holds nothing any more, as if it had broken
  lock,     ///< such a joint holds again, from where its bodies are (World::lock_joint())
  cut,      ///< a cable parts, as soon as it pulls
  on,       ///< a controller acts from now on, as if it were new
  off,      ///< a controller acts no more; what it has set stays
  stop,     ///< the run ends
};
inline constexpr std::array<std::string_view, 8> trigger_action_names{
    "set", "clear", "release", "lock", "cut", "on", "off", "stop"};

/// Looks before each substep, at what the state then is.
struct TriggerDef {
  std::string name;          ///< unique among the triggers
  std::optional<double> at;  ///< [s]
  std::string quantity;  ///< name of an observable that follows from the state; with above or below
  std::optional<double> above;  ///< the quantity comes to be above this
  std::optional<double> below;  ///< ... below this
  bool repeats = false;         ///< whenever it comes to be so again, not the first time alone
  TriggerAction action = TriggerAction::stop;
  std::string target;           ///< name of the control, joint, cable or controller; not of stop
  std::optional<double> value;  ///< of set
  double over = 0.0;            ///< of set: time that a drive takes to be there [s], >= 0

  static std::span<const Field> field_table();
  /// Faults beyond the ranges of the fields and the names; `path` is prepended to theirs.
  [[nodiscard]] Errors validate(const std::string& path) const;
};

}  // namespace sheave
