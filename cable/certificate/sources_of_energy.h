#pragma once
// Whether a machine's definition has sources or sinks of energy.

#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "engine/model.h"

namespace sheave::certify {

/// Whether only gravity and constant forces do work on the machine: no body moves by a function of
/// time, is driven or has a torque, no joint has a drive, no cable is fed.
[[nodiscard]] bool is_passive(const Model& model, const std::vector<CableDef>& cables);

/// Whether a coordinate of the joint has a drive.
[[nodiscard]] bool is_driven(const JointDef& joint);

/// Whether the machine dissipates no energy as long as no slack span becomes taut: no friction, no
/// damping, no efficiency, no contacts, breaks or stops. Springs and elastic cables count as
/// dissipative, because the integrator damps their vibration and the checks cannot measure that.
[[nodiscard]] bool keeps_energy(const Model& model, const std::vector<CableDef>& cables);

/// The largest setting above 0 of the joint whose name ends with `suffix`, or with `smallest` the
/// smallest; 0 if there is none.
[[nodiscard]] double extreme_setting(const JointDef& joint, std::string_view suffix, bool smallest);

}  // namespace sheave::certify
