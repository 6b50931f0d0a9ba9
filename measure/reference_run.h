#pragma once
// A run of a scene that is taken for the truth, with an estimate of its own error.
//
// The direct solver leaves no constraint open and `rattle` is of second order, so what is left is
// the error of the step h. The scene is run with h, h/2, h/4, ... until the difference of the last
// two runs is small enough for the purpose. That difference is the estimate: with an order p the
// finer run's own error is the difference / (2^p - 1), which is a third of it for p = 2 and all of
// it for p = 1, so it errs on the safe side wherever halving the step helps by a factor of two at
// least. Where it does not (impacts, chaos) the estimate stays large and says so; the fitted order,
// log2 of the ratio of the last two differences, tells which it is.
//
// `rattle` does not suit every scene: where bodies hit each other, or vibrate faster than any step
// resolves, it keeps what nature would damp, and `xpbd`, which damps, converges sooner although its
// order is lower. So both are tried.

#include <functional>
#include <vector>

#include "measure/clock.h"
#include "measure/run_error.h"

namespace sheave::measure {

struct Reference {
  Trajectory trajectory;  ///< the finest run
  RunError estimate;      ///< of its error
  int substeps = 0;       ///< of its frames
  IntegratorKind integrator = IntegratorKind::rattle;
  /// Of the position error; NaN if only two runs were made or nothing is left of the error
  double order = 0.0;
  /// Of each frame the difference in position of the last two runs: how the estimate came about.
  /// Empty if one of them diverged.
  std::vector<double> differences{};
  bool good = false;  ///< whether the caller found it good enough before the limit
};

struct ReferenceOptions {
  int first_substeps = 2;  ///< of the coarsest run, >= 1
  int most_substeps = 64;  ///< of the finest
  IntegratorKind integrator = IntegratorKind::rattle;
  int rounds = 40;  ///< of the direct solver per substep, at most
  /// CPU time [s] after which no finer run is begun; one that would end later is not begun either.
  /// Two runs are always made.
  double most_seconds = 60.0;
  /// Whether the estimate is small enough; default: never, so that the limit decides.
  std::function<bool(const Reference&)> good_enough;
  /// Of every run. If it ends one, the runs before are the reference; of fewer than two there is
  /// none.
  FrameObserver observe;
  StopRequest stop;  ///< likewise, within steps
  Clock clock;
};

/// The finest run within the options. Errors are those of record(), and that the finest run
/// diverged.
[[nodiscard]] Result<Reference> reference_run(Scene scene, const ReferenceOptions& options);

/// That of `rattle`; if it is not good enough, that of `xpbd` if its estimate is smaller. The
/// option `integrator` is not used.
[[nodiscard]] Result<Reference> best_reference(const Scene& scene, ReferenceOptions options);

}  // namespace sheave::measure
