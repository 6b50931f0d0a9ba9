#include "python/bindings/thread_pool.h"

#include <system_error>

#include <unistd.h>

namespace sheave::python {

ThreadPool::ThreadPool(std::size_t threads) : process_(getpid()) {
  try {
    for (std::size_t i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // The system refuses further threads: the existing ones do all the work.
  }
}

bool ThreadPool::is_forked() const { return getpid() != process_; }

ThreadPool::~ThreadPool() {
  if (is_forked()) {  // a forked process has none of the pool's threads to wait for
    for (std::thread& worker : workers_) worker.detach();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    quits_ = true;
  }
  begins_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::take_turns(const std::function<bool()>& between) {
  for (;;) {
    const std::size_t index = next_.fetch_add(1, std::memory_order_relaxed);
    if (index >= count_) return;
    try {
      (*action_)(index);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
      next_.store(count_, std::memory_order_relaxed);
    }
    if (between && !between()) next_.store(count_, std::memory_order_relaxed);
  }
}

void ThreadPool::work() {
  std::size_t done = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      begins_.wait(lock, [&] { return quits_ || round_ != done; });
      if (quits_) return;
      done = round_;
    }
    take_turns({});
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) ends_.notify_one();
  }
}

void ThreadPool::for_each(std::size_t count, const std::function<void(std::size_t)>& action,
                          const std::function<bool()>& between) {
  {
    const std::lock_guard lock(mutex_);
    action_ = &action;
    count_ = count;
    next_.store(0, std::memory_order_relaxed);
    busy_ = is_forked() ? 0 : workers_.size();
    thrown_ = nullptr;
    ++round_;
  }
  begins_.notify_all();
  take_turns(between);
  std::unique_lock lock(mutex_);
  ends_.wait(lock, [&] { return busy_ == 0; });
  if (thrown_) std::rethrow_exception(thrown_);
}

}  // namespace sheave::python
