#pragma once
// Threads that call one function for every index of a range; the calling thread takes part.

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
  /// `threads` >= 1 threads in all, or as many as the system allows, including the one that calls
  /// for_each(). In a process forked from the pool's own the calling thread works alone.
  explicit ThreadPool(std::size_t threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] std::size_t threads() const { return workers_.size() + 1; }
  /// Calls `action` once for each index below `count`, in any order. The calling thread calls
  /// `between` after each of its own calls; once it returns false, no further call is begun. An
  /// exception from `action` ends the loop likewise, and is rethrown when all threads have
  /// finished.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& action,
                const std::function<bool()>& between = {});

 private:
  void work();
  void take_turns(const std::function<bool()>& between);
  [[nodiscard]] bool is_forked() const;

  std::mutex mutex_;
  std::condition_variable begins_, ends_;
  std::size_t round_ = 0;  // number of calls of for_each()
  std::size_t busy_ = 0;   // workers still in this round
  bool quits_ = false;
  const std::function<void(std::size_t)>* action_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::exception_ptr thrown_;  // the first exception
  int process_;                // process of the workers
  std::vector<std::thread> workers_;
};

}  // namespace sheave::python
