// The controller types: one line each.

#include <array>

#include "scenes/control/bang_bang.h"
#include "scenes/control/pid.h"

namespace sheave {

std::span<const TypeEntry<ControllerDef>> controller_types() {
  static const std::array types{
      type_entry<ControllerDef, PidController>(),
      type_entry<ControllerDef, BangBangController>(),
  };
  return types;
}

}  // namespace sheave
