// Stability maps of any scene. No closed form says how a scene answers to these changes.
//
// gravity     Gravity times a factor, also zero and reversed. The judge looks for faults that are
//             faults in any machine (divergence, gain of energy, lost length), and for rigid cables
//             that are longer than the tolerance allows.
// mass,       All masses or all lengths times a factor, with every quantity that scales with them.
// length      Such a run is similar to the original (scenes/scaling.h), so its error is known.
// random      Every mass, force, stiffness and damping times a random factor of its own, up to a
//             given number of decades either way. Each row is another draw, judged like gravity.
//
// The scene's own step is one of the steps tried; it runs for its whole duration if that takes at
// most 2000 steps. The other runs are short, because a failure shows early or grows.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "measure/stress_map.h"
#include "measure/stress_scenes.h"
#include "scenes/import/import.h"
#include "scenes/jsonnet/evaluate.h"
#include "scenes/scaling.h"

namespace sheave::measure {
namespace {

/// Number of cells, and the length of their runs.
struct Extent {
  std::vector<double> gravities, steps, factors, decades;
  int draws = 0;
  double most_steps = 0.0;
  double most_own_steps = 0.0;  // with the scene's own step; 0: that step is not tried
};

const Extent quick_extent{
    {0.0, -1.0, 100.0}, {1.0 / 60.0, 0.1}, {1e-6, 1e6}, {1.0, 6.0}, 2, 30.0, 300.0};
const Extent full_extent{{0.0, -1.0, 1e-3, 0.1, 1.0, 10.0, 100.0, 1e3, 1e6},
                         {1e-4, 1e-3, 1e-2, 1.0 / 60.0, 1.0 / 30.0, 0.1},
                         {1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6},
                         {0.1, 0.5, 1.0, 2.0, 3.0, 6.0, 9.0},
                         10,
                         200.0,
                         2000.0};
/// For scenes that take milliseconds per step.
const Extent built_in_extent{{0.0, -1.0, 0.1, 1.0, 10.0, 100.0, 1e6},
                             {1e-3, 1.0 / 60.0, 1.0 / 30.0},
                             {1e-6, 1e-3, 1e3, 1e6},
                             {0.1, 1.0, 3.0, 9.0},
                             3,
                             60.0,
                             0.0};

const Extent quick_built_in_extent{
    {0.0, -1.0, 100.0}, {1.0 / 60.0, 0.1}, {1e-6, 1e6}, {1.0, 6.0}, 2, 30.0, 0.0};

/// Makes the cells of one scene.
class SceneMaps {
 public:
  /// `origin` is a cell with the overrides of all cells.
  SceneMaps(StressCell origin, const Scene& scene, std::vector<ScalableSetting> settings,
            const Extent& extent)
      : origin_(std::move(origin)),
        gravity_(scene.model.gravity),
        duration_(scene.duration),
        dt_(scene.model.step.dt),
        settings_(std::move(settings)),
        extent_(extent) {}

  [[nodiscard]] StressMap gravity() const {
    StressAxis factors{"gravity / that of the scene", extent_.gravities};
    return StressMap::over("gravity", "Gravity times a factor.", std::move(factors), steps(),
                           [&](double factor, double dt) {
                             StressCell cell = shortened(dt);
                             const Vector3 scaled_gravity = factor * gravity_;
                             cell.replace("/gravity", "[" + stress_number(scaled_gravity.x()) +
                                                          ", " + stress_number(scaled_gravity.y()) +
                                                          ", " + stress_number(scaled_gravity.z()) +
                                                          "]");
                             return cell;
                           });
  }
  [[nodiscard]] StressMap mass() const {
    return StressMap::over("mass", "All masses times a factor, and all forces with them.",
                           {"mass factor", extent_.factors}, steps(),
                           [&](double factor, double dt) { return similar(dt, 1.0, factor); });
  }
  [[nodiscard]] StressMap length() const {
    return StressMap::over("length",
                           "All lengths times a factor, and gravity and forces with them.",
                           {"length factor", extent_.factors}, steps(),
                           [&](double factor, double dt) { return similar(dt, factor, 1.0); });
  }
  [[nodiscard]] StressMap random() const {
    StressAxis seeds{"seed", {}};
    for (int i = 1; i <= extent_.draws; ++i) seeds.values.push_back(i);
    StressAxis decades{"decades", extent_.decades};
    return StressMap::over(
        "random", "Masses, forces, stiffnesses and damping times random factors.",
        std::move(decades), std::move(seeds), [&](double most, double seed) {
          StressCell cell = shortened(extent_.most_own_steps > 0.0 ? dt_ : 1.0 / 60.0);
          std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
          for (const ScalableSetting& setting : settings_) {
            if (setting.powers.mass == 0) continue;
            // The distributions of the standard library differ between implementations.
            const double share = static_cast<double>(generator() >> 11U) / 0x1p53;
            cell.overrides.push_back(scaled(setting, std::pow(10.0, most * (2.0 * share - 1.0))));
          }
          return cell;
        });
  }
  [[nodiscard]] std::vector<StressMap> all() const {
    return {gravity(), mass(), length(), random()};
  }

