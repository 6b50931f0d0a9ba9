#pragma once
// How the spans of a slack run share their spare length; internal to the cable library.

#include <vector>

namespace sheave {

/// Spans with a negative entry of `spare` take the missing length from the nearest spans with a
/// positive entry. Two equally near spans give equal amounts as far as they can, so a mirrored
/// cable gives the mirrored result.
void pull_slack(std::vector<double>& spare);

}  // namespace sheave
