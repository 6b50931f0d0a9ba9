#pragma once
// What a substep may cost, and whether the caller of World::step() still wants it.

#include <cstdint>
#include <functional>

namespace sheave {

/// Asked in the course of World::step() whether the step is to end early: true ends it. It must not
/// throw, nor touch the world that steps. It may look at a clock, a flag that a signal sets, a
/// button.
using StopRequest = std::function<bool()>;

/// Solvers ask it before every piece of work whose repetitions the size of the scene does not
/// bound.
class WorkLimit {
 public:
  /// Null: nobody asks for an early end. `stop` must outlive the step.
  void begin_step(const StopRequest* stop) {
    stop_ = stop;
    stopped_ = false;
  }
  /// From now on so many factorisations are allowed.
  void allow(std::int64_t factorisations) {
    left_ = factorisations;
    exhausted_ = false;
  }
  /// To be called before each factorisation; false if there must not be another one.
  [[nodiscard]] bool take_factorisation() {
    if (stops()) return false;
    exhausted_ = left_ == 0;
    if (!exhausted_) --left_;
    return !exhausted_;
  }
  /// Asks the caller, until the first yes.
  [[nodiscard]] bool stops() {
    if (stop_ != nullptr && !stopped_) stopped_ = (*stop_)();
    return stopped_;
  }
  /// Whether the caller has asked for an early end, as far as is known.
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// Whether a factorisation has been refused that would have been one too many.
  [[nodiscard]] bool exhausted() const { return exhausted_; }

 private:
  const StopRequest* stop_ = nullptr;
  bool stopped_ = false;
  bool exhausted_ = false;
  std::int64_t left_ = 0;
};

}  // namespace sheave
