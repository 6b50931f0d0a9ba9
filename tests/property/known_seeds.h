#pragma once
// Machines that are known to break a property: tests/property/known/PROPERTY.json.

#include <cstdint>
#include <map>
#include <string>

namespace sheave::test {

/// The listed seeds of a property with the reason of each; none if the property has no list.
/// Throws if the list cannot be read.
[[nodiscard]] std::map<std::uint64_t, std::string> known_seeds(const std::string& property);

}  // namespace sheave::test
