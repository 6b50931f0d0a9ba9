#pragma once
// All constraints of one type: one virtual call per batch and stage, a plain loop inside.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/row_list.h"
#include "engine/state.h"

namespace sheave {

class BodySet;
struct Substep;

/// A feature of a world that constrains bodies. Its settings are fixed. Its state, which goes from
/// substep to substep, is a FeatureState. All other members are either scratch, which begin() fills
/// anew in every substep, or notes for reports. A feature that does more than rows express has roles
/// besides: engine/feature_roles.h, engine/instant_feature.h.
class ConstraintBatch {
 public:
  virtual ~ConstraintBatch() = default;
  ConstraintBatch& operator=(const ConstraintBatch&) = delete;

  /// Name of the feature's stages, e.g. "hinge joints", "cables".
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// The feature's state at time 0.
  [[nodiscard]] virtual FeatureState initial_state() const = 0;
  /// Whether `state`, whose sizes are right, meets the assumptions of begin().
  [[nodiscard]] virtual bool accepts(const FeatureState& /*state*/) const { return true; }
  /// Whether the feature can have `controls`, which belong to a state that accepts() has passed.
  /// The feature with takes_cables() checks Controls::cables and links.
  [[nodiscard]] virtual bool accepts_controls(const Controls& /*controls*/) const { return true; }
  /// Whether the controls of cables and links are those of this feature.
  [[nodiscard]] virtual bool takes_cables() const { return false; }
  /// Whether states always have the sizes of initial_state(); otherwise accepts() checks them.
  [[nodiscard]] virtual bool has_fixed_size() const { return true; }
  /// Number of rows that linearise() appends.
  [[nodiscard]] virtual int row_count() const = 0;

  /// Called before bodies are predicted. `state` is the feature's own state at the start.
  virtual void begin(const Substep& substep, const FeatureState& state) = 0;
  /// Whether limit_drives() can reduce a drive's share.
  [[nodiscard]] virtual bool limits_drives() const { return false; }
  /// Called after begin(): reduces Substep::drive_shares of drives that cannot complete their
  /// motion (a winch whose cable has run out). Several features may reduce the same share.
  virtual void limit_drives(Substep& /*substep*/) {}
  /// One Gauss-Seidel sweep: each row in order, re-evaluated at the current positions and solved.
  /// Returns the largest correction, as a residual of a row [m or rad].
  virtual double sweep(Substep& substep) = 0;
  /// Appends all rows at the current positions, and moves nothing. Row::index refers to
  /// multipliers().
  virtual void linearise(Substep& substep, RowList& rows) = 0;
  /// Whether linearise() appends the same rows throughout a substep, unless revise() reports a
  /// change. (The ground appends no rows for bodies far from it.)
  [[nodiscard]] virtual bool has_all_rows() const { return false; }
  /// The longest length from which a row's value is computed as a difference in this substep [m],
  /// slack rows included. The rounding error of the value scales with this length, which may exceed
  /// the distance of the bodies (a long cable to a point of the world).
  [[nodiscard]] virtual double longest() const { return 0.0; }
  /// The accumulated multipliers. A row refers to its multiplier by index; solvers change both.
  [[nodiscard]] virtual std::span<double> multipliers() = 0;
  /// Called when a solver of all rows at once has found multipliers: selects anew among discrete
  /// states that rows do not express (a cable sticks or slides). Returns whether any has changed.
  virtual bool revise(Substep& /*substep*/) { return false; }
  /// Called when `rattle` has found the impulses of the velocities: selects discrete states as
  /// revise() does, until end_impulses(). multipliers() then hold the forces of both halves of the
  /// substep. Returns whether any state has changed; linearise() then appends as many rows as
  /// before.
  virtual bool revise_impulses(const Substep& /*substep*/) { return false; }
  /// Called when the impulses are final: restores the states selected before revise_impulses().
  virtual void end_impulses() {}
  /// Whether the rows are coupled too strongly for sweeps from row to row to converge. Gauss-Seidel
  /// then solves all rows of this feature at once in each sweep.
  [[nodiscard]] virtual bool is_stiff() const { return false; }
  /// Whether begin() has found an impact from which bodies will rebound. `rattle` leaves such a
  /// substep to `xpbd`.
  [[nodiscard]] virtual bool meets() const { return false; }
  /// Whether correct_velocities() can change a velocity.
  [[nodiscard]] virtual bool corrects_velocities() const { return false; }
  /// Called when velocities have been derived from positions: applies velocity changes that
  /// positions do not express (a rebound). `features`: all features of the world, the rows of which
  /// pass impulses on.
  virtual void correct_velocities(Substep& /*substep*/,
                                  std::span<const std::unique_ptr<ConstraintBatch>> /*features*/) {}
  /// The reason why the substep just done is invalid, as a sentence that names the bodies; empty if
  /// the substep is valid.
  [[nodiscard]] virtual std::string fault() const { return {}; }
  /// Called when positions are final: writes the feature's state at the end of the substep.
  virtual void finish(Substep& substep, FeatureState& next) = 0;
  /// The reason why the motion cannot continue after finish(), as a sentence (a singular
  /// configuration); empty if it can.
  [[nodiscard]] virtual std::string dead_end(const Substep& /*substep*/) const { return {}; }
  /// Takes over the parts of another world's feature state that are the same in both worlds. `own`
  /// is on entry that of initial_state(). Called when a running world is edited.
  virtual void adopt(const ConstraintBatch& /*before*/, const FeatureState& /*from*/,
                     FeatureState& /*own*/) const {}

  /// Another feature of the same definition, for trial motions (engine/instant_forces.h). Asked only
  /// of features that do not follow from the model; null: there can be no trial motions.
  [[nodiscard]] virtual std::unique_ptr<ConstraintBatch> copy() const { return nullptr; }

  /// Elastic energy stored in the feature [J], between substeps.
  [[nodiscard]] virtual double elastic_energy(const BodySet& bodies, const State& state,
                                              const FeatureState& own) const = 0;
  /// Potential energy of masses that belong to no body [J], between substeps: of ropes with weight.
  [[nodiscard]] virtual double potential_energy(const BodySet& /*bodies*/, const State& /*state*/,
                                                const FeatureState& /*own*/) const {
    return 0.0;
  }

  /// Kinetic energy of masses that belong to no body [J], between substeps: of ropes with inertia.
  [[nodiscard]] virtual double kinetic_energy(const BodySet& /*bodies*/,
                                              const State& /*state*/) const {
    return 0.0;
  }

 protected:
  ConstraintBatch() = default;
  ConstraintBatch(const ConstraintBatch&) = default;
};

}  // namespace sheave
