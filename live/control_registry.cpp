// The controls: one line each.

#include <array>

#include "live/control.h"
#include "scenes/format_tables.h"

namespace sheave::live {

std::span<const TypeEntry<Control>> set_types() {
  static const std::array types{
      set_speed(),
      set_angle(),
      set_torque(),
      set_joint_drive(),
      set_joint_drive_limit(),
      set_force(),
      set_motion(),
      set_gravity(),
      set_compliance(),
      set_breaking_tension(),
      set_wrap_friction(),
      set_friction(),
      set_feed_speed(),
  };
  return types;
}

std::span<const TypeEntry<Control>> clear_types() {
  static const std::array types{
      clear_drive(),
      clear_joint_drive(),
      clear_force(),
      clear_motion(),
      clear_gravity(),
      clear_compliance(),
      clear_breaking_tension(),
      clear_wrap_friction(),
      clear_friction(),
      clear_feed_speed(),
  };
  return types;
}

const ObjectFormat& set_format() {
  static const ObjectFormat format{
      "control", "a control and its value", false, {}, variants_of(set_types()), {}, {}};
  return format;
}

const ObjectFormat& clear_format() {
  static const ObjectFormat format{"cleared control",
                                   "a control that returns to the value of the scene",
                                   false,
                                   {},
                                   variants_of(clear_types()),
                                   {},
                                   {}};
  return format;
}

Errors at_pointer(Errors errors, const std::string& pointer) {
  for (Error& error : errors) error.path = pointer;
  return errors;
}

}  // namespace sheave::live
