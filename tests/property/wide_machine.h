#pragma once
// Random machines with more than cables: joints of all types and what acts along them, drives,
// posts and links with friction, contacts, bodies in the cables' way, several cables, in one plane
// and in space.

#include "tests/property/random_machine.h"

namespace sheave::test {

/// A machine that Simulation::create accepts: a random machine with cables, to which features were
/// added one by one, those that it refused left out. Step settings but for solver and integrator.
[[nodiscard]] Machine wide_machine(std::uint64_t seed);
/// The same of any numbers.
[[nodiscard]] Machine wide_machine(Random& random);

}  // namespace sheave::test