 private:
  [[nodiscard]] bool is_own(double dt) const { return std::abs(dt - dt_) < 1e-9 * dt_; }

  /// The step lengths, including the scene's own step.
  [[nodiscard]] StressAxis steps() const {
    std::vector<double> all = extent_.steps;
    const auto own = [&](double dt) { return is_own(dt); };
    if (extent_.most_own_steps > 0.0 && std::none_of(all.begin(), all.end(), own)) {
      all.push_back(dt_);
    }
    std::sort(all.begin(), all.end());
    return {"step [s]", std::move(all)};
  }

  /// The scene with this step, for 10 to 200 steps, without its checks; with its own step for its
  /// own duration, if that is not much longer.
  [[nodiscard]] StressCell shortened(double dt) const {
    StressCell cell = origin_;
    const bool whole = is_own(dt) && extent_.most_own_steps > 0.0;
    const double most = whole ? extent_.most_own_steps : extent_.most_steps;
    const double steps = std::clamp(std::round(duration_ / dt), 10.0, most);
    cell.replace("/step/dt", stress_number(dt));
    cell.replace("/duration", stress_number(steps * dt));
    cell.replace("/checks", "[]");
    return cell;
  }
  [[nodiscard]] StressCell similar(double dt, double length_factor, double mass_factor) const {
    StressCell cell = shortened(dt);
    cell.similar_to = cell.overrides;
    cell.length_factor = length_factor;
    cell.mass_factor = mass_factor;
    for (Override& change : similar_scene(settings_, length_factor, mass_factor)) {
      cell.overrides.push_back(std::move(change));
    }
    return cell;
  }

  StressCell origin_;
  Vector3 gravity_;
  double duration_;
  double dt_;
  std::vector<ScalableSetting> settings_;
  const Extent& extent_;
};

}  // namespace

Result<std::vector<StressMap>> scene_stress_maps(const std::string& path, const StressRange& range,
                                                 const std::vector<Override>& overrides) {
  SceneText read = read_scene_text(path);
  const SceneResult scene = read.failure.errors.empty()
                                ? load_scene_text(read.text, path, overrides)
                                : std::move(read.failure);
  if (!scene) {
    Errors errors;
    for (const SceneError& error : scene.errors) errors.push_back({"", to_string(error)});
    return errors;
  }
  // Settings are changed in the scene that a program or a model becomes, not in its text.
  const bool becomes = jsonnet::is_program(path) || import::is_model(read.text);
  const std::string text = becomes ? write_scene(*scene) : std::move(read.text);
  StressCell origin;
  origin.path = path;
  origin.overrides = overrides;
  const SceneMaps maps(std::move(origin), *scene, scalable_settings(text),
                       range.quick ? quick_extent : full_extent);
  return maps.all();
}

std::vector<StressMap> built_in_stress_maps(const StressRange& range) {
  std::vector<StressMap> all;
  for (const std::string_view name : stress_scene_names) {
    const std::string_view text = *stress_scene(name);
    const SceneResult scene = load_scene_text(text, std::string(name));
    if (!scene) continue;  // a test ensures that they are valid
    StressCell origin;
    origin.built_in = name;
    const SceneMaps maps(std::move(origin), *scene, scalable_settings(text),
                         range.quick ? quick_built_in_extent : built_in_extent);
    for (StressMap& map : maps.all()) {
      map.name = std::string(name) + "-" + map.name;
      map.meaning = scene->name + ". " + map.meaning;
      all.push_back(std::move(map));
    }
  }
  return all;
}

}  // namespace sheave::measure
