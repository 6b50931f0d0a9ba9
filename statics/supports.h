#pragma once
// Support forces of a machine at rest: those of bearings, guides, rails and the ground.

#include <vector>

#include "cable/simulation.h"

namespace sheave {

/// The force of a bearing, guide or fixing on a body that is not free. The last entry (`body` is
/// BodyId::world()) is the force of the ground on everything that is fixed to the world itself.
struct SupportReaction {
  BodyId body;
  Vector3 force = Vector3::Zero();  ///< on the body [N], world frame
};

/// For a simulation at rest. `forces` (per feature and multiplier) are those of its rows, as in
/// Equilibrium. Bodies without a force are left out.
[[nodiscard]] std::vector<SupportReaction> support_reactions(
    Simulation& simulation, const std::vector<std::vector<double>>& forces);

}  // namespace sheave
