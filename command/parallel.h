#pragma once
// Runs independent pieces of work on several cores.

#include <cstddef>
#include <functional>

namespace sheave::command {

/// Number of cores that this process may use, at least 1.
[[nodiscard]] int core_count();

/// Whether the system grants so many threads at once now.
[[nodiscard]] bool can_start_threads(int count);

/// Calls work(0), ..., work(count - 1) on as many threads, started in this order, and poll() on
/// this thread about 20 times a second until all calls have ended. If the system refuses threads,
/// fewer do the work; without any, this thread does, and calls poll() after each call. After an exception no further
/// call is started, and the exception is rethrown here when all running calls have ended.
void run_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<void()>& poll);

}  // namespace sheave::command
