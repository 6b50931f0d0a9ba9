#pragma once

#include <memory>
#include <vector>

#include "engine/constraint_batch.h"
#include "engine/contacts/contact_report.h"

namespace sheave {

struct Model;

/// Contacts between the colliders of a model. The state has, per point of contact, 3 integers (its
/// two forms, whether it sticks) and 20 reals (engine/contacts/contact_state.h). The number of
/// points varies. `place` is the batch's index among the world's features.
[[nodiscard]] std::unique_ptr<ConstraintBatch> make_contact_batch(const Model& model,
                                                                  const BodySet& bodies,
                                                                  std::size_t place);

/// The points of contact in a state of the batch for this model.
[[nodiscard]] std::vector<ContactReport> report_contacts(const Model& model, const BodySet& bodies,
                                                         const FeatureState& state);

}  // namespace sheave
