#pragma once
// Energy of compliant contacts.

#include "engine/contacts/contact_finder.h"

namespace sheave {

/// Elastic energy [J] of the points that a state of the contact batch records.
[[nodiscard]] double energy_of_records(const ContactFinder& finder, const FeatureState& own);

/// Elastic energy [J] at the poses of a state without records. The points are those with which a
/// substep of the length `h` [s] would begin. 0 if bodies are crowded, because no substep begins
/// then (engine/contacts/crowd.h).
[[nodiscard]] double energy_of_overlaps(const ContactFinder& finder, const BodySet& bodies,
                                        const State& state, double h);

}  // namespace sheave
