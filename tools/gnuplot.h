#pragma once
// Charts, drawn by the program gnuplot.

#include <functional>
#include <string>

namespace sheave::tools {

/// In single quotes, as gnuplot takes text literally.
[[nodiscard]] std::string chart_quoted(const std::string& text);

/// The line that sets the terminal for a picture of that many pixels, .svg or .png.
[[nodiscard]] std::string chart_terminal(const std::string& output, int width, int height);

/// Runs the script that `script` makes for an output file; the picture appears at `path` whole or not at all. A Failure (74)
/// if that cannot be, or if there is no gnuplot.
void draw_with_gnuplot(const std::string& path,
                       const std::function<std::string(const std::string& output)>& script);

}  // namespace sheave::tools
