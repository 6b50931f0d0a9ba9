#include "command/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include <sched.h>

namespace sheave::command {

int core_count() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool can_start_threads(int count) {
  std::mutex gate;
  std::vector<std::thread> trial;
  bool granted = true;
  {
    const std::lock_guard closed(gate);
    try {
      for (int i = 0; i < count; ++i) {
        trial.emplace_back([&gate] { const std::lock_guard passed(gate); });
      }
    } catch (const std::system_error&) {
      granted = false;
    }
  }
  for (std::thread& thread : trial) thread.join();
  return granted;
}

void run_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<void()>& poll) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // guards the next two variables
  std::condition_variable changed;
  std::exception_ptr failure;
  std::size_t ended = 0;
  const auto work_on = [&](const std::function<void()>& after_each) {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        work(i);
        after_each();
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    ++ended;
    changed.notify_one();
  };
  std::size_t workers = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
  std::vector<std::jthread> pool;
  try {
    while (pool.size() < workers) pool.emplace_back([&] { work_on([] {}); });
  } catch (const std::system_error&) {
    // The system refuses more threads (`ulimit -u`). Fewer suffice, and this one is there.
    workers = std::max<std::size_t>(pool.size(), 1);
    if (pool.empty()) work_on(poll);
  }
  constexpr std::chrono::milliseconds interval{50};
  std::unique_lock lock(mutex);
  while (!changed.wait_for(lock, interval, [&] { return ended == workers; })) {
    lock.unlock();
    poll();
    lock.lock();
  }
  lock.unlock();
  pool.clear();  // joins the threads
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sheave::command
