#pragma once
// A run of a scene that is taken for the truth, with an estimate of its own error.
//
// The direct solver leaves no constraint open and `rattle` is of second order, so what is left is the error of the step h.
// The scene is run with h, h/2, h/4, ... until the difference of the last two runs is small enough for the purpose. That
// difference is the estimate: with an order p the finer run's own error is the difference / (2^p - 1), which is a third of it
// for p = 2 and all of it for p = 1, so it errs on the safe side wherever halving the step helps by a factor of two at least.
// Where it does not (impacts, chaos) the estimate stays large and says so; the fitted order, log2 of the ratio of the last two
// differences, tells which it is.

#include <functional>

#include "measure/run_error.h"

namespace sheave::measure {

struct Reference {
  Trajectory trajectory;  ///< the finest run
  RunError estimate;      ///< of its error
  int substeps = 0;       ///< of its frames
  double order =
      0.0;  ///< of the position error; NaN if only two runs were made or nothing is left of the error
  bool good = false;  ///< whether the caller found it good enough before the limit
};

struct ReferenceOptions {
  int first_substeps = 2;  ///< of the coarsest run, >= 1
  int most_substeps = 64;  ///< of the finest
  IntegratorKind integrator = IntegratorKind::rattle;
  int rounds = 40;  ///< of the direct solver per substep, at most
  /// Whether the estimate is small enough; default: never, so that the limit decides.
  std::function<bool(const Reference&)> good_enough;
  FrameObserver observe;  ///< of every run
};

/// The best run within the options. Errors are those of record(); a run that diverges is skipped, and an error if it is the
/// finest.
[[nodiscard]] Result<Reference> reference_run(Scene scene, const ReferenceOptions& options);

}  // namespace sheave::measure
