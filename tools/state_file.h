#pragma once
// A simulation's state in a file, to go on from later.

#include <string>

#include "engine/world.h"

namespace sheave::tools {

/// Puts a saved state into `world`. Throws a Failure: 66 if there is no such file, 74 if it cannot
/// be read, 65 if it is no state, or one of another world or another step size (time is counted in
/// steps). Saving is to_bytes() of engine/state.h.
void load_state(World& world, const std::string& path);

}  // namespace sheave::tools
