#pragma once

#include <memory>

#include "engine/constraint_batch.h"
#include "engine/contacts/ground.h"

namespace sheave {

/// Contacts of all translating bodies that have a shape with a flat floor. The state's reals are
/// the contact forces per point [N] of the last substep, in the order of the bodies.
[[nodiscard]] std::unique_ptr<ConstraintBatch> make_ground_batch(const GroundDef& ground,
                                                                 const BodySet& bodies);

}  // namespace sheave
