#pragma once
// The members of a world; internal to the engine.

#include <algorithm>

#include "engine/control_check.h"
#include "engine/instant_feature.h"
#include "engine/instants.h"
#include "engine/substep_driver.h"
#include "engine/world.h"

namespace sheave {

/// The features that a model itself defines; joints in the order of the registry.
[[nodiscard]] std::vector<std::unique_ptr<ConstraintBatch>> model_features(const Model& model,
                                                                           const BodySet& bodies);

struct World::Content {
  Model model;
  std::shared_ptr<const BodySet> bodies;
  std::vector<std::unique_ptr<ConstraintBatch>> features;
  State state;
  Substep substep;
  std::vector<Stage> stages;
  SubstepDriver driver;
  State step_start;          // start of a step that may be stopped
  std::size_t contacts = 0;  // index of the contacts among the features, if the model has colliders
  std::vector<JointPlace> joints;    // in the order of the model
  std::size_t coordinate_count = 0;  // coordinates of all joints
  double control_interval = 0.0;     // World::control_interval() [s]
  World::MemoryFault memory_fault;   // may be empty
  /// A feature that acts by itself, and its index.
  struct Scheduled {
    ScheduledFeature* feature = nullptr;
    std::size_t index = 0;
  };
  std::vector<Scheduled> scheduled;
  std::vector<NotedFeature*> noted;
  /// A feature with conditions, and its index.
  struct Watching {
    InstantFeature* feature = nullptr;
    std::size_t index = 0;
  };
  std::vector<Watching> watching;
  std::vector<double> margins, start_margins;  // of the conditions that are waited for
  State search_start;                          // of a stretch in which one comes to hold
  std::vector<BodyState> part_start;  // of the part that forces of an instant follow, with `xpbd`
  std::shared_ptr<InstantForces> instant_forces;  // made when a feature asks for forces first
  bool stays_in_place = false;                    // World::keep_in_place(), and where that is:
  const BodyState* bodies_place = nullptr;
  const double* reals_place = nullptr;

  Content(Model m, std::shared_ptr<const BodySet> b,
          std::vector<std::unique_ptr<ConstraintBatch>> f, State s)
      : model(std::move(m)),
        bodies(std::move(b)),
        features(std::move(f)),
        state(std::move(s)),
        substep(*bodies, state, model.step.dt / model.step.substeps, model.step.iterations),
        stages(substep_stages(model, features)),
        driver(model, features, stages, substep, state),
        joints(number_joints(model, features)),
        control_interval(model.step.dt) {
    coordinate_count = at(check().coordinate_count());
    substep.next = state;
    noted = features_with<NotedFeature>(features);
    for (std::size_t i = 0; i < features.size(); ++i) {
      auto* const acting = dynamic_cast<ScheduledFeature*>(features[i].get());
      if (acting != nullptr && acting->has_instants()) scheduled.push_back({acting, i});
      auto* const watched = dynamic_cast<InstantFeature*>(features[i].get());
      if (watched != nullptr) watching.push_back({watched, i});
    }
  }

  /// Whether a feature has conditions to be located.
  [[nodiscard]] bool watches() const {
    return std::any_of(watching.begin(), watching.end(),
                       [&](const Watching& w) { return w.feature->watches(state.controls); });
  }
  /// Whether a feature asks for the forces of an instant.
  [[nodiscard]] bool asks_for_forces() const {
    return std::any_of(watching.begin(), watching.end(), [&](const Watching& w) {
      return w.feature->asks_for_forces(state.features[w.index]);
    });
  }
  /// Whether a feature does something by itself before `time` [s].
  [[nodiscard]] bool acts_before(double time) const;
  [[nodiscard]] ControlCheck check() const { return {model, *bodies, joints}; }
  /// Index of the feature that the joint is in.
  [[nodiscard]] std::size_t feature_of(const JointPlace& place) const {
    std::size_t i = 0;
    while (features[i].get() != place.feature) ++i;
    return i;
  }
  void mark_notes() {
    for (NotedFeature* feature : noted) feature->mark_notes(NoteMark::step);
  }
  void undo_step() {
    state = step_start;
    substep.next = state;
    driver.forget();
    for (NotedFeature* feature : noted) feature->return_to(NoteMark::step);
  }
};

}  // namespace sheave
