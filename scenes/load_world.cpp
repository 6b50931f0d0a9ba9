#include "scenes/load_world.h"

#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "scenes/start_warnings.h"

namespace sheave {

Result<LiveWorld> load(const std::string& path) {
  const SceneResult scene = load_scene(path);
  if (scene) {
    Result<Simulation> simulation = create_simulation(*scene);
    if (!simulation) return simulation.errors();
    return LiveWorld::of(std::move(*simulation), start_warnings(*scene));
  }
  Errors errors;
  for (const SceneError& error : scene.errors) errors.push_back({error.pointer, to_string(error)});
  return errors;
}

}  // namespace sheave
