#pragma once
// States in files: of which machine they are, and whether they are as they were written.

#include <string>
#include <vector>

#include "cable/simulation.h"

namespace sheave {

/// Of which machine states of the simulation are, as it is made now. The scene is all that it is
/// made of, but for how it is stepped; the layout is what bodies, joints, cables, controllers and
/// triggers there are, in which order.
[[nodiscard]] StateOrigin origin_of(const Simulation& simulation);

/// The simulation's state as bytes, for a file.
[[nodiscard]] std::string saved_state(const Simulation& simulation);

/// Puts a saved state into the simulation; what users should know of it. An error, and nothing has
/// changed, if the bytes are not as they were written, if the state is one of a machine with another
/// layout, or if its time is not that of its steps.
[[nodiscard]] Result<std::vector<std::string>> load_saved_state(Simulation& simulation,
                                                                const std::string& bytes);
/// The same without putting it there: makes `state` what is to be restored.
[[nodiscard]] Result<std::vector<std::string>> check_saved_state(const Simulation& simulation,
                                                                 const std::string& bytes,
                                                                 State& state);

}  // namespace sheave
