#pragma once

#include "scenes/scene.h"

namespace sheave {

/// validate_scene (scenes/scene.h), optionally without the fault that a check lies beyond the
/// duration: shortening a run on the command line does not change the scene's checks.
[[nodiscard]] Errors validate_scene(const Scene& scene, bool checks_may_end_late);

}  // namespace sheave
