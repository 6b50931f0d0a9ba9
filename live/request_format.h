#pragma once
// The formats of requests, for reader, schema and reference.

#include <span>
#include <string>

#include "scenes/format.h"

namespace sheave::live {

/// Any request: its types, and their common keys.
[[nodiscard]] const ObjectFormat& any_request_format();
/// One format per type, in the order of the registry, with that variant only and its lists.
[[nodiscard]] std::span<const ObjectFormat> request_formats();

/// The part of the reference about the output.
[[nodiscard]] std::string answer_reference();

}  // namespace sheave::live
