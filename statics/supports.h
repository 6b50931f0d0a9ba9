#pragma once
// What holds a machine that rests: forces of bearings, guides, rails and the ground.

#include <vector>

#include "cable/simulation.h"

namespace sheave {

/// The force by which its bearing, guide or fixing holds a body that is not free, or, of the last
/// one (`body` is BodyId::world()), by which the ground holds what is fixed to the world itself.
struct SupportReaction {
  BodyId body;
  Vector3 force = Vector3::Zero();  ///< on the body [N], world frame
};

/// Of a simulation at rest, where `forces` (per feature and multiplier) are those of its rows, as
/// Equilibrium has them. Bodies that nothing acts on are left out.
[[nodiscard]] std::vector<SupportReaction> support_reactions(
    Simulation& simulation, const std::vector<std::vector<double>>& forces);

}  // namespace sheave
