#pragma once

#include "engine/result.h"
#include "engine/vector.h"

namespace sheave {

struct Model;

/// The errors of a model's bodies, with paths "/bodies/i/...": names, mass and inertia, mobility
/// against axis, mount and velocities, unit quaternions, numbers out of range.
[[nodiscard]] Errors check_bodies(const Model& model);

/// Largest magnitude of each component of the gravity [m/s2]. Beyond it, squares of weights
/// overflow, and no result is a number.
inline constexpr double most_gravity = 1e100;

/// Whether each component of a gravity is a number up to that magnitude.
[[nodiscard]] bool is_good_gravity(const Vector3& gravity);

}  // namespace sheave
