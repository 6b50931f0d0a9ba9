#pragma once
// A simulation's state in a file, to go on from later.

#include <string>

#include "cable/simulation.h"

namespace sheave::command {

/// Puts a saved state into the simulation, and prints warnings of one without a checksum or of
/// another scene, unless that has been done. Throws a Failure: 66 if there is no such file, 74 if it cannot be read, 65 if it is
/// no state, has been changed, or is one of another machine or another step size (time is counted in
/// steps). Saving is saved_state() of scenes/saved_state.h.
void load_state(Simulation& simulation, const std::string& path, bool warns = true);

}  // namespace sheave::command
