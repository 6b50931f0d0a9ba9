#pragma once
// The work that a substep may take, and the caller's request to stop the step.

#include <cstdint>
#include <functional>

namespace sheave {

/// Returns true to end the step that is running. World::step() calls it repeatedly. The function
/// must neither throw nor touch the world that steps, but may read a clock, a flag that a signal
/// sets, or a button.
using StopRequest = std::function<bool()>;

/// Solvers call it before each piece of work whose number of repetitions is not bounded by the size
/// of the scene.
class WorkLimit {
 public:
  /// Null: the step cannot be stopped. `stop` must outlive the step.
  void begin_step(const StopRequest* stop) {
    stop_ = stop;
    stopped_ = false;
  }
  /// Allows so many factorisations from now on.
  void allow(std::int64_t factorisations) {
    left_ = factorisations;
    exhausted_ = false;
  }
  /// Must be called before each factorisation; false forbids it.
  [[nodiscard]] bool take_factorisation() {
    if (stops()) return false;
    exhausted_ = left_ == 0;
    if (!exhausted_) --left_;
    return !exhausted_;
  }
  /// Whether the step is to stop. Calls the caller's request until it has returned true.
  [[nodiscard]] bool stops() {
    if (stop_ != nullptr && !stopped_) stopped_ = (*stop_)();
    return stopped_;
  }
  /// Whether the request has returned true.
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// Whether a factorisation has been refused because of allow().
  [[nodiscard]] bool exhausted() const { return exhausted_; }

 private:
  const StopRequest* stop_ = nullptr;
  bool stopped_ = false;
  bool exhausted_ = false;
  std::int64_t left_ = 0;
};

}  // namespace sheave
