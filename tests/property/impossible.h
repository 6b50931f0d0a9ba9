#pragma once
// Machines that say nothing about how well a machine moves.

#include "tests/property/random_machine.h"

namespace sheave::test {

/// Whether nothing could satisfy the machine, or its first step tells of where it begins and not of
/// how it moves: a rigid cable between bodies that move as they are told, two links of a cable at
/// one place, bodies with half of them beneath a floor.
[[nodiscard]] bool asks_the_impossible(const Machine& machine);

/// Whether it asks for the impossible as soon as what prescribes motion draws cable that is not
/// there: whether a rigid cable runs from where it is held to where it is held again by nothing but
/// bodies that move as they are told, or by one body alone, and something draws there. That is so
/// with the links that it touches at the start, or with those that it touches `now`, when it has
/// left a wheel that it has drawn straight.
[[nodiscard]] bool can_ask_the_impossible(const Machine& machine, const Simulation& now);

}  // namespace sheave::test
