#pragma once
// Synchronises the simulated time with the clock.

#include <chrono>
#include <optional>

namespace sheave::command {

class Pacer {
 public:
  /// `step`: simulated time per step [s], > 0.
  explicit Pacer(double step) : step_(step) {}

  /// Simulated seconds per second of the clock, > 0; nullopt: as fast as possible.
  void set_pace(std::optional<double> pace);
  /// The time to wait until the step that ends at `time` is due [s]; 0 if it is due. A delay of
  /// more than 0.25 s, as after a pause, is not made up for.
  [[nodiscard]] double until(double time);
  /// Makes the next step due one step from now, independent of earlier steps.
  void restart() { start_.reset(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Start {
    Clock::time_point clock;
    double time;
  };

  double step_;
  std::optional<double> pace_;
  std::optional<Start> start_;
};

}  // namespace sheave::command
