#pragma once
// The link over which a cable slides because its friction cannot hold the difference of tensions.

#include <string>

#include "cable/simulation.h"

namespace sheave {

/// A clause that names the cable, the link, the ratio of the tensions beside the link, the friction
/// or efficiency that allows no more, and the remedy. Of several slipping links the one with the
/// largest difference of tensions. Empty if no link with friction slips in `state`, which belongs to
/// the simulation and has the forces of a search for equilibrium.
[[nodiscard]] std::string slipping_text(const Simulation& simulation, const State& state);

}  // namespace sheave
