// The load types: one line each.

#include <array>

#include "scenes/control/load_force.h"
#include "scenes/control/load_motion.h"
#include "scenes/control/load_muscle.h"
#include "scenes/control/load_wind.h"

namespace sheave {

std::span<const TypeEntry<LoadDef>> load_types() {
  static const std::array types{
      type_entry<LoadDef, ForceLoad>(),
      type_entry<LoadDef, WindLoad>(),
      type_entry<LoadDef, MotionLoad>(),
      type_entry<LoadDef, MuscleLoad>(),
  };
  return types;
}

}  // namespace sheave
