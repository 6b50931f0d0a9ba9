#pragma once
// Threads that do the same for every index of a range, with the thread that asks for it.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sheave::python {

class ThreadPool {
 public:
  /// So many threads in all, >= 1; the one that calls for_each() is one of them.
  explicit ThreadPool(std::size_t threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] std::size_t threads() const { return workers_.size() + 1; }
  /// Calls `action` once for each index below `count`, in any order; must not throw. `between` is
  /// called by the asking thread between two of its own; once it says false no more are begun.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& action,
                const std::function<bool()>& between = {});

 private:
  void work();
  void take_turns(const std::function<bool()>& between);

  std::mutex mutex_;
  std::condition_variable begins_, ends_;
  std::size_t round_ = 0;  // counts the calls of for_each()
  std::size_t busy_ = 0;   // workers that have not finished the round
  bool quits_ = false;
  const std::function<void(std::size_t)>* action_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::vector<std::thread> workers_;
};

}  // namespace sheave::python
