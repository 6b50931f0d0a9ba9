#pragma once
// What the stages of one substep share: an explicit context, no globals.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/body_set.h"
#include "engine/row.h"
#include "engine/state.h"
#include "engine/step_statistics.h"
#include "engine/work_limit.h"

namespace sheave {

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
  /// No time passes while bodies are moved: it is asked where they would rest. Dampers have no part
  /// in that, and no pose on the way is one of the machine: cables leave no wheel, break and run out
  /// in none of them.
  bool at_rest = false;
  /// Solvers ask one feature after another, and what others will answer to it is not known yet: it
  /// must not decide what it cannot take back.
  bool tentative = false;
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
