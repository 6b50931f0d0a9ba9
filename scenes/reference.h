#pragma once
// Reference documentation of formats, in Markdown.

#include <string>
#include <string_view>

#include "scenes/format.h"

namespace sheave {

/// Appends a section with a table of the keys of `format`, and one for each of its types. Formats
/// of scenes are told on the page `scene_page`; by default on the same one.
void append_reference(const ObjectFormat& format, std::string& text,
                      std::string_view scene_page = {});
/// What a link to a heading is: "body-settings".
[[nodiscard]] std::string anchor_of(std::string_view heading);
/// Whether the reference of scenes tells the format.
[[nodiscard]] bool is_in_scenes(const ObjectFormat& format);

}  // namespace sheave
