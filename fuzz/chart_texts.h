#pragma once
// Charts of every kind with hostile texts in every place that accepts a text.

#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"

namespace sheave::fuzz {

/// One chart each of a run, of sweeps (over one axis, a map, scatter plots), of a trade, of a
/// stress map and of a bench. The charts use the texts in turn.
[[nodiscard]] std::vector<command::GnuplotScript> charts_with(const std::vector<std::string>& texts,
                                                              command::ChartFormat format);

/// Parses a script by gnuplot's rules; shares no code with the writer. Throws a BrokenPromise
/// unless the script consists of drawing commands, numbers, and texts that gnuplot does not
/// interpret. The string `mark`, which all hostile texts contain, may occur only in the latter.
void require_harmless(const std::string& script, const std::string& mark);

}  // namespace sheave::fuzz
