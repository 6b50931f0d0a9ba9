#pragma once
// Time up to which a reference can be trusted, and whether its error grows as that of a chaotic
// motion.
//
// Two runs of a chaotic scene that differ by rounding or by their step separate as e^(rate t).
// Halving the step gains only a little time; after that no run is right and none is wrong. In other
// scenes errors grow with a power of the time, t^2 for a slightly wrong acceleration. Both laws are
// fitted to the largest error so far, by least squares of its logarithm over t and over log t. The
// law with the better fit is chosen if it explains nine tenths of the variance. The jump of an
// impact fits neither.

#include <optional>
#include <span>

#include "measure/trajectory.h"

namespace sheave::measure {

struct ErrorGrowth {
  /// Number of frames, including that of time 0, up to which no error exceeds the level; all frames
  /// if none does.
  std::size_t trusted_frames = 0;
  /// [1/s] if errors grow exponentially, over at least 10 frames and a factor of 100 between
  /// rounding (1e-12) and complete loss of the positions (0.03); nothing otherwise.
  std::optional<double> rate;
};

/// `errors`: relative error of each frame (measure/run_error.h), beginning with time 0; `dt`: time
/// between frames [s].
[[nodiscard]] ErrorGrowth error_growth(std::span<const double> errors, double dt, double level);

/// The run up to a frame: its first `frames` frames, at least that of time 0. Counts and largest
/// values stay those of the whole run.
[[nodiscard]] Trajectory first_frames(const Trajectory& run, std::size_t frames);

}  // namespace sheave::measure
