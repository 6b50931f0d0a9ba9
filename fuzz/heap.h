#pragma once

#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::fuzz {

/// A heap of bodies of all shapes and mobilities that lie on, lean against and fall onto each
/// other, a floor or a slope. Some are joined, some are planar, and there may be a cable.
/// Simulation::create accepts the machine.
[[nodiscard]] test::Machine heap(test::Random& random);

}  // namespace sheave::fuzz
