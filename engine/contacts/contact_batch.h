#pragma once

#include <memory>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/contacts/contact_report.h"

namespace sheave {

struct Model;

/// Contacts between the colliders of a model. State: per point of contact 3 integers (its two
/// forms, whether friction holds it) and 20 reals (engine/contacts/contact_state.h); as many points
/// as there are. `place`: its index among the world's features.
[[nodiscard]] std::unique_ptr<ConstraintBatch> make_contact_batch(const Model& model,
                                                                  const BodySet& bodies,
                                                                  std::size_t place);

/// What a state of the batch for this model says.
[[nodiscard]] std::vector<ContactReport> report_contacts(const Model& model, const BodySet& bodies,
                                                         const FeatureState& state);

}  // namespace sheave
