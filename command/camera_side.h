#pragma once
// The option --view: a picture from the front, from the side or from above.

#include <string>

#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace sheave::command {

/// Adds --view. `view` is empty without it.
void add_view_option(CLI::App& app, std::string& view);

/// Turns the scene's camera to a side, "front", "side" or "top", and lets its distance be chosen;
/// nothing if `view` is empty. The front is the axis of the world nearest to the horizontal part of
/// the camera's direction, and the side is seen from the right of the front.
void look_from(const std::string& view, Scene& scene);

}  // namespace sheave::command
