#pragma once
// Time per frame of several contenders, measured side by side.
//
// Each repetition takes one sample of every contender in turn, so a machine that slows down for a
// while slows all of them down; medians of samples taken minutes apart are not comparable. A sample
// consists of as many whole runs from the start as fill `least_sample` seconds; restarting is not
// timed. The time is this thread's CPU time, which equals the wall time on a quiet machine and
// excludes other load on a busy one.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/clock.h"
#include "measure/spread.h"

namespace sheave::measure {

/// A run that can be repeated.
struct Contender {
  std::string name;
  std::function<void()> restart;  ///< returns to the start; not timed
  std::function<bool()> frame;    ///< advances by one frame; false if the state is no longer valid
  std::int64_t frames = 1;        ///< number of frames of a run, >= 1
};

struct Timing {
  Spread seconds;                      ///< per frame [s]
  std::optional<double> instructions;  ///< median per frame; nothing if they cannot be counted
  bool failed = false;                 ///< a frame failed: the times are not valid
};

struct TimingOptions {
  int repetitions = 7;         ///< >= 1
  double least_sample = 0.02;  ///< [s]
  bool warm_up = true;         ///< whether each contender runs for a while before its first sample
  /// Called before each sample with the number of samples done, their total and the contender's
  /// name; false ends the measurement.
  std::function<bool(std::int64_t done, std::int64_t of, const std::string& name)> observe;
  Clock clock;
};

/// One timing per contender, in their order; empty if the observer ended the measurement.
[[nodiscard]] std::vector<Timing> time_interleaved(const std::vector<Contender>& contenders,
                                                   const TimingOptions& options);

}  // namespace sheave::measure
