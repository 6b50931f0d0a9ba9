#pragma once
// Scenes of the paper, for tests that look deeper into them than their checks do.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenes/observables.h"
#include "scenes/scene.h"
#include "tests/support/builders.h"

namespace sheave::test {

/// The scene of this name in scenes/paper; throws if it does not load.
[[nodiscard]] inline Scene paper_scene(const std::string& name,
                                       const std::vector<Override>& overrides = {}) {
  const auto path =
      std::filesystem::path(SHEAVE_SOURCE_DIR) / "scenes" / "paper" / (name + ".json");
  SceneResult result = load_scene(path.string(), overrides);
  if (!result) throw std::runtime_error(to_string(result.errors.front()));
  return std::move(*result.scene);
}

/// A scene of the paper as it runs, step by step, with its quantities by name.
class PaperRun {
 public:
  explicit PaperRun(const std::string& name, const std::vector<Override>& settings = {})
      : scene_(paper_scene(name, settings)),
        simulation_(start(Machine{scene_.model, scene_.cables})),
        observables_(simulation_) {}

  /// Steps until `time` [s]; throws if the run diverges.
  void run(double time) { test::run(simulation_.world, time); }

  [[nodiscard]] double value(const std::string& name) const {
    const Result<int> index = observables_.index_of(name);
    if (!index) throw std::runtime_error(text(index.errors()));
    double result = 0.0;
    observables_.sample(simulation_, std::span(&*index, 1), std::span(&result, 1));
    return result;
  }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Simulation& simulation() const { return simulation_; }

 private:
  Scene scene_;
  Simulation simulation_;
  ObservableSet observables_;
};

}  // namespace sheave::test
