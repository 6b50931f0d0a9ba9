#pragma once

#include <memory>

#include "engine/constraint_batch.h"
#include "engine/contacts/ground.h"

namespace sheave {

/// Contacts of all translating bodies that have a shape with a flat floor. State: reals = contact
/// force per point [N], in the order of the bodies, of the last substep.
[[nodiscard]] std::unique_ptr<ConstraintBatch> make_ground_batch(const GroundDef& ground,
                                                                 const BodySet& bodies);

}  // namespace sheave
