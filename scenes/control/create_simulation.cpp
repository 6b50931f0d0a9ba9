// Simulations of scenes, at their start.

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "statics/start_at_rest.h"

namespace sheave {

Result<Simulation> create_simulation(const Scene& scene) {
  Result<Simulation> simulation = create_in_pose(scene);
  if (!simulation) return simulation;
  Errors errors;
  if (scene.start_state != nullptr) {
    errors = simulation->world.restore(*scene.start_state);
  } else if (scene.start == Start::rest) {
    errors = start_at_rest(*simulation);
  }
  if (errors.empty()) return simulation;
  for (Error& error : errors) error.path = "/start";
  return errors;
}

Result<Simulation> create_in_pose(const Scene& scene) {
  Result<Simulation> simulation = Simulation::create(scene.model, scene.cables);
  if (!simulation || (scene.controllers.empty() && scene.triggers.empty() && scene.loads.empty()))
    return simulation;
  Result<std::shared_ptr<const SceneSupervisor>> supervisor =
      SceneSupervisor::create(scene, *simulation);
  if (!supervisor) return supervisor.errors();
  simulation->world.memory() = (*supervisor)->initial_memory();
  simulation->set_supervisor(std::move(*supervisor));
  return simulation;
}

}  // namespace sheave
