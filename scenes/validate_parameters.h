#pragma once
// Faults of the parameters of a scene.

#include "engine/result.h"
#include "scenes/scene.h"

namespace sheave {

/// All faults, each with the JSON pointer of its setting. A name is a word that begins with a letter
/// and that expressions do not have: no function, not pi, not t. A unit is made of m, kg, s, rad, N,
/// J, W and Hz.
[[nodiscard]] Errors validate_parameters(const Scene& scene);

}  // namespace sheave
