#pragma once
// A scene as a world that lives.

#include <string>

#include "cable/live_world.h"

namespace sheave {

/// The world of a scene file (scenes/scene.h), at time 0, with its controllers and triggers. Errors
/// have the file, line and column of what is wrong in their messages.
[[nodiscard]] Result<LiveWorld> load(const std::string& path);

}  // namespace sheave
