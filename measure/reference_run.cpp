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
  Result<Trajectory> first = record(scene, options.observe);
  if (!first) return first.errors();
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Reference reference{
      std::move(first).value(), {unknown, unknown, unknown, unknown}, step.substeps};
  while (!reference.good && step.substeps <= options.most_substeps / 2) {
    step.substeps *= 2;
    Result<Trajectory> finer = record(scene, options.observe);
    if (!finer) return finer.errors();
    const RunError difference = error_of(reference.trajectory, *finer);
    reference.order = order_of(reference.estimate.position, difference.position);
    reference.estimate = difference;
    reference.trajectory = std::move(finer).value();
    reference.substeps = step.substeps;
    reference.good = options.good_enough && options.good_enough(reference);
  }
  if (!reference.trajectory.complete()) {
    return Error{"", "the reference diverged: " + reference.trajectory.divergence->message};
  }
  return reference;
}

}  // namespace sheave::measure
