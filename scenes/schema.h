#pragma once
// JSON Schema (draft-07) of formats.

#include <nlohmann/json.hpp>

#include "scenes/format.h"

namespace sheave {

/// The schema of an object of `format`. Its members refer to "#/definitions/<name of their format,
/// with hyphens for spaces>".
[[nodiscard]] nlohmann::ordered_json format_schema(const ObjectFormat& format);
/// Adds the schemas of the formats in the members of `format`, recursively, that are not in
/// `definitions` yet.
void add_definitions(const ObjectFormat& format, nlohmann::ordered_json& definitions);

}  // namespace sheave
