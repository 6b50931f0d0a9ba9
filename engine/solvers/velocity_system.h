#pragma once
// All rows at the end of a substep of `rattle` as equations of the velocities: dC/dt = J v + the
// partial derivative of C by time.
//
// The unknowns are the impulses m [N s] for which dC/dt = 0 (or >= 0) on rows that have acted or are
// closed. Springs have acted and get no impulse, but dampers that act at the end do (Row::settling).
// Multipliers act along the gradients of the end, K = J. An impulse acts for half a substep, so its
// bounds are those of the force times h / 2.

#include "engine/followed_pressure.h"
#include "engine/solvers/row_system.h"

namespace sheave {

class VelocitySystem : public RowProblem {
 public:
  VelocitySystem() : RowProblem(Of::velocities) {}

  /// Sets up the problem of the velocities in substep.next. Takes the rows of `positions`, whose
  /// last linearise() must have been at the current positions.
  void linearise(Substep& substep, RowSystem& positions);
  /// Finds the impulses, by sweeps unless `direct`. Friction is bounded by the impulses of its
  /// normals, not by their forces in the first half, because an impact may be over by then. Rounds
  /// go on until both agree. False if no active set was found.
  bool find_impulses(Substep& substep, bool direct, int sweeps);
  /// Lets features revise discrete states that rows do not express, by the impulses just found.
  /// Returns whether any row changes; the problem then has the changed rows.
  [[nodiscard]] bool revise(Substep& substep, Features features, const RowSystem& positions);
  /// Energy [J] that rows without work have made or taken in the substep, with the impulses just
  /// found and the multipliers of `positions`. Rows that may take energy count only if they have
  /// made some.
  [[nodiscard]] double work_error(const Substep& substep, const RowSystem& positions) const;
  /// Changes the velocities and adds h m to the multipliers, so that the mean force over the
  /// substep is l / h^2 + m / h.
  void apply(Substep& substep, Features features);

 private:
  /// Sets up the problem with the present rows.
  void pose(const Substep& substep, const RowSystem& positions);
  [[nodiscard]] double rate_of(const Substep& substep, const Row& row) const;
  /// Lets the force of springs at the middle of the substep act during its second half.
  void act_springs(Substep& substep);
  /// Share of the substep in which a row presses that was open at the start; 1 for a row that bounds
  /// friction, whose spring presses by the midpoint rule.
  [[nodiscard]] double pressed_share(std::size_t row) const;
  /// Regularisation of a row: Row::softness, and the part for its damper.
  [[nodiscard]] double yield_of_rate(std::size_t row) const;
  /// Adds the effect of the impulses in the groups' multipliers; the unknowns are then changes of
  /// these impulses.
  void start_from_impulses();
  /// Multiplier of a row for the forces of both halves of the substep.
  [[nodiscard]] double whole_multiplier(double h, int row) const;
  /// Impulse of a group, within its bounds [N s].
  [[nodiscard]] double impulse_of(std::size_t group) const;
  /// Changes the velocities of the bodies by `motion_`.
  void move(Substep& substep);
  /// Bounds friction by the impulses just found. Returns whether the bounds have changed
  /// noticeably.
  [[nodiscard]] bool bound_friction(double h);
  /// Impulse [kg m/s] by which friction of a compliant contact follows its normal force, where the
  /// damper takes back force of the first half: friction of both halves is scaled to the bound of
  /// their sum. `bound` < 0: friction coefficient times the normal impulse of the second half.
  [[nodiscard]] double taken_friction(std::size_t row, double bound, double h) const;
  /// Begins with the friction of the positions.
  void begin_shared_friction();
  /// Turns rows to the slip of the velocities just found. Returns whether a direction has changed
  /// noticeably.
  [[nodiscard]] bool turn_friction();
  bool turn_to_slip(double bound, SharedFriction& friction);

  RowList revised_rows_;                     ///< rows of one feature
  std::vector<FollowedPressure> pressures_;  ///< per row, between rounds
  std::vector<double> friction_bounds_;      ///< per row, in those rounds [kg m/s]
};

}  // namespace sheave
