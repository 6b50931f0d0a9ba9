#pragma once
// Loads a scene as a LiveWorld.

#include <string>

#include "cable/live_world.h"

namespace sheave {

/// The world of a scene file (scenes/scene.h) at time 0, with its controllers and triggers.
/// Messages of errors contain file, line and column.
[[nodiscard]] Result<LiveWorld> load(const std::string& path);

}  // namespace sheave
