#pragma once
// The forces that act at an instant; internal to the engine. The derivation is at the head of
// engine/instant_forces.cpp.

#include <memory>
#include <optional>
#include <vector>

#include "engine/instant_feature.h"
#include "engine/world_content.h"

namespace sheave {

/// Forces of rows at an instant, for features that ask (engine/instant_feature.h). The forces are
/// those of short trial motions in a world of its own, so the state of the asking world and the
/// working data of its features do not change.
class World::InstantForces {
 public:
  /// A part of a trial motion, as a share of a substep.
  static constexpr double share = 0.125;

  /// For a world with this content.
  explicit InstantForces(const Content& own);

  /// Finds the forces in the state `state` of that world, whose velocities belong to its poses.
  /// `length`: of its substeps [s]. False if they are not known: a trial motion has no solution, or
  /// a feature has no copy.
  [[nodiscard]] bool find(const State& state, double length);
  /// The forces of feature number `watching` of Content::watching, of the last find(), which must
  /// have found them.
  [[nodiscard]] TrialForces of(std::size_t watching) const {
    return {early_[watching], late_[watching]};
  }

 private:
  /// Mean forces of a part, per watching feature.
  using Forces = std::vector<std::vector<double>>;

  void begin(const State& state);
  /// False if the part has no solution.
  [[nodiscard]] bool run(double length);
  void collect(Forces& forces) const;

  std::unique_ptr<Content> trial_;  // null: a feature has no copy
  Forces early_, late_;
};

}  // namespace sheave
