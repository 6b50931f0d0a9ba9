#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace sheave::json {

/// Readable JSON text: keys in the order of the value, numbers in the shortest form that reads back
/// exactly. Containers that fit on one line are on one line, except that objects in a list get a
/// line each. Ends with a line break. Numbers that are not finite become null.
[[nodiscard]] std::string pretty(const nlohmann::ordered_json& value);

}  // namespace sheave::json
