#pragma once
// The protocol by which programs in any language hold a world: one JSON object per line goes in,
// one comes out for each, and lines that begin with {"event": in between. docs/live.md tells it to
// people.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sheave::live {

/// Version of the protocol. It changes when what was right before is not any more; requests, keys
/// and events may be added.
enum class Protocol { v1 };
inline constexpr std::array<std::string_view, 1> protocol_names{"sheave-live/1"};

/// Bounds on what is asked for. They protect memory and make sure that every request comes to an
/// end.
struct Limits {
  std::size_t line_bytes = std::size_t{1} << 20U;  ///< of a request
  std::size_t depth = 16;                          ///< of nested arrays and objects
  std::size_t values = 200'000;                    ///< in a request
  std::size_t faults = 20;                         ///< that an answer lists one by one
  std::int64_t steps = 1'000'000;                  ///< of one request
  std::size_t parts = 1'000'000;  ///< bodies, joints, cables and their links, all together
  std::size_t snapshots = 64;
  std::size_t snapshot_bytes = std::size_t{1} << 30U;  ///< of all snapshots together
  std::size_t subscriptions = 64;
};

/// JSON Schema (draft-07) of a request, from the tables that requests are read with.
[[nodiscard]] std::string protocol_schema();
/// JSON Schema (draft-07) of a line that comes out. Definitions are those of the answer to each
/// request (answer_definition()), "refusal", those of each event (event_definition()) and of what
/// is in them.
[[nodiscard]] std::string answer_schema();
[[nodiscard]] std::string answer_definition(std::string_view request);
[[nodiscard]] std::string event_definition(std::string_view event);
/// What requests, controls, changes, answers and events there are, with all their keys, in
/// Markdown, from the same tables.
[[nodiscard]] std::string protocol_reference();

/// The event that tells how many lines have been left out because nobody took them.
[[nodiscard]] std::string dropped_event(std::int64_t count);

}  // namespace sheave::live
