#pragma once
// A run of a scene that serves as reference, with an estimate of its own error.
//
// The direct solver leaves no residual and `rattle` is of second order, so only the error of the
// step h remains. The scene runs with h, h/2, h/4, ... until the difference of the last two runs,
// the estimate, is small enough. With an order p the error of the finer run is the
// difference / (2^p - 1), one third of it for p = 2 and all of it for p = 1, so the estimate is on
// the safe side if halving the step reduces the error by a factor of two or more. If it does not
// (impacts, chaos), the estimate stays large. The fitted order, log2 of the ratio of the last two
// differences, shows which case it is.
//
// `rattle` does not suit every scene. If bodies hit each other, or vibrate faster than any step
// resolves, it keeps vibrations that nature would damp. `xpbd` damps them and converges sooner
// although its order is lower. Therefore both are tried.
//
// Where something happens (a rope becomes taut, a body lands) the error of fixed steps is of first
// order. A reference with a tolerance (StepSettings::tolerance) locates the event: its runs have the
// tolerances t, t/4, t/16, ..., and the difference of the last two is again the estimate, three times
// the error of the finer one if that is proportional to the tolerance, but at least a quarter of the
// tolerance, to which events are located.

#include <functional>
#include <vector>

#include "measure/clock.h"
#include "measure/run_error.h"

namespace sheave::measure {

struct Reference {
  Trajectory trajectory;  ///< the finest run
  RunError estimate;      ///< estimated error of the finest run
  int substeps = 0;       ///< per frame, of the finest run
  IntegratorKind integrator = IntegratorKind::rattle;
  double tolerance = 0.0;  ///< of the finest run [m]; 0: fixed substeps
  /// Of the position error; NaN if only two runs were made or no error is left
  double order = 0.0;
  /// Per frame: difference in position of the last two runs, from which the estimate follows. Empty
  /// if one of them diverged.
  std::vector<double> differences{};
  bool good = false;  ///< whether the caller accepted it before the limit
};

struct ReferenceOptions {
  int first_substeps = 2;  ///< substeps of the coarsest run, >= 1
  int most_substeps = 64;  ///< substeps of the finest run
  /// Tolerance of the coarsest run [m]; 0: fixed substeps. Above 0 the numbers of substeps above are
  /// not used, and the integrator is `rattle`.
  double first_tolerance = 0.0;
  double least_tolerance = 0.0;  ///< of the finest run [m]
  IntegratorKind integrator = IntegratorKind::rattle;
  int rounds = 40;  ///< largest number of rounds of the direct solver per substep
  /// CPU time [s] after which no finer run is begun. A run that would end later is not begun
  /// either. Two runs are always made.
  double most_seconds = 60.0;
  /// Whether the estimate is small enough; default: never, so the limit decides.
  std::function<bool(const Reference&)> good_enough;
  /// Called for every run. If it ends one, the reference consists of the runs before; with fewer
  /// than two there is none.
  FrameObserver observe;
  StopRequest stop;  ///< the same, within steps
  Clock clock;
};

/// The finest run within the options. Errors are those of record(), or that the finest run
/// diverged.
[[nodiscard]] Result<Reference> reference_run(Scene scene, const ReferenceOptions& options);

/// The reference of `rattle`. If it is not good enough, that of `xpbd` if its estimate is smaller.
/// The option `integrator` is not used.
[[nodiscard]] Result<Reference> best_reference(const Scene& scene, ReferenceOptions options);

}  // namespace sheave::measure
