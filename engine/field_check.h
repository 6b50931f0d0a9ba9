#pragma once

#include <string>

#include "engine/field.h"
#include "engine/number_text.h"
#include "engine/result.h"

namespace sheave {

/// Appends an error for each number in `object` that is outside the range of its field, and for each
/// enumeration without such a value, with the path `path`/<field>. Programs that fill structs in C++ get the same checks as scene files.
void check_fields(std::span<const Field> fields, const void* object, const std::string& path,
                  Errors& errors);

/// "> 0", "between 1 and 100000", ...
[[nodiscard]] std::string describe(const Range& range);

}  // namespace sheave
