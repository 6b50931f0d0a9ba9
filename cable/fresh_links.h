#pragma once
// Links that an edit has just inserted into a running cable; internal to the cable library.

#include <string>
#include <vector>

#include "cable/compiled_cable.h"
#include "cable/running_cable.h"

namespace sheave {

/// Length of the cable's path on each listed link and behind it, with the bodies as they are now
/// [m].
struct LinkWays {
  std::vector<double> arcs;
  std::vector<double> spans;  ///< 0 behind the last link of an open cable
};

/// Gives links that have just been inserted the cable that lies on them, and divides the rest of
/// the length between the spans before and behind them so that all have equal strain. Stored
/// lengths of other links stay. The end links of an open cable must not be new. Returns why this is
/// impossible; empty if it is done.
[[nodiscard]] std::string share_with_fresh_links(const CompiledCable& cable, const LinkWays& ways,
                                                 RunningCable& running);

}  // namespace sheave
