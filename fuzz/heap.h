#pragma once

#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::fuzz {

/// Bodies of all shapes and mobilities that lie on, lean against and fall onto each other, a floor
/// or a slope, some joined, some in a plane, with or without a cable; a machine that
/// Simulation::create accepts.
[[nodiscard]] test::Machine heap(test::Random& random);

}  // namespace sheave::fuzz
