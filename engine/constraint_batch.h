#pragma once
// All constraints of one type: one virtual call per batch and stage, a plain loop inside.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/row_list.h"
#include "engine/state.h"

namespace sheave {

class AffineBodies;
class AffineRows;
struct AffineSubstep;
class BodySet;
struct Substep;

/// Where a feature's notes can return to: ConstraintBatch::mark_notes().
enum class NoteMark { step, substep };

/// A feature of a world that constrains bodies. Its settings are fixed; what it carries from
/// substep to substep is a FeatureState; members beyond those are scratch that begin() fills anew
/// in every substep, or notes: what it keeps for reports alone (events, warnings), and nothing that
/// moves depends on.
class ConstraintBatch {
 public:
  virtual ~ConstraintBatch() = default;
  ConstraintBatch(const ConstraintBatch&) = delete;
  ConstraintBatch& operator=(const ConstraintBatch&) = delete;

  /// Name of the feature's stages, e.g. "hinge joints", "cables".
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// The feature's state at time 0.
  [[nodiscard]] virtual FeatureState initial_state() const = 0;
  /// Whether `state`, of the right sizes, can be one of this feature: what begin() relies on.
  [[nodiscard]] virtual bool accepts(const FeatureState& /*state*/) const { return true; }
  /// Whether `controls`, of a state that accepts() has passed, can be those of this feature;
  /// Controls::cables and links are its alone if it takes_cables().
  [[nodiscard]] virtual bool accepts_controls(const Controls& /*controls*/) const { return true; }
  /// Whether it is the one whose cables and links controls are for.
  [[nodiscard]] virtual bool takes_cables() const { return false; }
  /// Whether states always have the sizes of initial_state(); otherwise accepts() checks them.
  [[nodiscard]] virtual bool has_fixed_size() const { return true; }
  /// Number of rows that linearise() appends.
  [[nodiscard]] virtual int row_count() const = 0;

  /// Called before bodies are predicted. `state` is the feature's own state at the start.
  virtual void begin(const Substep& substep, const FeatureState& state) = 0;
  /// Whether limit_drives() ever does anything.
  [[nodiscard]] virtual bool limits_drives() const { return false; }
  /// Called after begin(): lessens Substep::drive_shares where a drive would need what is not there
  /// (a winch whose cable has run out). Other features do the same.
  virtual void limit_drives(Substep& /*substep*/) {}
  /// One Gauss-Seidel sweep: each row in order, re-evaluated at the current positions and solved.
  /// Returns the largest correction, as an error of a row [m or rad].
  virtual double sweep(Substep& substep) = 0;
  /// Appends all rows at the current positions without moving anything; their multipliers are those
  /// of multipliers().
  virtual void linearise(Substep& substep, RowList& rows) = 0;
  /// Whether linearise() always appends the same rows within a substep, unless revise() says that
  /// something has changed. (The ground has none for what is far from it.)
  [[nodiscard]] virtual bool has_all_rows() const { return false; }
  /// The longest length that a row's value is a difference of in this substep [m], slack or not, if
  /// it can be longer than the bodies are apart (a cable to a point of the world): of that size is
  /// what rounding leaves of the value.
  [[nodiscard]] virtual double longest() const { return 0.0; }
  /// The accumulated multipliers, which a row refers to by its index; a solver changes them with
  /// the positions.
  [[nodiscard]] virtual std::span<double> multipliers() = 0;
  /// Called when a solver of all rows at once has found multipliers: chooses anew between the
  /// states that rows do not tell (a cable sticks or slides). Returns whether anything has changed.
  virtual bool revise(Substep& /*substep*/) { return false; }
  /// Called when `rattle` has found the impulses of the velocities, with multipliers() those of the
  /// forces of both halves of the substep: chooses anew between such states, until end_impulses().
  /// Returns whether anything has changed; linearise() then tells the rows, as many as before.
  virtual bool revise_impulses(const Substep& /*substep*/) { return false; }
  /// Called when the impulses are found: chooses again what it had chosen before them.
  virtual void end_impulses() {}
  /// Whether its rows depend on each other too much for sweeps from row to row to get anywhere:
  /// Gauss-Seidel then solves them all at once whenever it is their turn.
  [[nodiscard]] virtual bool is_stiff() const { return false; }
  /// Whether begin() has found an impact from which bodies will rebound. `rattle` leaves such a
  /// substep to `xpbd`.
  [[nodiscard]] virtual bool meets() const { return false; }
  /// Whether correct_velocities() ever does anything.
  [[nodiscard]] virtual bool corrects_velocities() const { return false; }
  /// Called when velocities follow from positions, for what positions do not tell of them (a
  /// bounce).
  virtual void correct_velocities(Substep& /*substep*/) {}
  /// Why the substep that has just been done is void, as a sentence that names the bodies; empty if
  /// it is not.
  [[nodiscard]] virtual std::string fault() const { return {}; }
  /// Called when positions are final: writes the feature's state at the end of the substep.
  virtual void finish(Substep& substep, FeatureState& next) = 0;
  /// Why the motion cannot go on from the substep that finish() has ended, as a sentence; empty: it
  /// can.
  [[nodiscard]] virtual std::string dead_end(const Substep& /*substep*/) const { return {}; }
  /// Keeps where its notes are, for return_to(); one place per mark.
  virtual void mark_notes(NoteMark /*mark*/) {}
  /// Forgets what it has noted since, when the motion that this belongs to is discarded.
  virtual void return_to(NoteMark /*mark*/) {}

  // Machines in which nothing turns a row's gradient: engine/solvers/affine_motion.h.

  /// Appends all its rows that ever have a force in such substeps, if each is affine in what
  /// `bodies` count, for good; otherwise none, and false.
  [[nodiscard]] virtual bool append_affine(const AffineBodies& /*bodies*/, AffineRows& /*rows*/) {
    return false;
  }
  /// Instead of begin() and limit_drives(): the rows' values at the start of a substep, and which
  /// of them have a force in `state`. False if in this substep they may not be affine.
  [[nodiscard]] virtual bool begin_affine(const AffineSubstep& /*substep*/,
                                          const FeatureState& /*state*/,
                                          std::span<double> /*values*/,
                                          std::span<char> /*active*/) {
    return false;
  }
  /// Instead of finish(): the state at the end, into one that agrees with that at the start, `now`,
  /// in all that such substeps leave alone. False if it has to be found in another way; nothing has
  /// changed then but `next`.
  [[nodiscard]] virtual bool finish_affine(const AffineSubstep& /*substep*/,
                                           const FeatureState& /*now*/, FeatureState& /*next*/) {
    return false;
  }

  /// Takes over from a state of a feature of another world what is the same in both: `own` is that
  /// of initial_state(). Called when a running world is edited.
  virtual void adopt(const ConstraintBatch& /*before*/, const FeatureState& /*from*/,
                     FeatureState& /*own*/) const {}

  /// Elastic energy stored in the feature [J], between substeps.
  [[nodiscard]] virtual double elastic_energy(const BodySet& bodies, const State& state,
                                              const FeatureState& own) const = 0;

 protected:
  ConstraintBatch() = default;
};

}  // namespace sheave
