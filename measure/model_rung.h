#pragma once
// The model ladder: the same scene with one kind of effect left out, or modelled in another way.
//
// A scene may contain more than its result needs: the inertia of light wheels, the compliance of
// nearly rigid cables, drag, friction, bodies that never touch. Each rung changes everything of one
// kind and nothing else, so running both scenes shows the influence of that effect and its cost. A
// new rung is a line in measure/model_rungs.cpp, and a file in measure/rungs/ if it does more than
// setting fields to their defaults.

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "measure/trajectory.h"
#include "scenes/scene.h"

namespace sheave::measure {

/// One change of a model.
struct ModelRung {
  std::string name;    ///< "massless wheels"
  std::string things;  ///< the counted objects, in the plural: "wheels"
  std::string change;  ///< in words: "wheels without spin inertia"
  /// Changes the scene and returns the number of changed objects; 0 if the scene has none of the
  /// kind.
  std::function<int(Scene& scene)> apply;
};

/// All rungs, in the order of reports.
[[nodiscard]] std::span<const ModelRung> model_rungs();

/// A scene on a rung.
struct RungScene {
  Scene scene;      ///< without checks, camera and paint, which belong to the original scene
  int changed = 0;  ///< number of changed objects; 0: the scene is unchanged
  Errors faults;    ///< why it is not a valid scene; empty if it is
};
[[nodiscard]] RungScene on_rung(const ModelRung& rung, const Scene& scene);

/// Difference between the run of a changed model and the original run, relative as in
/// measure/run_error.h.
struct ModelDifference {
  double position = 0.0;  ///< largest of all frames, over the bodies that both runs have
  double tension = 0.0;   ///< NaN without cables
};
/// Infinite for incomplete runs. Both must be runs of one scene, or of its rungs, with the same
/// frames.
[[nodiscard]] ModelDifference model_difference(const Trajectory& rung, const Trajectory& written);

}  // namespace sheave::measure
