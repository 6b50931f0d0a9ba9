#pragma once
// The data that the stages of one substep share: an explicit context, no globals.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/body_set.h"
#include "engine/row.h"
#include "engine/state.h"
#include "engine/step_statistics.h"
#include "engine/work_limit.h"

namespace sheave {

/// The action of solvers in a substep in which they do not converge.
enum class Resort {
  none,              ///< give up
  other_integrator,  ///< `xpbd` does the substep in place of `rattle`, and must converge
  anything,          ///< keep the best result found
};

/// By which forces of rigid rows something breaks.
enum class Breakage {
  by_means,     ///< by those of the substep, at its end
  by_instants,  ///< by those of the instant at its end, of which the world tells features
  never,        ///< the motion is a trial that will be discarded (engine/instant_forces.h)
};

/// The share of a drive's prescribed motion that is done in a substep; below 1 where the drive
/// cannot complete the motion.
struct DriveShare {
  double way = 1.0;    ///< share of the displacement, 0 ... 1
  double speed = 1.0;  ///< share of the speed at the end, 0 ... 1
};

/// The working data of one substep. Stages read the state at the start and write into `moving`. The
/// state itself changes only when the substep is complete, so a substep that fails leaves the last
/// good state behind.
struct Substep {
  const BodySet& bodies;
  const State& start;  ///< state at the start of the substep
  double h;            ///< length of the substep, or of the part of it that is being done [s]
  int iterations;
  Vector3 gravity;  ///< of the model, or the control that replaces it [m/s2]
  /// Time of the positions in `moving` [s]: that of the start, and from the prediction on that of
  /// the end.
  double time = 0.0;
  std::vector<MovingBody> moving;    ///< bodies.count() + 1; the world comes last and never moves
  std::vector<BodyState> predicted;  ///< velocities and poses without constraints
  std::vector<Vector3> predicted_turn;   ///< rotation vectors without constraints [rad]
  std::vector<double> guess;             ///< scratch of engine/dynamics/motion_guess.h
  std::vector<DriveShare> drive_shares;  ///< per body; empty if no feature limits drives
  State next;                            ///< the state at the end, written by the last stages
  StepStatistics statistics;
  /// Per feature: the part of each force in its state [N or N m] that acted in the second half of
  /// the substep, along the gradients of the end (`rattle`). Empty if no force acted then. A
  /// feature may change the layout in finish().
  std::vector<std::vector<double>> late_forces;
  /// Share of the loads' impulse that predict() gives to the velocities: 1, or 0.5 for the first
  /// half.
  double load_share = 1.0;
  /// Set by a solver to whose rounds a better guess of the motion would be of use
  /// (engine/motion_history.h): rows have turned with the motion of a round.
  bool asks_for_guess = false;
  bool guessed = false;   ///< the rounds have begun at such a guess
  bool may_guess = true;  ///< false: the rounds begin at the velocities of the start
  /// Set by a solver that gives up: its result is no solution, and no further stage runs.
  bool failed = false;
  Resort resort = Resort::anything;
  /// Whether a rest position is sought: bodies move while no time passes. Dampers do not act. The
  /// intermediate poses are no motion of the machine, so cables neither leave wheels nor break nor
  /// run out.
  bool at_rest = false;
  /// Whether solvers are still asking the features one after another. The answers of other features
  /// are not known yet, so a feature must not make irreversible decisions.
  bool tentative = false;
  Breakage breakage = Breakage::by_means;
  WorkLimit work;

  /// A substep of `body_set` from `state_at_start`; both must outlive the object. Bodies are at
  /// their poses of the start, with the inverse masses and inertias of these poses. Nothing is
  /// predicted yet.
  Substep(const BodySet& body_set, const State& state_at_start, double length, int sweeps);
  /// Prepares for the next substep, which begins with the present content of `start`.
  void restart();
  /// The compliance of a row that is to act with the force -damping dC/dt, if the row's value is
  /// the change of C since the start of the substep. By the integrator's rule
  /// (engine/solvers/row_system.h), the force is minus value over compliance, or half of it.
  [[nodiscard]] double damper_compliance(double damping) const {
    return (load_share == 1.0 ? h : 0.5 * h) / damping;
  }
  /// The speed at the end of the substep [rad/s] that the drive prescribes to a body, if the
  /// drive's share is 1; only for prescribed() bodies. With `xpbd`, a drive to an angle has the
  /// mean speed over the substep, as all velocities of `xpbd` are means.
  [[nodiscard]] double driven_speed(int body) const;
  /// Computes the inverse masses and inertias at the present orientations, including the drag
  /// during load_share x h.
  void update_inertias();

  // Present poses in the course of the substep. A rotor mounted on a carrier follows the carrier.

  /// Rotation from own frame to world frame.
  [[nodiscard]] Quaternion orientation(int body) const;
  /// Position of the centre of mass (of a mounted rotor: its centre) [m].
  [[nodiscard]] Vector3 position(int body) const;
  /// World position of the point `local` [m] of the body's own frame.
  [[nodiscard, gnu::always_inline]] Vector3 point(int body, const Vector3& local) const {
    const MovingBody& own = moving[static_cast<std::size_t>(body)];
    // The pose of a mounted rotor follows from its carrier's.
    if (own.tracks_orientation) return own.position + rotated(own.orientation, local);
    return position(body) + rotated(orientation(body), local);
  }

  // Gradients of forces and torques on a body, mounted or not.

  /// Adds to `row` the effect of a unit force along `direction` at the world point `at`.
  [[gnu::always_inline]] void add_force(Row& row, int body, const Vector3& at,
                                        const Vector3& direction) const {
    if (bodies[body].mount >= 0) return add_force_on_rotor(row, body, at, direction);
    const Vector3 arm = at - moving[static_cast<std::size_t>(body)].position;
    row.add(body, direction, cross(arm, direction), dot(arm, direction));
  }
  /// Adds to `row` the effect of a unit torque about `direction`.
  void add_torque(Row& row, int body, const Vector3& direction) const;

 private:
  void add_force_on_rotor(Row& row, int body, const Vector3& at, const Vector3& direction) const;
};

}  // namespace sheave
