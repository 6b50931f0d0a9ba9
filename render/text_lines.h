#pragma once
// A text broken into lines.

#include <string>
#include <string_view>
#include <vector>

namespace sheave::render {

/// Lines of at most `width` pixels in the built-in face at `pixels` from ascent to descent, broken
/// at spaces. A word that is longer has a line of its own. An empty text has no lines.
[[nodiscard]] std::vector<std::string> text_lines(std::string_view text, double pixels,
                                                  double width);

}  // namespace sheave::render
