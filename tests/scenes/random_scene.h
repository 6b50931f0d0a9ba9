#pragma once

#include <random>

#include "scenes/scene.h"

namespace sheave::test {

/// A valid scene with entities of every registered type and settings of every kind, as random as
/// validity allows. The same seed gives the same scene.
[[nodiscard]] Scene random_scene(unsigned seed);

}  // namespace sheave::test
