#pragma once
// Charts are drawn by gnuplot, as a child process.

#include <string>

#include "command/output/gnuplot_script.h"

namespace sheave::command {

/// Draws a chart. The file appears at `path` complete or not at all. gnuplot receives only the
/// script: no file name, no start files, and no environment variable that changes its behaviour. A
/// Failure: 74 no gnuplot or the file cannot be written, 130 if a signal came meanwhile.
void draw_with_gnuplot(const std::string& path, const GnuplotScript& script);

}  // namespace sheave::command
