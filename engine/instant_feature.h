#pragma once
// Conditions that arise in a feature within a substep and change the motion from there on.

#include <memory>
#include <span>

#include "engine/feature_roles.h"

namespace sheave {

/// A part of the motion between two instants at which something acts [s].
struct Expected {
  double from = 0.0;
  double to = 0.0;
};

/// A feature with conditions that the world locates (engine/instants.h): the substep ends where the
/// first one arises, and another one begins. An impact, for instance, can then end the substep
/// instead of happening within it.
class InstantFeature : public FeatureRole {
 public:
  /// Whether such conditions can arise.
  [[nodiscard]] virtual bool watches() const = 0;
  /// Called before a part: if conditions arise in it, the world goes back and does a shorter one.
  /// Null: the world does not, and the conditions arise within the part. A part that does not
  /// converge is cut further; conditions arise within these parts, too.
  virtual void expect(const Expected* part) = 0;
  /// Called after an expected part, with the state of the feature at its end: the distance of the
  /// first condition beyond the point where it arises, above 0 if one has arisen. The unit is that
  /// of the condition. Near its root the value is continuous in the length of the part.
  [[nodiscard]] virtual double margin(const Substep& substep, const FeatureState& own) const = 0;
};

/// A feature with impacts, which end a part of the motion.
class ImpactFeature : public InstantFeature {
 public:
  /// Called after begin() of all features, with `rattle`: selects the impacts that are to end the
  /// part.
  virtual void await_impacts(Substep& substep,
                             std::span<const std::unique_ptr<ConstraintBatch>> features) = 0;
  /// Called with the final velocities of `rattle`: performs the selected impacts that happen at the
  /// end of the part.
  virtual void land(Substep& substep,
                    std::span<const std::unique_ptr<ConstraintBatch>> features) = 0;
};

}  // namespace sheave
