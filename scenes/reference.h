#pragma once
// Reference documentation of formats, in Markdown.

#include <string>

#include "scenes/format.h"

namespace sheave {

/// Appends a section with a table of the keys of `format`, and one for each of its types.
void append_reference(const ObjectFormat& format, std::string& text);

}  // namespace sheave
