#pragma once
// The least rotation between two directions. Eigen's template of it contains a singular value
// decomposition and takes seconds to compile, so that it is compiled once.

#include "engine/vector.h"

namespace sheave {

/// The rotation by the least angle that turns the direction `from` to the direction `to`, both of
/// any length above 0. For opposite directions some rotation by half a turn.
[[nodiscard]] Quaternion turn_between(const Vector3& from, const Vector3& to);

}  // namespace sheave
