#pragma once
// Random machines with a cable: what the property tests run on. A seed says everything.

#include <cstdint>
#include <string>

#include "tests/support/builders.h"
#include "tests/support/random.h"

namespace sheave::test {

/// What a random machine may contain.
struct Traits {
  bool elastic = true;
  bool friction = true;   ///< pinholes and wheels over which the cable slips
  bool kinematic = true;  ///< bodies that oscillate or turn, whatever pulls at them
  bool mounted = true;    ///< rotors mounted on moving bodies
  bool massless = true;
  bool outlines = true;
  bool skew = true;  ///< cable planes that differ, and bodies that leave theirs
  bool lifted = true;
  bool changing_ends = true;  ///< hybrid ends and drums
  bool layers = true;         ///< of cable on drums
  bool free_bodies = true;
  bool frozen = true;    ///< tangent_update substep
  bool at_rest = false;  ///< no velocities at time 0
  double spacing = 0.9;  ///< least distance of neighbouring links [m]; the largest wheel has 0.3 m
  double slack = 0.3;    ///< chance of a cable that begins slack
  double longest = 1.0 / 300.0;  ///< substep [s]
};

/// A machine that Simulation::create accepts.
struct RandomMachine {
  Machine machine;
  int refused = 0;            ///< draws that were not accepted before it
  std::string first_refusal;  ///< what was wrong with the first of them
};

[[nodiscard]] RandomMachine random_machine(std::uint64_t seed, const Traits& traits = {});
/// The same of any numbers; solver and integrator are left as they are by default.
[[nodiscard]] RandomMachine random_machine(Random& random, const Traits& traits = {});

/// Chooses solver and integrator: any of the four pairs, equally often. Its draw is its own, so a
/// seed's machine is the same whatever there is to choose from.
void choose_method(std::uint64_t seed, StepSettings& step);

/// A machine in a few lines: bodies by mobility, and the links of the cables.
[[nodiscard]] std::string describe(const Machine& machine);

}  // namespace sheave::test
