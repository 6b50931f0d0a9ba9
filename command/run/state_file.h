#pragma once
// Saves a simulation's state in a file from which a run can continue.

#include <string>

#include "cable/simulation.h"

namespace sheave::command {

/// Loads a saved state into the simulation. Prints warnings about a state without a checksum or of
/// another scene if `warns`. Throws a Failure: 66 if there is no such file, 74 if it cannot be
/// read, 65 if it is no state, has been changed, or belongs to another machine or another step size
/// (time is counted in steps). Saving is saved_state() of scenes/saved_state.h.
void load_state(Simulation& simulation, const std::string& path, bool warns = true);

}  // namespace sheave::command
