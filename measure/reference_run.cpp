#include "measure/reference_run.h"

#include <cmath>
#include <limits>
#include <utility>

namespace sheave::measure {
namespace {

double order_of(double coarser, double finer) {
  if (coarser > 0.0 && finer > 0.0 && std::isfinite(coarser)) return std::log2(coarser / finer);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Result<Reference> reference_run(Scene scene, const ReferenceOptions& options) {
  StepSettings& step = scene.model.step;
  step.solver = SolverKind::direct;
  step.integrator = options.integrator;
  step.iterations = options.rounds;
  step.substeps = options.first_substeps;
  step.tolerance = 0.0;
  const double start = options.clock.cpu();
  Result<Trajectory> first = record(scene, options.observe, options.stop);
  if (!first) return first.errors();
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Reference reference{std::move(first).value(),
                      {unknown, unknown, unknown, unknown},
                      step.substeps,
                      options.integrator};
  double last = options.clock.cpu();
  double duration = last - start;  // CPU time of the last run [s]
  bool first_difference = true;
  while (!reference.good && step.substeps <= options.most_substeps / 2) {
    // Half the step takes twice the time.
    if (!first_difference && last - start + 2.0 * duration > options.most_seconds) break;
    first_difference = false;
    step.substeps *= 2;
    Result<Trajectory> finer = record(scene, options.observe, options.stop);
    // Earlier runs remain valid if the observer ends a finer run.
    if (!finer && !reference.differences.empty()) break;
    if (!finer) return finer.errors();
    const RunError difference = error_of(reference.trajectory, *finer);
    reference.order = order_of(reference.estimate.position, difference.position);
    reference.estimate = difference;
    reference.differences.clear();
    if (std::isfinite(difference.position)) {
      reference.differences = position_errors(reference.trajectory, *finer);
    }
    reference.trajectory = std::move(finer).value();
    reference.substeps = step.substeps;
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
