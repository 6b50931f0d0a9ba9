#pragma once
// Independent pieces of work over the cores.

#include <cstddef>
#include <functional>

namespace sheave::command {

/// Cores of the machine that this process may use, at least 1.
[[nodiscard]] int core_count();

/// Calls work(0), ..., work(count - 1), begun in this order, on as many threads, and poll() on this
/// thread about 20 times a second until all have ended. What a piece throws is thrown here when all
/// have ended; no further ones are begun then.
void run_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<void()>& poll);

}  // namespace sheave::command
