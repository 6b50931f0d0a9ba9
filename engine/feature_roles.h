#pragma once
// Roles that a feature can have besides its rows. A feature takes a role by deriving from it; the
// world asks for roles when it is created.

#include <memory>
#include <span>
#include <vector>

#include "engine/constraint_batch.h"

namespace sheave {

class AffineBodies;
class AffineRows;
struct AffineSubstep;

/// Base of all roles.
class FeatureRole {
 public:
  virtual ~FeatureRole() = default;
  FeatureRole& operator=(const FeatureRole&) = delete;

 protected:
  FeatureRole() = default;
  FeatureRole(const FeatureRole&) = default;
};

/// A feature with rows that no motion turns: engine/solvers/affine_motion.h.
class AffineFeature : public FeatureRole {
 public:
  /// Appends all rows that can have a force in affine substeps, if each row is affine in the
  /// coordinates of `bodies` at all times; otherwise appends none and returns false.
  [[nodiscard]] virtual bool append_affine(const AffineBodies& bodies, AffineRows& rows) = 0;
  /// Replaces begin() and limit_drives(): the values of the rows at the start of the substep, and
  /// which rows have a force in `state`. False if the rows may not be affine in this substep.
  [[nodiscard]] virtual bool begin_affine(const AffineSubstep& substep, const FeatureState& state,
                                          std::span<double> values, std::span<char> active) = 0;
  /// Replaces finish(): writes the state at the end into `next`. On entry `next` agrees with `now`,
  /// the state at the start, in all members that affine substeps leave unchanged. False if the
  /// substep needs the stages; only `next` may then have changed.
  [[nodiscard]] virtual bool finish_affine(const AffineSubstep& substep, const FeatureState& now,
                                           FeatureState& next) = 0;
};

/// A feature that acts at times which are known in advance (engine/instants.h).
class ScheduledFeature : public FeatureRole {
 public:
  /// Whether the feature ever acts at such a time.
  [[nodiscard]] virtual bool has_instants() const = 0;
  /// The time of the first action that is not done yet [s]; infinity if all are done.
  [[nodiscard]] virtual double next_instant(const FeatureState& own) const = 0;
  /// Called between substeps, at `time` [s]: performs the actions that are due before `until` [s].
  /// Returns whether `own` has changed.
  virtual bool act_at(const BodySet& bodies, double time, double until, FeatureState& own) = 0;
};

/// Where the notes of a feature can return to. `before`: with a tolerance, the substep before.
enum class NoteMark { step, instant, substep, before };

/// A feature that takes notes for reports: events and warnings. No motion depends on notes.
class NotedFeature : public FeatureRole {
 public:
  /// Marks the present extent of the notes for return_to(); one mark of each kind is kept.
  virtual void mark_notes(NoteMark mark) = 0;
  /// Drops the notes taken since the mark, because the motion they describe has been discarded.
  virtual void return_to(NoteMark mark) = 0;
};

/// The features with a role, in their order.
template <class Role>
[[nodiscard]] std::vector<Role*> features_with(
    std::span<const std::unique_ptr<ConstraintBatch>> features) {
  std::vector<Role*> found;
  for (const auto& feature : features) {
    if (auto* const role = dynamic_cast<Role*>(feature.get())) found.push_back(role);
  }
  return found;
}

}  // namespace sheave
