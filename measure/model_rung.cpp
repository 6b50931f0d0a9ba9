#include "measure/model_rung.h"

#include <limits>

#include "measure/run_error.h"

namespace sheave::measure {
namespace {

Trajectory without_bodies(Trajectory run) {
  run.bodies.clear();
  for (Frame& frame : run.frames) frame.poses.clear();
  return run;
}

bool has_tensions(const Trajectory& run) {
  return !run.frames.empty() && !run.frames.front().tensions.empty();
}

}  // namespace

RungScene on_rung(const ModelRung& rung, const Scene& scene) {
  RungScene result{scene, 0, {}};
  result.scene.checks.clear();
  result.scene.camera.reset();
  result.scene.paint.clear();
  result.changed = rung.apply(result.scene);
  if (result.changed > 0) result.faults = validate_scene(result.scene);
  return result;
}

ModelDifference model_difference(const Trajectory& rung, const Trajectory& written) {
  const auto [own, other] = with_common_bodies(rung, written);
  const double position = error_of(own, other).position;
  if (!has_tensions(written)) return {position, std::numeric_limits<double>::quiet_NaN()};
  return {position, error_of(without_bodies(rung), without_bodies(written)).tension};
}

}  // namespace sheave::measure
