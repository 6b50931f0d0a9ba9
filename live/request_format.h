#pragma once
// The formats of requests, for reading, for the schema and for the reference.

#include <span>
#include <string>

#include "scenes/format.h"

namespace sheave::live {

/// Any request: its types, and what all of them have.
[[nodiscard]] const ObjectFormat& any_request_format();
/// One per type, in the order of the registry, each with that variant alone and with its lists.
[[nodiscard]] std::span<const ObjectFormat> request_formats();

/// The part of the reference that tells what comes out.
[[nodiscard]] std::string answer_reference();

}  // namespace sheave::live
