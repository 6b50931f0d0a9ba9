#pragma once
// Motions of kinematic bodies from requests; internal to the engine and to supervisors.

#include "engine/control_requests.h"
#include "engine/controls.h"
#include "engine/state.h"

namespace sheave {

/// The motion of a kinematic body from `from` to a target, from `time` [s] on within `over` [s] > 0.
/// The target's own time is not used.
[[nodiscard]] MotionControl motion_to(const BodyState& from, const MotionTarget& target,
                                      double time, double over);

}  // namespace sheave
