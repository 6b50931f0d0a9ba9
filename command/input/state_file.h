#pragma once
// States in files in which simulations start.

#include <memory>
#include <string>

#include "scenes/scene.h"

namespace sheave::command {

/// The bytes of such a file.
[[nodiscard]] std::string read_state_bytes(const std::string& path);

/// The state of a file that saved_state() (scenes/saved_state.h) has written, for
/// Scene::start_state. Prints warnings about a state without a checksum or of another scene if
/// `warns`. Throws a Failure: 66 if there is no such file, 74 if it cannot be read, 65 if it is no
/// state, has been changed, or belongs to another machine or another step size (time is counted in
/// steps).
[[nodiscard]] std::shared_ptr<const State> read_state(const Scene& scene, const std::string& path,
                                                      bool warns = true);

}  // namespace sheave::command
