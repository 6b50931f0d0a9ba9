#include "measure/reference_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sheave::measure {
namespace {

/// Events are located to this share of the tolerance (engine/step_size.h), which two runs that locate
/// one at the same place do not show.
constexpr double event_share = 0.25;

double order_of(double coarser, double finer) {
  if (coarser > 0.0 && finer > 0.0 && std::isfinite(coarser)) return std::log2(coarser / finer);
  return std::numeric_limits<double>::quiet_NaN();
}

/// The settings of the coarsest run.
void set_first(const ReferenceOptions& options, StepSettings& step) {
  step.solver = SolverKind::direct;
  step.iterations = options.rounds;
  step.tolerance = options.first_tolerance;
  step.integrator = options.integrator;
  if (step.tolerance > 0.0) {
    step.integrator = IntegratorKind::rattle;
  } else {
    step.substeps = options.first_substeps;
  }
}

/// Half the step; false if the options allow no finer run.
bool make_finer(const ReferenceOptions& options, StepSettings& step) {
  if (step.tolerance > 0.0) {
    step.tolerance *= 0.25;
    return step.tolerance >= options.least_tolerance;
  }
  if (step.substeps > options.most_substeps / 2) return false;
  step.substeps *= 2;
  return true;
}

}  // namespace

Result<Reference> reference_run(Scene scene, const ReferenceOptions& options) {
  StepSettings& step = scene.model.step;
  set_first(options, step);
  const double start = options.clock.cpu();
  Result<Trajectory> first = record(scene, options.observe, options.stop);
  if (!first) return first.errors();
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Reference reference{std::move(first).value(),
                      {unknown, unknown, unknown, unknown},
                      step.substeps,
                      step.integrator,
                      step.tolerance};
  double last = options.clock.cpu();
  double duration = last - start;  // CPU time of the last run [s]
  bool first_difference = true;
  while (!reference.good) {
    // Half the step takes twice the time.
    if (!first_difference && last - start + 2.0 * duration > options.most_seconds) break;
    if (!make_finer(options, step)) break;
    first_difference = false;
    Result<Trajectory> finer = record(scene, options.observe, options.stop);
    // Earlier runs remain valid if the observer ends a finer run.
    if (!finer && !reference.differences.empty()) break;
    if (!finer) return finer.errors();
    const double unseen = event_share * step.tolerance / finer->scale;
    RunError difference = error_of(reference.trajectory, *finer);
    difference.position = std::max(difference.position, unseen);
    reference.order = order_of(reference.estimate.position, difference.position);
    reference.estimate = difference;
    reference.differences.clear();
    if (std::isfinite(difference.position)) {
      reference.differences = position_errors(reference.trajectory, *finer);
      for (double& own : reference.differences) own = std::max(own, unseen);
    }
    reference.trajectory = std::move(finer).value();
    reference.substeps = step.substeps;
    reference.tolerance = step.tolerance;
    duration = options.clock.cpu() - last;
    last += duration;
    reference.good = options.good_enough && options.good_enough(reference);
  }
  if (!reference.trajectory.complete()) {
    return Error{"", "the reference diverged: " + reference.trajectory.divergence->message};
  }
  return reference;
}

Result<Reference> best_reference(const Scene& scene, ReferenceOptions options) {
  options.integrator = IntegratorKind::rattle;
  Result<Reference> second_order = reference_run(scene, options);
  if (second_order && second_order->good) return second_order;
  options.integrator = IntegratorKind::xpbd;
  Result<Reference> first_order = reference_run(scene, options);
  if (!first_order || !second_order) return first_order ? first_order : second_order;
  const bool better = first_order->estimate.position < second_order->estimate.position;
  return better ? first_order : second_order;
}

}  // namespace sheave::measure
