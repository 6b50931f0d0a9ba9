#pragma once
// Whether anything puts energy into a machine, or takes any out, by its definition.

#include <string_view>
#include <vector>

#include "cable/cable.h"
#include "engine/model.h"

namespace sheave::certify {

/// Whether nothing but gravity and constant forces does work on the machine: no body moves by a
/// function of time, is driven or has a torque, no joint has a drive, no cable is fed.
[[nodiscard]] bool is_passive(const Model& model, const std::vector<CableDef>& cables);

/// Whether nothing takes energy out of the machine as long as no span that is slack comes taut: no
/// friction, no damping, no efficiency, nothing that touches, breaks or comes to a stop. Springs
/// and elastic cables count as if they took some, since of their vibration an integrator takes what
/// nobody sees.
[[nodiscard]] bool keeps_energy(const Model& model, const std::vector<CableDef>& cables);

/// Of the joint's settings whose names end so, the largest, or of `smallest` the smallest above 0; 0
/// if it has none above 0.
[[nodiscard]] double extreme_setting(const JointDef& joint, std::string_view suffix, bool smallest);

}  // namespace sheave::certify
