#pragma once
// Checks of states from files and programs.

#include <memory>
#include <span>
#include <string>

namespace sheave {

class BodySet;
class ConstraintBatch;
struct State;

/// A sentence about the first number of a state from which no world can continue: a number that is
/// not finite, a negative time, an orientation that is no unit quaternion, or an orientation of a
/// planar body or a rotor that no turn about its axis reaches. Empty if there is no such number.
/// Features are numbered from 0. The state must have as many bodies and features as the world.
[[nodiscard]] std::string state_fault(const State& state, const BodySet& bodies,
                                      std::span<const std::unique_ptr<ConstraintBatch>> features);

/// Lets the angles of planar bodies and rotors tell their orientations. A step computes these
/// orientations from the angles since time 0, so a state of a machine whose bodies had other
/// orientations at time 0 would jump. An angle that fits its orientation keeps its bits.
void fit_angles(const BodySet& bodies, State& state);

}  // namespace sheave
