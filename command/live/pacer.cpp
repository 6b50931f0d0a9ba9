#include "command/live/pacer.h"

#include <algorithm>

namespace sheave::command {

void Pacer::set_pace(std::optional<double> pace) {
  if (pace != pace_) start_.reset();
  pace_ = pace;
}

double Pacer::until(double time) {
  if (!pace_) return 0.0;
  constexpr double most_late = 0.25;  // [s]
  const Clock::time_point now = Clock::now();
  const auto wait = [&] {
    const double passed = std::chrono::duration<double>(now - start_->clock).count();
    return (time - start_->time) / *pace_ - passed;
  };
  if (!start_) start_ = {now, time - step_};
  // The world may have been set to another state.
  if (wait() > 1.5 * step_ / *pace_) start_ = {now, time - step_};
  if (wait() < -most_late) start_ = {now, time};
  return std::max(wait(), 0.0);
}

}  // namespace sheave::command
