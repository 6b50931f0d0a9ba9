#pragma once
// Interface of all controls that can be set or cleared. A new control is a file in live/controls/
// and a line in control_registry.cpp.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "cable/live_world.h"
#include "engine/field.h"
#include "engine/result.h"
#include "live/names.h"
#include "scenes/format.h"

namespace sheave::live {

/// One change of a control. Derived types add its settings.
class Control {
 public:
  virtual ~Control() = default;
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  [[nodiscard]] virtual std::string_view type() const = 0;  ///< key in the registry
  /// this, as a pointer to the derived type
  [[nodiscard]] virtual const void* settings() const = 0;
  /// Sets or clears the control. Faults have pointers within it.
  [[nodiscard]] virtual Errors apply(LiveWorld& world, const Names& names) const = 0;

 protected:
  Control() = default;
};

/// The controls that can be set, and those that can be cleared, in the order of the documentation.
[[nodiscard]] std::span<const TypeEntry<Control>> set_types();
[[nodiscard]] std::span<const TypeEntry<Control>> clear_types();

/// The formats of the objects in the list "controls" of both requests.
[[nodiscard]] const ObjectFormat& set_format();
[[nodiscard]] const ObjectFormat& clear_format();

/// The registry line of `Type`, which declares static type_name, type_meaning and field_table().
template <class Type>
[[nodiscard]] constexpr TypeEntry<Control> control_entry() {
  return type_entry<Control, Type>();
}

// Defined in the files in live/controls/.
[[nodiscard]] TypeEntry<Control> set_speed();
[[nodiscard]] TypeEntry<Control> set_angle();
[[nodiscard]] TypeEntry<Control> set_torque();
[[nodiscard]] TypeEntry<Control> clear_drive();
[[nodiscard]] TypeEntry<Control> set_joint_drive();
[[nodiscard]] TypeEntry<Control> set_joint_drive_limit();
[[nodiscard]] TypeEntry<Control> clear_joint_drive();
[[nodiscard]] TypeEntry<Control> set_force();
[[nodiscard]] TypeEntry<Control> clear_force();
[[nodiscard]] TypeEntry<Control> set_motion();
[[nodiscard]] TypeEntry<Control> clear_motion();
[[nodiscard]] TypeEntry<Control> set_gravity();
[[nodiscard]] TypeEntry<Control> clear_gravity();
[[nodiscard]] TypeEntry<Control> set_compliance();
[[nodiscard]] TypeEntry<Control> clear_compliance();
[[nodiscard]] TypeEntry<Control> set_breaking_tension();
[[nodiscard]] TypeEntry<Control> clear_breaking_tension();
[[nodiscard]] TypeEntry<Control> set_wrap_friction();
[[nodiscard]] TypeEntry<Control> clear_wrap_friction();
[[nodiscard]] TypeEntry<Control> set_friction();
[[nodiscard]] TypeEntry<Control> clear_friction();
[[nodiscard]] TypeEntry<Control> set_feed_speed();
[[nodiscard]] TypeEntry<Control> clear_feed_speed();

/// `errors` with this pointer.
[[nodiscard]] Errors at_pointer(Errors errors, const std::string& pointer);

}  // namespace sheave::live
