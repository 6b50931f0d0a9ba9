#pragma once
// Knots whose ropes do not determine how they share the force; internal to the cable library.

#include <span>

#include "cable/knot_point.h"

namespace sheave {

/// Whether the rigid arms of a taut knot balance with other shares, too: four ropes that are taut in one
/// plane. Two subsets of the arms then have the same excess, and C has no gradient.
[[nodiscard]] bool has_other_shares(std::span<const KnotArm> arms, const KnotPlace& place);

}  // namespace sheave
