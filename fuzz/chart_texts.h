#pragma once
// Charts of every kind with texts from outside in every place where they can have one.

#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"

namespace sheave::fuzz {

/// A chart of a run, of a sweep (over one axis, a map, clouds), of a trade, of a stress map and of
/// a bench, which take the texts in turn.
[[nodiscard]] std::vector<command::GnuplotScript> charts_with(const std::vector<std::string>& texts,
                                                              command::ChartFormat format);

/// Reads a script as gnuplot does, by rules that share no code with what writes them: throws a
/// BrokenPromise unless all of it is commands that only draw, numbers, and texts that gnuplot does
/// not interpret; `mark`, which texts from outside have in them, may stand in the latter only.
void require_harmless(const std::string& script, const std::string& mark);

}  // namespace sheave::fuzz
