#pragma once

#include "engine/result.h"

namespace sheave {

struct Model;

/// The errors of a model's bodies, with paths "/bodies/i/...": names, mass and inertia, mobility
/// against axis, mount and velocities, unit quaternions, numbers out of range.
[[nodiscard]] Errors check_bodies(const Model& model);

}  // namespace sheave
