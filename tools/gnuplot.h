#pragma once
// Charts are drawn by gnuplot, as a child process.

#include <functional>
#include <string>

namespace sheave::tools {

/// A Failure (2) if the name of a chart ends in none of .png, .svg, .pdf.
void check_chart_name(const std::string& path);

/// In single quotes, as gnuplot takes text literally.
[[nodiscard]] std::string gnuplot_quoted(const std::string& text);

/// The lines that choose a picture of 1000 x `height` pixels by the ending of `output`, and its
/// name.
[[nodiscard]] std::string gnuplot_terminal(const std::string& output, int height);

/// Runs the script that `script_for` makes for the name of an output file, which appears at `path`
/// whole or not at all. A Failure: 2 other ending, 74 no gnuplot or no file.
void draw_with_gnuplot(const std::string& path,
                       const std::function<std::string(const std::string& output)>& script_for);

}  // namespace sheave::tools
