#include "scenes/control/trigger.h"

#include <fmt/format.h>

namespace sheave {

std::span<const Field> TriggerDef::field_table() {
  static const std::array table{
      field<&TriggerDef::name>("name", "", {}, required, "unique name among the triggers"),
      field<&TriggerDef::at>(
          "at", "s", at_least(0.0), optional,
          "time at which it acts; the alternative is quantity with above or below"),
      field<&TriggerDef::quantity>(
          "quantity", "", {}, optional,
          "an observable or an expression; no observable on request that is "
          "known of the last substep only"),
      field<&TriggerDef::above>(
          "above", "", any_number(), optional,
          "it acts once the quantity is above this value, in the quantity's unit"),
      field<&TriggerDef::below>(
          "below", "", any_number(), optional,
          "it acts once the quantity is below this value, in the quantity's unit"),
      field<&TriggerDef::repeats>("repeats", "", {}, optional,
                                  "whether it acts every time, and not only the first time"),
      choice_field<&TriggerDef::action>(
          "action", trigger_action_names, required,
          "set: a control to value; clear: the control gets the value of the scene again; release: "
          "a joint holds nothing any more; lock: a joint that was released or has broken holds "
          "again, from the present poses of its bodies; cut: a cable parts as soon as it pulls; "
          "on, off: switches a controller; stop: the run ends. A brake is applied, or fails, when "
          "the drive_limit of a drive to the speed 0 is set"),
      field<&TriggerDef::target>("target", "", {}, optional,
                                 "the control, joint, cable or controller"),
      field<&TriggerDef::value>("value", "", any_number(), optional,
                                "value of the control for set, in the control's unit"),
      field<&TriggerDef::place>("place", "m", sheave::above(0.0), optional,
                                "of cut: where, as the unstretched length from the cable's first "
                                "link on, in a free span; the cable then needs no tension. "
                                "Default: in the span with the largest tension"),
      field<&TriggerDef::over>("over", "s", at_least(0.0), optional,
                               "time that a drive or a feed takes to reach the value; default: an "
                               "angle or a position in a substep, any other value at once"),
  };
  return table;
}

Errors TriggerDef::validate(const std::string& path) const {
  Errors errors;
  const auto fail = [&](std::string_view key, std::string_view message) {
    errors.push_back(
        {fmt::format("{}{}", path, key), fmt::format("trigger \"{}\": {}", name, message)});
  };
  const bool watches = !quantity.empty();
  if (at.has_value() == watches) fail("", "it needs either at or a quantity");
  if (watches && above.has_value() == below.has_value()) {
    fail("/quantity", "a quantity needs either above or below");
  }
  if (!watches && (above || below)) {
    fail(above ? "/above" : "/below", "above and below need a quantity; give one");
  }
  if (repeats && !watches)
    fail("/repeats", "repeats needs a quantity; with at the trigger acts once");
  if (action == TriggerAction::stop && !target.empty()) {
    fail("/target", "the whole run stops; leave the target out");
  }
  const bool sets = action == TriggerAction::set;
  if (sets != value.has_value()) {
    fail(value ? "/value" : "", sets ? "set needs a value" : "only set has a value");
  }
  if (place && action != TriggerAction::cut) fail("/place", "only cut has a place; leave it out");
  if (over > 0.0 && !sets) fail("/over", "over is for set only; leave it out");
  return errors;
}

}  // namespace sheave
