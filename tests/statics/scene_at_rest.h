#pragma once
// Scenes in a few lines for statics and modes.

#include <string>

#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"

namespace sheave::testing {

inline Simulation simulation_of(const Scene& scene) {
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) ADD_FAILURE() << simulation.errors().front().message;
  return std::move(*simulation);
}

/// The simulation of a scene whose bodies, joints and cables are these; with `gravity` 10 m/s2
/// downwards.
inline Simulation simulation_of(const std::string& parts,
                                const std::string& gravity = "[0,-10,0]") {
  const std::string text =
      R"({"format": "sheave-scene/1", "duration": 1, "gravity": )" + gravity + ", " + parts + "}";
  const SceneResult scene = load_scene_text(text, "test");
  for (const SceneError& error : scene.errors) ADD_FAILURE() << to_string(error);
  return simulation_of(*scene);
}

/// A scene of the project, by its path in scenes/.
inline Scene scene_file(const std::string& path) {
  SceneResult scene = load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/" + path);
  for (const SceneError& error : scene.errors) ADD_FAILURE() << to_string(error);
  return std::move(*scene.scene);
}

inline double tension(const Simulation& simulation, std::size_t cable, std::size_t span) {
  return simulation.cable_reports()[cable].spans[span].tension;
}

}  // namespace sheave::testing
