#pragma once
// One cell of a stability map: a scene with some of its numbers changed, and the command that runs
// the same.

#include <string>
#include <vector>

#include "scenes/generators.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// Where a scene comes from and what is changed in it, in the words of the command line, so that a
/// cell that fails can be run again by anybody.
struct StressCell {
  std::string kind;                        ///< of a generator; empty: `path` or `built_in`
  std::string path;                        ///< of a scene file
  std::string built_in;                    ///< name of a stress_scene()
  std::vector<GeneratorSetting> settings;  ///< of the generator
  std::vector<Override> overrides;         ///< of the scene
  double x = 0.0, y = 0.0;                 ///< the map's coordinates
  /// If set, the run must be similar to the one of the same scene without `overrides` but these:
  /// all lengths times `length_factor`, all masses times `mass_factor`, at the same times.
  std::vector<Override> similar_to;
  double length_factor = 1.0, mass_factor = 1.0;

  /// Adds an override.
  void replace(std::string pointer, std::string value);
  /// The scene, or why it is not valid.
  [[nodiscard]] SceneResult scene(SolverKind solver, IntegratorKind integrator) const;
  /// Of a cell with `similar_to`, the scene that it must be similar to.
  [[nodiscard]] SceneResult original(SolverKind solver, IntegratorKind integrator) const;
  /// "sheave generate ... | sheave run - --check ...", for a shell.
  [[nodiscard]] std::string command(SolverKind solver, IntegratorKind integrator) const;
};

/// A number as JSON, shortest so that it reads back exactly.
[[nodiscard]] std::string stress_number(double value);

}  // namespace sheave::measure
