#pragma once
// Charts are drawn by gnuplot, as a child process.

#include <string>

#include "command/output/gnuplot_script.h"

namespace sheave::command {

/// Draws a chart, which appears at `path` whole or not at all. gnuplot is told nothing but the
/// script: no name of a file, none of its start files, and no variable of the environment that
/// changes what it does. A Failure: 74 no gnuplot or no file, 130 if a signal came meanwhile.
void draw_with_gnuplot(const std::string& path, const GnuplotScript& script);

}  // namespace sheave::command
