#pragma once
// Where measurements read the time.
//
// What is measured is not always the same, so what is decided by it (how many runs, the cheapest
// setting, what is skipped) is not either. Tests hand in a clock of their own.

#include <functional>

namespace sheave::measure {

/// CPU time of this thread [s].
[[nodiscard]] double thread_time();
/// [s] since some moment; never goes back.
[[nodiscard]] double wall_time();

/// Both are called from several threads at once.
struct Clock {
  std::function<double()> cpu = thread_time;  ///< CPU time of the calling thread [s]
  std::function<double()> wall = wall_time;   ///< time that passes for everybody [s]
};

}  // namespace sheave::measure
