#pragma once
// Keeps a world's time to the clock.

#include <chrono>
#include <optional>

namespace sheave::command {

class Pacer {
 public:
  /// `step`: how much a step adds to the world's time [s], > 0.
  explicit Pacer(double step) : step_(step) {}

  /// The world's seconds per second of the clock, > 0; nothing: as fast as it can.
  void set_pace(std::optional<double> pace);
  /// How long to wait until the step that ends at `time` is due [s]; 0: it is. Steps that are late
  /// by more than a quarter of a second, as after a break, are not made up for.
  [[nodiscard]] double until(double time);
  /// The next step is due a step after now, whatever was before.
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
