#pragma once
// The stages of a substep that move bodies; their order is decided in engine/step.cpp.

#include <memory>

#include "engine/constraint_batch.h"
#include "engine/substep.h"

namespace sheave {

/// Lets features stall drives that cannot go on; nothing where none of them does.
void limit_drives(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);
/// Places kinematic bodies where their functions of time put them at the end of the substep.
void move_kinematic_bodies(Substep& substep);
/// Moves all other bodies as gravity, their constant forces and their inertia would, with the
/// velocities that Substep::load_share of these forces gives them.
void predict(Substep& substep);
/// Velocities from what the substep did; poses of bodies that are not mounted.
void derive_velocities(Substep& substep);
/// Poses and velocities of mounted rotors, from their carriers and their own spin.
void place_mounted_rotors(Substep& substep);
/// The velocities of mounted rotors anew, from those of their carriers and the part of their own
/// about the axle.
void follow_carriers(Substep& substep);

// Of `rattle` alone; nothing in a substep that has been left to `xpbd`.

/// The angular velocities of bodies whose inertia turns with them, after the constraints have
/// chosen the pose.
void correct_gyroscopic_velocities(Substep& substep);
/// The second half of the loads' impulse, at the end of the substep.
void add_second_half_of_loads(Substep& substep);

}  // namespace sheave
