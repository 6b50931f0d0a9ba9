#pragma once
// Guess and history of the motion of a substep: engine/motion_history.h.

#include "engine/substep.h"

namespace sheave {

/// Moves the bodies from their free motion to the poses that the history of the last substeps
/// tells. False, without any motion, if the history tells nothing of a substep of this length.
[[nodiscard]] bool guess_motion(Substep& substep);

/// The history of a machine with the coordinates `before` for one with the coordinates `now`, whose
/// body i is body `origins[i]` of the first machine, or new (-1). New bodies begin without
/// acceleration by rows.
[[nodiscard]] MotionHistory adopted_history(const MotionHistory& history, const Coordinates& before,
                                            const Coordinates& now, std::span<const int> origins);

}  // namespace sheave
