#pragma once
// Stability maps: one machine over two numbers that are varied to their extremes.

#include <functional>
#include <string>
#include <vector>

#include "measure/stress_cell.h"

namespace sheave::measure {

struct StressAxis {
  std::string name;  ///< with its unit
  std::vector<double> values;
};

struct StressMap {
  std::string name;     ///< by which it is selected: letters and hyphens
  std::string meaning;  ///< one sentence: the machine, and its closed form
  StressAxis x, y;
  std::vector<StressCell> cells;  ///< row by row: x changes fastest

  /// A map whose cells `make` makes from their coordinates.
  [[nodiscard]] static StressMap over(
      std::string name, std::string meaning, StressAxis x, StressAxis y,
      const std::function<StressCell(double across, double down)>& make);
};

struct StressRange {
  /// Fewer values per axis and shorter runs, for a first look and for tests.
  bool quick = false;
};

/// Machines with closed forms: measure/stress_machines.cpp derives them.
[[nodiscard]] std::vector<StressMap> standard_stress_maps(const StressRange& range);

/// Maps of the built-in scenes (measure/stress_scenes.h), named "hand-gravity" and so on, with
/// fewer cells than those of a scene file.
[[nodiscard]] std::vector<StressMap> built_in_stress_maps(const StressRange& range);

/// Maps of any scene file with these overrides; measure/stress_scene.cpp explains the verdict.
/// Errors are those of reading the file.
[[nodiscard]] Result<std::vector<StressMap>> scene_stress_maps(
    const std::string& path, const StressRange& range, const std::vector<Override>& overrides = {});

}  // namespace sheave::measure
