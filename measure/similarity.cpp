#include "measure/similarity.h"

#include <algorithm>

#include "measure/run_error.h"

namespace sheave::measure {
namespace {

/// The trajectory in the original's units.
void rescale(Trajectory& run, double length_factor, double force_factor) {
  run.scale /= length_factor;
  for (TrackedBody& body : run.bodies) body.reach /= length_factor;
  for (Frame& frame : run.frames) {
    for (BodyPose& pose : frame.poses) pose.position /= length_factor;
    for (double& tension : frame.tensions) tension /= force_factor;
  }
}

}  // namespace

Result<double> similarity_error(const Scene& scene, const Scene& original, double length_factor,
                                double mass_factor, const StopRequest& stop) {
  Result<Trajectory> run = record(scene, {}, stop);
  if (!run) return run.errors();
  Result<Trajectory> reference = record(original, {}, stop);
  if (!reference) return reference.errors();
  rescale(*run, length_factor, length_factor * mass_factor);
  const RunError error = error_of(*run, *reference);
  return std::max(error.position, error.tension);
}

}  // namespace sheave::measure
