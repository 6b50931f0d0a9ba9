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
  /// Whether such conditions can arise under these controls.
  [[nodiscard]] virtual bool watches(const Controls& controls) const = 0;
  /// Called before a part: if conditions arise in it, the world goes back and does a shorter one.
  /// Null: the world does not, and the conditions arise within the part. A part that does not
  /// converge is cut further; conditions arise within these parts, too.
  virtual void expect(const Expected* part) = 0;
  /// Called after an expected part, with the state of the feature at its end: the distance of the
  /// first condition beyond the point where it arises, above 0 if one has arisen. The unit is that
  /// of the condition. Near its root the value is continuous in the length of the part.
  [[nodiscard]] virtual double margin(const Substep& substep, const FeatureState& own) const = 0;

  // Conditions of forces that only exist as means over a substep, such as the tension of a rigid
  // rope: the world finds the forces of the instant (engine/instant_forces.h), and such a condition
  // acts between two substeps.

  /// Whether the feature in the state `own` has such conditions.
  [[nodiscard]] virtual bool asks_for_forces(const FeatureState& /*own*/) const { return false; }
  /// Appends the sizes of the forces of the conditions, as means over the part just done; as many
  /// each time.
  virtual void append_forces(std::vector<double>& /*forces*/) const {}
  /// Called after a part and before margin(), with the forces of append_forces() at the end of the
  /// part (engine/instant_forces.h). Empty: they are not known. `length`: of a substep that is not
  /// cut [s].
  virtual void tell_forces(std::span<const double> /*forces*/, double /*length*/) {}
  /// Called between substeps, at `time` [s], after tell_forces() for the present state: performs the
  /// conditions that hold. Returns whether `own` has changed.
  virtual bool arise(const BodySet& /*bodies*/, double /*time*/, FeatureState& /*own*/) {
    return false;
  }
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
