#pragma once
// JSON Schema (draft-07) of formats.

#include <nlohmann/json.hpp>

#include "scenes/format.h"

namespace sheave {

/// The schema of an object of `format`; what its members hold is told by references to
/// "#/definitions/<name of their format, with hyphens for spaces>".
[[nodiscard]] nlohmann::ordered_json format_schema(const ObjectFormat& format);
/// Adds the schemas of the formats that members of `format` hold, and of theirs, that are not there
/// yet.
void add_definitions(const ObjectFormat& format, nlohmann::ordered_json& definitions);

}  // namespace sheave
