#pragma once
// Bounds from which the properties derive their limits.

#include "tests/property/random_machine.h"

namespace sheave::test {

/// How far any point of a body or cable [m] moves in the last substep, summed over the bodies: |v|
/// + a |w| with the arm a = 0.5 m, which no wheel, outline or attachment of a random machine
/// exceeds, times h; velocities are the larger ones of those before and after.
[[nodiscard]] double motion_bound(const World& world, const State& before);

/// Length of the shortest span [m], 0 if one has no tangent.
[[nodiscard]] double shortest_span(const Simulation& simulation);

/// The machine with every step one substep long.
[[nodiscard]] Machine with_single_substeps(Machine machine);

}  // namespace sheave::test
