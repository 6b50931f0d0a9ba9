#pragma once
// How long a frame of several contenders takes, measured side by side.
//
// Each repetition gives every contender one sample in turn, so that a machine which slows down for
// a while slows all of them down and not one: medians of samples that were taken minutes apart
// cannot be compared. A sample is as many whole runs from the start as fill `least_sample` seconds;
// putting the start back is not timed. The time is this thread's CPU time, which on a quiet machine
// is the wall time and on a busy one leaves out what others took.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/clock.h"
#include "measure/spread.h"

namespace sheave::measure {

/// Something that can be run again and again.
struct Contender {
  std::string name;
  std::function<void()> restart;  ///< back to the start; not timed
  std::function<bool()> frame;    ///< one frame further; false if the state means nothing any more
  std::int64_t frames = 1;        ///< of a run, >= 1
};

struct Timing {
  Spread seconds;                      ///< per frame [s]
  std::optional<double> instructions;  ///< per frame, median; nothing where they cannot be counted
  bool failed = false;                 ///< a frame failed: the times mean nothing
};

struct TimingOptions {
  int repetitions = 7;         ///< >= 1
  double least_sample = 0.02;  ///< [s]
  bool warm_up = true;         ///< whether each contender runs a while before its first sample
  /// Called before each sample with the samples done, their number and the contender's name; false
  /// ends the measurement.
  std::function<bool(std::int64_t done, std::int64_t of, const std::string& name)> observe;
  Clock clock;
};

/// One timing per contender, in their order; nothing at all if the observer ended it.
[[nodiscard]] std::vector<Timing> time_interleaved(const std::vector<Contender>& contenders,
                                                   const TimingOptions& options);

}  // namespace sheave::measure
