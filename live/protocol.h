#pragma once
// The protocol by which programs in any language use a world: one JSON object per line in, one line
// out for each, and event lines, which begin with {"event":, in between. Documentation:
// docs/reference/live.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sheave::live {

/// Version of the protocol. The version changes when formerly valid requests or answers change; new
/// requests, keys and events do not change it.
enum class Protocol { v1 };
inline constexpr std::array<std::string_view, 1> protocol_names{"sheave-live/1"};

/// Limits of requests, which protect memory and ensure that every request ends.
struct Limits {
  std::size_t line_bytes = std::size_t{1} << 20U;  ///< of a request
  std::size_t depth = 16;                          ///< of nested arrays and objects
  std::size_t values = 200'000;                    ///< in a request
  std::size_t faults = 20;         ///< number of faults that an answer lists one by one
  std::int64_t steps = 1'000'000;  ///< steps of one request
  std::size_t parts = 1'000'000;   ///< bodies, joints, cables and their links, total
  std::size_t snapshots = 64;
  std::size_t snapshot_bytes = std::size_t{1} << 30U;  ///< of all snapshots together
  std::size_t subscriptions = 64;
};

/// JSON Schema (draft-07) of a request, from the tables with which requests are read.
[[nodiscard]] std::string protocol_schema();
/// JSON Schema (draft-07) of an output line. Its definitions are those of the answer to each
/// request (answer_definition()), "refusal", those of each event (event_definition()) and of their
/// members.
[[nodiscard]] std::string answer_schema();
[[nodiscard]] std::string answer_definition(std::string_view request);
[[nodiscard]] std::string event_definition(std::string_view event);
/// Reference of requests, controls, changes, answers and events with all their keys, in Markdown,
/// from the same tables.
[[nodiscard]] std::string protocol_reference();

/// The event with the number of lines that were dropped because the reader was too slow.
[[nodiscard]] std::string dropped_event(std::int64_t count);

}  // namespace sheave::live
