#pragma once
// Observables of drums with a groove, in the order of groove_quantities (scenes/quantities.h).

#include <vector>

#include "cable/cable.h"
#include "cable/cable_report.h"

namespace sheave {

/// Indices of the links that are drums with a groove.
[[nodiscard]] std::vector<int> grooved_links(const CableReport& cable);
[[nodiscard]] std::vector<int> grooved_links(const CableDef& cable);

[[nodiscard]] double groove_quantity(const LinkReport& link, int quantity);

}  // namespace sheave
