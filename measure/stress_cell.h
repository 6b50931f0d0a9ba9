#pragma once
// One cell of a stability map: a scene with changed numbers, and the command that runs the same.

#include <string>
#include <vector>

#include "scenes/generators.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// Origin of a scene and its changes, in the form of the command line, so that a failing cell can
/// be reproduced.
struct StressCell {
  std::string kind;                        ///< of a generator; empty: see `path` or `built_in`
  std::string path;                        ///< of a scene file
  std::string built_in;                    ///< name of a stress_scene()
  std::vector<GeneratorSetting> settings;  ///< of the generator
  std::vector<Override> overrides;         ///< of the scene
  std::string load_state{};                ///< a file with the state in which runs start
  double x = 0.0, y = 0.0;                 ///< the map's coordinates
  /// If set, the run must be similar to that of the same scene with these overrides instead of
  /// `overrides`: all lengths times `length_factor`, all masses times `mass_factor`, at the same
  /// times.
  std::vector<Override> similar_to;
  double length_factor = 1.0, mass_factor = 1.0;

  /// Adds an override.
  void replace(std::string pointer, std::string value);
  /// The scene, or its faults.
  [[nodiscard]] SceneResult scene(SolverKind solver, IntegratorKind integrator) const;
  /// For a cell with `similar_to`: the scene to which it must be similar.
  [[nodiscard]] SceneResult original(SolverKind solver, IntegratorKind integrator) const;
  /// "sheave generate ... | sheave run - --check ...", for a shell.
  [[nodiscard]] std::string command(SolverKind solver, IntegratorKind integrator) const;
};

/// A number as JSON, in the shortest form that reads back exactly.
[[nodiscard]] std::string stress_number(double value);

}  // namespace sheave::measure
