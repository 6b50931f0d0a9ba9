#pragma once
// Clocks of measurements.
//
// Measured times vary, and so do decisions that depend on them (the number of runs, the cheapest
// setting, skipped runs). Tests therefore pass a clock of their own.

#include <functional>

namespace sheave::measure {

/// CPU time of this thread [s].
[[nodiscard]] double thread_time();
/// Time since a fixed moment [s]; never decreases.
[[nodiscard]] double wall_time();

/// Both functions may be called from several threads at once.
struct Clock {
  std::function<double()> cpu = thread_time;  ///< CPU time of the calling thread [s]
  std::function<double()> wall = wall_time;   ///< wall time [s]
};

}  // namespace sheave::measure
