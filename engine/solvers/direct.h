#pragma once
// All rows of a substep at once, by Newton's method.
//
// Each round solves engine/solvers/row_system.h with XPBD's compliance and damping. The first round
// leaves what the motion of one substep bends the constraints by, the next one the square of it.
// Rounds end when no row is violated by more than `tolerance` times the scene's size where its
// multipliers and the gradients found last put the bodies, to which they are then moved, if that is
// no more than `across` (rows do not tell how far it is across them: up to the root of the
// tolerance), at the latest after `iterations` of them. Where they do not come near a solution, or
// find no active set, the substep has failed; in one that has to make do, bodies go to where the
// violation is least (engine/solvers/least_violation.h), or Gauss-Seidel goes on, and is counted.
//
// At first each round starts again from the prediction, with the gradients of the last one, so that
// what rests has its static forces. Where bodies swing too far within a substep for that, the
// rounds stop converging, and corrections are added up instead: a chain of light links under a
// heavy ball, whose links swing across it by more than a radian per substep.

#include "engine/solvers/gauss_seidel.h"
#include "engine/solvers/kept_place.h"
#include "engine/solvers/least_violation.h"
#include "engine/solvers/row_system.h"

namespace sheave {

class DirectSolver {
 public:
  /// Violation at which a round is the last one, relative to the scene's size.
  static constexpr double tolerance = 1e-10;
  /// Closer than this a row counts as closed when the velocities are found, relative to the scene's
  /// size: far below what a substep moves, far above what the solver leaves.
  static constexpr double closed = 1e-8;
  /// How far the bodies may be, in the same unit, from where the forces of the last round put them
  /// along the gradients of the next one, to which they are then moved: what rows do not see of it,
  /// because it is across them.
  static constexpr double across = 1e-9;
  /// A round that leaves more than this share of the violation is the last one, too.
  static constexpr double stagnation = 0.9;
  /// Rounds that shrink the violation by less than this are no fixed-point iteration worth going on
  /// with: from then on corrections are added up (engine/solvers/row_system.h).
  static constexpr double slow = 0.5;
  /// The same once the violation is larger by this than that of the first round, whatever the
  /// features decide meanwhile.
  static constexpr double growth = 10.0;
  /// Where bodies turn by no more than this in a substep [rad] the first round mostly is all there
  /// is, and gradients that are this much off are none the worse.
  static constexpr double least_swing = 1e-6;

  /// What is left of the violation that the first round found counts as no solution above this
  /// share: of how far it would move anything.
  static constexpr double nearly = 1e-5;
  /// Corrections that have been added up can end far from implicit Euler, on another side of a
  /// short swing. It makes no energy; what makes more than this share of the kinetic energy counts
  /// as no solution, either.
  static constexpr double unresolved = 1e-2;
  /// Nor does what is off by more than this share of the forces on a body: a tenth of what a
  /// certificate doubts.
  static constexpr double unbalanced = 1e-3;

  void solve(Substep& substep, Features features);

  /// Whether rounds have moved bodies out of all measure: their rows nearly depend on each other.
  [[nodiscard]] static bool runs_away(const Substep& substep, double violated, double first);

 private:
  /// What rounds have come to: the violation that is left, that of the round before and of the
  /// first one, and how far what was left and that of the first one would move anything.
  struct Course {
    double violated = 0.0;
    double before = 0.0;
    double first = 0.0;
    double off = 0.0;
    double first_off = 0.0;
    bool adding_up = false;  ///< corrections were added up
  };
  /// Whether the substep has failed, and what is counted if not.
  void end_rounds(Substep& substep, Features features, Course course);

  /// How far off what counts as near a solution is, where the first round has found `first`.
  [[nodiscard]] static double left_at_most(const Substep& substep, double first);
  /// No active set was found: makes do, or leaves the substep to Gauss-Seidel, if it has to.
  void give_up(Substep& substep, Features features, bool adding_up);
  /// Goes to where rows are violated least; false if it cannot.
  bool make_do(Substep& substep, Features features, bool adding_up);

  /// Where rows are met: whether the bodies are there, too, to where they are then moved. `astray`
  /// is how far they were off when this was last asked, infinite at first, and becomes how far they
  /// are.
  bool arrives(Substep& substep, double& astray) const;

  /// Whether all rows tell that what solve() has found turns them by no more than rounding: another
  /// look at them would find what they have told.
  bool leaves_nothing(const Substep& substep);

  /// Corrections that have been added up have moved bodies along the gradients of each round's
  /// start, and what acts at the end would have moved them elsewhere. Goes on from there with
  /// rounds that begin at the prediction, and goes back if they do not converge. Whether they have.
  /// `imbalance` becomes what the forces were off by (RowSystem::imbalance()).
  bool confirm(Substep& substep, Features features, Course& course, double& imbalance);

  RowSystem system_;
  KeptPlace added_up_;
  GaussSeidelSolver sweeps_;
  LeastViolation least_;
};

}  // namespace sheave
