#pragma once
// The active rows of a machine that is linearised, and their forces.

#include <vector>

#include "statics/configuration.h"

namespace sheave {

/// The rows that are closed or have a force.
struct Acting {
  ConfigurationRows rows;
  VectorX unknowns;        ///< forces [N or N m]
  std::vector<char> acts;  ///< per unknown
  bool slides = false;     ///< cable slides with friction
};

/// Forces of rigid rows that balance the loads as well as possible, found in turn with the active
/// set. `size`: size of the scene [m]. A row at its bound (a drive at its limit, dry friction)
/// keeps its force and holds nothing.
[[nodiscard]] Acting find_acting(Configuration& configuration, double size);

}  // namespace sheave
