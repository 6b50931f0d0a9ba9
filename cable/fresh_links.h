#pragma once
// Links that an edit has just inserted into a running cable; internal to the cable library.

#include <string>
#include <vector>

#include "cable/compiled_cable.h"
#include "cable/running_cable.h"

namespace sheave {

/// How long the way of a cable is over each of its listed links and behind it, as everything lies
/// now [m].
struct LinkWays {
  std::vector<double> arcs;
  std::vector<double> spans;  ///< of the last link of an open cable 0
};

/// Gives links that have just been inserted what lies on them, and shares what is left of the spans
/// before and behind them, each strained alike; why that cannot be. What is stored on all other
/// links stays. At an end of an open cable there must be none.
[[nodiscard]] std::string share_with_fresh_links(const CompiledCable& cable, const LinkWays& ways,
                                                 RunningCable& running);

}  // namespace sheave
