#pragma once
// Which rows act where a machine is linearised, and with what forces.

#include <vector>

#include "statics/configuration.h"

namespace sheave {

/// Rows that are closed or have a force.
struct Acting {
  ConfigurationRows rows;
  VectorX unknowns;        ///< forces [N or N m]
  std::vector<char> acts;  ///< per unknown
  bool slides = false;     ///< cable slides with friction
};

/// Forces of rigid rows that balance loads as well as any can, in turns with which rows act. `size`
/// is the scene's [m]. What has all the force that it can have (a drive at its limit, dry friction)
/// keeps it and holds nothing.
[[nodiscard]] Acting find_acting(Configuration& configuration, double size);

}  // namespace sheave
