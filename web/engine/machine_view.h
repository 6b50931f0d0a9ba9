#pragma once
// The appearance of a live machine for a page, in the format that `sheave view` uses for a recorded
// run.

#include "view/machine_json.h"

namespace sheave::web {

/// `tension_max` [N] and the bounds are estimated from the first second, or from 60 steps if these
/// are shorter, because the user's later actions are unknown.
[[nodiscard]] view::Json machine_description(const Scene& scene, const Simulation& start,
                                             const view::FrameChannels& channels);

}  // namespace sheave::web
