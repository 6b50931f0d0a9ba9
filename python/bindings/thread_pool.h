#pragma once
// Threads that do the same for every index of a range, with the thread that asks for it.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sheave::python {

class ThreadPool {
 public:
  /// So many threads in all, >= 1, or as many as the system gives; the one that calls for_each() is
  /// one of them. In a process that has been forked from the pool's own it is the only one.
  explicit ThreadPool(std::size_t threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] std::size_t threads() const { return workers_.size() + 1; }
  /// Calls `action` once for each index below `count`, in any order. `between` is called by the
  /// asking thread between two of its own; once it says false no more are begun. What `action`
  /// throws ends it likewise, and is thrown once all threads have come to rest.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& action,
                const std::function<bool()>& between = {});

 private:
  void work();
  void take_turns(const std::function<bool()>& between);
  [[nodiscard]] bool is_forked() const;

  std::mutex mutex_;
  std::condition_variable begins_, ends_;
  std::size_t round_ = 0;  // counts the calls of for_each()
  std::size_t busy_ = 0;   // workers that have not finished the round
  bool quits_ = false;
  const std::function<void(std::size_t)>* action_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::exception_ptr thrown_;  // the first
  int process_;                // in which the workers are
  std::vector<std::thread> workers_;
};

}  // namespace sheave::python
