#pragma once
// The stages of a substep that move bodies; their order is decided in engine/step.cpp.

#include <memory>

#include "engine/constraint_batch.h"
#include "engine/substep.h"

namespace sheave {

/// Lets features reduce the shares of drives that cannot complete their motion.
void limit_drives(Substep& substep, std::span<const std::unique_ptr<ConstraintBatch>> features);
/// Places kinematic bodies where their functions of time put them at the end of the substep.
void move_kinematic_bodies(Substep& substep);
/// Moves all other bodies by gravity, constant forces and inertia, without constraints. The loads
/// contribute Substep::load_share of their impulse.
void predict(Substep& substep);
/// Derives velocities from the motion in the substep; writes the poses of bodies that are not
/// mounted.
void derive_velocities(Substep& substep);
/// Adds the motion that rows have caused to the history from which the next substep is guessed, if
/// a guess is of use.
void remember_motion(Substep& substep);
/// Poses and velocities of mounted rotors, from their carriers and their own spin.
void place_mounted_rotors(Substep& substep);
/// Updates the velocities of mounted rotors from those of their carriers; the part about the axle
/// is kept.
void follow_carriers(Substep& substep);

// The following stages belong to `rattle` and do nothing in a substep that is left to `xpbd`.

/// Corrects the angular velocities of bodies whose world-frame inertia turns, once the constraints
/// have determined the pose.
void correct_gyroscopic_velocities(Substep& substep);
/// Adds the second half of the loads' impulse, at the end of the substep.
void add_second_half_of_loads(Substep& substep);

}  // namespace sheave
