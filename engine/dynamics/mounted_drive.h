#pragma once
// Drives of rotors that are mounted on other bodies: motors whose housing moves.

#include <memory>

#include "engine/constraint_batch.h"

namespace sheave {

class BodySet;

/// Name of the feature.
inline constexpr std::string_view mounted_drives_name = "mounted drives";

/// Whether any mounted rotor is driven.
[[nodiscard]] bool has_mounted_drives(const BodySet& bodies);
/// The drives of all mounted rotors that have one, in the order of the bodies. State: reals =
/// torque of each drive on its rotor about the axle in the last substep [N m]; the opposite torque
/// acts on the carrier.
[[nodiscard]] std::unique_ptr<ConstraintBatch> make_mounted_drives(const BodySet& bodies);

}  // namespace sheave
