#pragma once
// The layout of a supervisor's memory in the state; internal to the supervisor.

#include <cstddef>

namespace sheave::memory_at {

// Indices in the memory.
inline constexpr std::size_t stopped = 0;
inline constexpr std::size_t refused = 1;
// Offsets in the memory of a trigger.
inline constexpr std::size_t acted = 0;
inline constexpr std::size_t holds = 1;
inline constexpr std::size_t trigger_size = 2;
// Offsets in the memory of a controller.
inline constexpr std::size_t is_on = 0;
inline constexpr std::size_t samples = 1;
inline constexpr std::size_t sampled_at = 2;
inline constexpr std::size_t controller_size = 3;

inline constexpr double never = -1.0;

}  // namespace sheave::memory_at
