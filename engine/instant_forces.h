#pragma once
// The forces that act at an instant; internal to the engine. The derivation is at the head of
// engine/instant_forces.cpp.

#include <memory>
#include <span>
#include <vector>

#include "engine/instant_feature.h"
#include "engine/world_content.h"

namespace sheave {

/// Of a body.
struct Acceleration {
  Vector3 linear = Vector3::Zero();   ///< [m/s2]
  Vector3 angular = Vector3::Zero();  ///< [rad/s2]
};

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
  /// Whether redundant rows shared loads in the motion of the last find(): then friction or nothing
  /// determines the shares, and they may change from substep to substep.
  [[nodiscard]] bool shares_are_open() const;
  /// Bounds the forces of the last find() by the mean forces that they are extrapolated from and by
  /// the means over the last part of the asking world.
  void keep_within_means(const Content& own);
  /// Lowers the forces of the last find() to the means over the last part of the asking world.
  void lower_to_means(const Content& own);
  /// Whether the velocities of a body have jumped: its acceleration in the motion of the last find()
  /// is less than half of its mean before. `means`: per body, or empty.
  [[nodiscard]] bool has_jumped(std::span<const Acceleration> means) const;
  /// The forces of feature number `watching` of Content::watching, of the last find(), which must
  /// have found them.
  [[nodiscard]] std::span<const double> of(std::size_t watching) const { return now_[watching]; }

 private:
  /// Forces per watching feature.
  using Forces = std::vector<std::vector<double>>;

  void begin(const State& state);
  /// False if the part has no solution.
  [[nodiscard]] bool run(double length);
  static void collect(const Content& content, Forces& forces);
  /// Finds now_ from the mean forces of the second and third part.
  void extrapolate();
  /// Finds accelerations_ from the velocities `before` a part of this length [s].
  void compare(const std::vector<BodyState>& before, double length);

  std::unique_ptr<Content> trial_;  // null: a feature has no copy
  Forces second_, third_;           // means of parts
  Forces last_;                     // means over the last part of the asking world
  Forces now_;
  std::vector<Acceleration> accelerations_;  // per body, in the third part
};

}  // namespace sheave
