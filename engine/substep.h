#pragma once
// What the stages of one substep share: an explicit context, no globals.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/body_set.h"
#include "engine/row.h"
#include "engine/state.h"
#include "engine/work_limit.h"

namespace sheave {

/// What a step observed; sums and maxima over its substeps.
struct StepStatistics {
  int rows = 0;                 ///< constraint rows solved per substep
  std::int64_t row_solves = 0;  ///< rows x iterations x substeps
  /// Largest correction, as an error of a row, in the last sweep or round of a substep [m or rad]:
  /// how far the solver was from convergence.
  double last_correction = 0.0;
  /// How often a feature had to fall back on a substitute because its geometry has no solution (a
  /// span without a tangent); details are in the feature's report.
  int geometry_fallbacks = 0;
  // Of the direct solver and of `rattle`.
  /// Linear problems solved, or swept over by Gauss-Seidel: Newton's rounds, and the velocities of
  /// `rattle`.
  std::int64_t rounds = 0;
  /// Rows that began or ceased to act while the active set was sought.
  std::int64_t set_changes = 0;
  /// Factorisations made for that, one at least per round.
  std::int64_t factorisations = 0;
  /// Substeps left to Gauss-Seidel because no active set was found, for positions or for
  /// velocities.
  std::int64_t solver_fallbacks = 0;
  int redundant_rows = 0;  ///< the most in one round
  /// Rounds in which rows contradicted each other (two drives of one coordinate) and all gave way.
  std::int64_t compromises = 0;
  // Of contacts between bodies.
  int contacts = 0;  ///< the most points in one substep, those about to touch among them
  double deepest_overlap = 0.0;           ///< [m]
  std::int64_t integrator_fallbacks = 0;  ///< substeps of `rattle` that were left to `xpbd`
  double external_work = 0.0;  ///< of the forces and torques that have been set on bodies [J]
  // Of substeps that did not converge (engine/substep_driver.h).
  std::int64_t cut_substeps = 0;   ///< done in smaller parts
  std::int64_t substep_parts = 0;  ///< in how many, all together
  /// Substeps, or parts, whose constraints are not met at their end, and no parts of them are.
  std::int64_t unconverged = 0;
  /// Substeps that took all the rounds or factorisations they may, did not get to their end part by
  /// part, and were done as a whole.
  std::int64_t exhausted = 0;
  /// Energy that `xpbd` took from the vibration of elastic cables [J], which is none of their
  /// damping's.
  double numerical_damping = 0.0;
};

/// What solvers do in a substep in which they do not converge.
enum class Resort {
  none,              ///< they give up
  other_integrator,  ///< `xpbd` does it, for `rattle`, and must converge
  anything,          ///< they make do with what they find
};

/// How much of its prescribed motion a drive does in a substep; less than all where it would need
/// what is not there.
struct DriveShare {
  double way = 1.0;    ///< of the way, 0 ... 1
  double speed = 1.0;  ///< of the speed at the end, 0 ... 1
};

/// The working data of one substep. Stages read the state at its start and write into `moving`;
/// the state itself changes only when the substep is complete, so a substep that fails leaves the
/// last good state behind.
struct Substep {
  const BodySet& bodies;
  const State& start;  ///< state at the start of the substep
  double h;            ///< length of the substep, or of the part of it that is being done [s]
  int iterations;
  Vector3 gravity;  ///< of the model, or what has been set instead [m/s2]
  double time =
      0.0;  ///< of the positions in `moving`: the start's, from the prediction on the end's [s]
  std::vector<MovingBody> moving;    ///< bodies.count() + 1; the world comes last and never moves
  std::vector<BodyState> predicted;  ///< velocities, and poses, without constraints
  std::vector<Vector3> predicted_turn;   ///< [rad], without constraints
  std::vector<DriveShare> drive_shares;  ///< per body; empty where no feature limits drives
  State next;                            ///< the state at the end, written by the last stages
  StepStatistics statistics;
  /// Per feature: of each force in its state [N or N m] the part that acted in the second half of
  /// the substep, along the gradients of its end (`rattle`). Empty where nothing did. A feature may
  /// bring it into another layout when it finishes.
  std::vector<std::vector<double>> late_forces;
  /// Share of the loads' impulse that predict() gives to the velocities: all of it, or the first
  /// half.
  double load_share = 1.0;
  /// Set by a solver that gives up: what it found is no solution, and the stages end here.
  bool failed = false;
  Resort resort = Resort::anything;
  WorkLimit work;

  /// A substep of `bodies` from `state_at_start`; both must outlive it. Bodies are placed at the
  /// start, with their inverse mass and inertia there; nothing is predicted yet.
  Substep(const BodySet& body_set, const State& state_at_start, double length, int sweeps);
  /// Prepares for the next substep, which starts from the current content of `start`.
  void restart();
  /// The compliance of a row whose force shall be -damping dC/dt, if its value is the change of C
  /// since the start of the substep: what acts, by the integrator's rule
  /// (engine/solvers/row_system.h), is minus value over compliance, or half.
  [[nodiscard]] double damper_compliance(double damping) const {
    return (load_share == 1.0 ? h : 0.5 * h) / damping;
  }
  /// The speed at the end of the substep [rad/s] that its drive prescribes to a body, if nothing is
  /// short; prescribed() bodies only. Of a drive to an angle `xpbd` has the mean over the substep,
  /// as of all velocities.
  [[nodiscard]] double driven_speed(int body) const;
  /// Takes the inverse masses and inertias at the current orientations, with the drag during
  /// load_share x h.
  void update_inertias();

  // Where bodies are now, in the course of the substep. A rotor mounted on a carrier follows it.

  /// Rotation from own frame to world frame.
  [[nodiscard]] Quaternion orientation(int body) const;
  /// Position of the centre of mass (of a mounted rotor: its centre) [m].
  [[nodiscard]] Vector3 position(int body) const;
  /// World position of the point `local` [m] of the body's own frame.
  [[nodiscard]] Vector3 point(int body, const Vector3& local) const {
    const MovingBody& own = moving[static_cast<std::size_t>(body)];
    // Of a mounted rotor the pose follows from its carrier's.
    if (own.tracks_orientation) return own.position + rotated(own.orientation, local);
    return position(body) + rotated(orientation(body), local);
  }

  // Gradients of what acts on a body, mounted or not (design, section 2).

  /// Adds to `row` the effect of a unit force along `direction` at the world point `at`.
  void add_force(Row& row, int body, const Vector3& at, const Vector3& direction) const;
  /// Adds to `row` the effect of a unit torque about `direction`.
  void add_torque(Row& row, int body, const Vector3& direction) const;
};

}  // namespace sheave
