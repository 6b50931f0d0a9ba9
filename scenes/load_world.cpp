#include "scenes/load_world.h"

#include "scenes/scene.h"

namespace sheave {

Result<LiveWorld> load(const std::string& path) {
  const SceneResult scene = load_scene(path);
  if (scene) return LiveWorld::create(scene->model, scene->cables);
  Errors errors;
  for (const SceneError& error : scene.errors) errors.push_back({error.pointer, to_string(error)});
  return errors;
}

}  // namespace sheave
