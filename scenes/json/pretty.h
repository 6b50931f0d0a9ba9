#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace sheave::json {

/// JSON text for people: keys in the order of the value, numbers in the shortest form that reads
/// back exactly, and what fits on one line on one line, except that objects in a list get a line
/// each. Ends with a line break. Numbers that are not finite become null.
[[nodiscard]] std::string pretty(const nlohmann::ordered_json& value);

}  // namespace sheave::json
