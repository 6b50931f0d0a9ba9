#pragma once
// How a machine that lives looks, for a page: what `sheave view` tells of a run that is over.

#include "view/machine_json.h"

namespace sheave::web {

/// `tension_max` [N] and the room follow from the first second at most, of no more than 60 steps,
/// since nobody knows what will be done to it.
[[nodiscard]] view::Json machine_description(const Scene& scene, const Simulation& start,
                                             const view::FrameChannels& channels);

}  // namespace sheave::web
