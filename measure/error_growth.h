#pragma once
// How long a reference can be trusted, and whether its error grows as that of a chaotic motion
// does.
//
// Two runs of a chaotic scene that differ by rounding or by their step part as e^(rate t): halving
// the step buys a moment and no more, and after that no run is right and none is wrong. Elsewhere
// errors grow with a power of the time, t^2 for an acceleration that is a little wrong. Both laws
// are fitted to the largest error so far, by least squares of its logarithm over t and over log t;
// the one that fits better, if it explains nine tenths of the variance, tells which it is. The leap
// of an impact is neither.

#include <optional>
#include <span>

#include "measure/trajectory.h"

namespace sheave::measure {

struct ErrorGrowth {
  /// Frames, that of time 0 included, up to which no error exceeds the level; all of them if none
  /// does.
  std::size_t trusted_frames = 0;
  /// [1/s] if errors grow exponentially, over at least 10 frames and a factor of 100 between
  /// rounding (1e-12) and where bodies are anywhere (0.03); nothing otherwise.
  std::optional<double> rate;
};

/// `errors`: of each frame, relative (measure/run_error.h), the first of time 0; `dt`: time between
/// frames [s].
[[nodiscard]] ErrorGrowth error_growth(std::span<const double> errors, double dt, double level);

/// The run up to a frame: `frames` of them, at least that of time 0. Counts and largest values stay
/// those of the whole run.
[[nodiscard]] Trajectory first_frames(const Trajectory& run, std::size_t frames);

}  // namespace sheave::measure
