#pragma once
// States in files, with a check that the machine is the same and that the bytes are unchanged.

#include <string>
#include <vector>

#include "cable/simulation.h"

namespace sheave {

/// Identifies the machine of the simulation as it is now. The scene part covers all settings except
/// those of the step. The layout part covers the bodies, joints, cables, controllers and triggers,
/// in their order.
[[nodiscard]] StateOrigin origin_of(const Simulation& simulation);

/// The simulation's state as bytes, for a file.
[[nodiscard]] std::string saved_state(const Simulation& simulation);

/// Restores a saved state in the simulation and returns notes for the user. Returns an error and
/// changes nothing if the bytes are damaged, if the state belongs to a machine with another layout,
/// or if its time does not match its number of steps.
[[nodiscard]] Result<std::vector<std::string>> load_saved_state(Simulation& simulation,
                                                                const std::string& bytes);
/// The same without restoring: writes the state into `state`.
[[nodiscard]] Result<std::vector<std::string>> check_saved_state(const Simulation& simulation,
                                                                 const std::string& bytes,
                                                                 State& state);

}  // namespace sheave
