#pragma once
// JSON pointers (RFC 6901): "/bodies/3/mass".

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sheave::json {

/// One step of a JSON pointer with "~0" and "~1" resolved, and the reverse.
[[nodiscard]] std::string unescape(std::string_view token);
[[nodiscard]] std::string escape(std::string_view key);
/// The steps of a JSON pointer; nothing if it does not begin with '/'. The empty pointer has no
/// steps.
[[nodiscard]] std::optional<std::vector<std::string>> split(std::string_view pointer);
/// The array index of a step; nothing if it is not an index (digits without leading zeros).
[[nodiscard]] std::optional<std::size_t> array_index(std::string_view token);

}  // namespace sheave::json
