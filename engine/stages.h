#pragma once
// The stages of a substep that move bodies; their order is decided in engine/step.cpp.

#include "engine/substep.h"

namespace sheave {

/// Places kinematic bodies where their functions of time put them at the end of the substep.
void move_kinematic_bodies(Substep& substep);
/// Moves all other bodies as gravity, their constant forces and their inertia would.
void predict(Substep& substep);
/// Velocities from what the substep did; poses of bodies that are not mounted.
void derive_velocities(Substep& substep);
/// Poses and velocities of mounted rotors, from their carriers and their own spin.
void place_mounted_rotors(Substep& substep);

}  // namespace sheave
