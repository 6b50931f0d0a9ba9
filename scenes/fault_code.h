#pragma once
// Codes of the faults that `sheave validate --json` reports. A code never changes its meaning; new
// codes may be added.

#include <cstdint>
#include <span>
#include <string_view>

namespace sheave {

/// The kind of a fault of a scene.
enum class FaultCode : std::uint8_t {
  not_found,
  unreadable,
  too_large,
  encoding,
  syntax,
  number_range,
  duplicate_key,
  unknown_key,
  missing_key,
  exclusive_keys,
  wrong_type,
  out_of_range,
  unknown_choice,
  unknown_body,
  bad_name,
  duplicate_name,
  bad_pointer,
  meaning,
};

/// A line of the table of codes.
struct CodeEntry {
  std::string_view code;
  std::string_view severity;  ///< "error": the scene cannot be run; "warning"
  std::string_view meaning;
};
/// All codes; those of faults first, in the order of FaultCode.
[[nodiscard]] std::span<const CodeEntry> code_table();
[[nodiscard]] std::string_view code_name(FaultCode code);

}  // namespace sheave
