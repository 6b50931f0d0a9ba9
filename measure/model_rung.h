#pragma once
// The model ladder: the same scene with one kind of effect left out, or modelled in another way.
//
// A scene says more than an answer may need: inertia of wheels that is small beside the weights',
// compliance of cables that are nearly rigid, drag, friction, bodies that never touch. Each rung
// changes everything of one kind and nothing else, so that running both scenes tells what that
// effect is worth and what it costs. Adding one: a line in measure/model_rungs.cpp, with a file in
// measure/rungs/ if it does more than setting fields to their defaults.

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
  std::string things;  ///< what is counted, in the plural: "wheels"
  std::string change;  ///< in words: "spin inertia 0 instead of what it is"
  /// Changes the scene and returns how many things it changed; 0 if it has none of the kind.
  std::function<int(Scene& scene)> apply;
};

/// All of them, in the order of reports.
[[nodiscard]] std::span<const ModelRung> model_rungs();

/// A scene on a rung.
struct RungScene {
  Scene scene;      ///< without checks, camera and paint, which tell of the scene as it was written
  int changed = 0;  ///< things; 0: the scene is as before
  Errors faults;    ///< why it is no valid scene; empty if it is one
};
[[nodiscard]] RungScene on_rung(const ModelRung& rung, const Scene& scene);

/// What a change of the model changes in a run, relative as in measure/run_error.h.
struct ModelDifference {
  double position = 0.0;  ///< largest of all frames, over the bodies that both runs have
  double tension = 0.0;   ///< NaN without cables
};
/// Infinite for runs that are not complete. Both must be of one scene, or of its rungs, with the
/// same frames.
[[nodiscard]] ModelDifference model_difference(const Trajectory& rung, const Trajectory& written);

}  // namespace sheave::measure
