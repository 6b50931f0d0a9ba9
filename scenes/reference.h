#pragma once
// Reference documentation of formats, in Markdown.

#include <string>
#include <string_view>

#include "scenes/format.h"

namespace sheave {

/// Appends a section with a table of the keys of `format`, and one for each of its types. Formats
/// of scenes are on the page `scene_page`, by default on the same page.
void append_reference(const ObjectFormat& format, std::string& text,
                      std::string_view scene_page = {});
/// The anchor of a heading: "body-settings".
[[nodiscard]] std::string anchor_of(std::string_view heading);
/// Whether the reference of scenes contains the format.
[[nodiscard]] bool is_in_scenes(const ObjectFormat& format);

}  // namespace sheave
