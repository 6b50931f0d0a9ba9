#pragma once
// Faults of the camera's path and of the annotations of a scene.

#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave {

/// All faults, each with the JSON pointer of its setting.
[[nodiscard]] Errors validate_pictures(const Scene& scene);

}  // namespace sheave
