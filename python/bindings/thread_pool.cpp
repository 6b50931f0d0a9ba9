#include "python/bindings/thread_pool.h"

namespace sheave::python {

ThreadPool::ThreadPool(std::size_t threads) {
  for (std::size_t i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
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
    (*action_)(index);
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
    busy_ = workers_.size();
    ++round_;
  }
  begins_.notify_all();
  take_turns(between);
  std::unique_lock lock(mutex_);
  ends_.wait(lock, [&] { return busy_ == 0; });
}

}  // namespace sheave::python
