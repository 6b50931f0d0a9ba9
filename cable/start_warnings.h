#pragma once
// Warnings about cables as they begin: settings that are allowed and hardly ever meant.

#include <vector>

#include "cable/simulation.h"
#include "cable/step_warnings.h"

namespace sheave {

/// Windings at which a cable crosses itself ("crossed_winding"), in the order of
/// CableSystem::winding_warnings(). The subject is the cable.
void append_winding_warnings(const CableSystem& cables, std::vector<Warning>& warnings);

/// The worst span of each elastic cable whose rest lengths stretch it at the start by more than
/// 10 %, or beyond its breaking tension ("strained_start"). The subject is the span, "rope.0".
/// `start` is in the pose of its model, at time 0.
void append_strain_warnings(const Simulation& start, std::vector<Warning>& warnings);

/// Elastic cables whose spans do not start with their `rest_lengths`, because these give different
/// tensions to spans between which the cable passes freely ("uneven_start"). The subject is the span
/// with the largest difference. `start` as above.
void append_uneven_warnings(const Simulation& start, std::vector<Warning>& warnings);

}  // namespace sheave
