#pragma once
// All rows of a substep at once, by Newton's method.
//
// Each round solves the system of engine/solvers/row_system.h with XPBD's compliance and damping.
// The residual after the first round is of second order in the motion of the substep, and each
// further round squares it. Rounds end at the latest after `iterations`, or earlier under two
// conditions. First, at the place of the bodies that follows from the multipliers and the last
// gradients, no row is violated by more than `tolerance` times the scene's size. Second, the bodies
// are no farther than `across` from this place; rows do not contain the distance across them, which
// may be up to the root of the tolerance. The bodies are then moved to this place. If the rounds do
// not come near a solution, or find no active set, the substep has failed. In a substep that must
// not fail, bodies go to the place of least violation (engine/solvers/least_violation.h), or
// Gauss-Seidel goes on, which is counted.
//
// At first each round starts again from the prediction, with the gradients of the last round, so
// bodies at rest get their static forces. If bodies swing too far in a substep, such rounds stop
// converging, and corrections are added up instead. An example is a chain of light links under a
// heavy ball, whose links swing across it by more than a radian per substep.

#include "engine/solvers/gauss_seidel.h"
#include "engine/solvers/kept_place.h"
#include "engine/solvers/least_violation.h"
#include "engine/solvers/row_system.h"

namespace sheave {

class DirectSolver {
 public:
  /// Largest violation after which no further round is done, relative to the scene's size.
  static constexpr double tolerance = 1e-10;
  /// A first round from a good guess counts as the last one only if it leaves this share of
  /// `tolerance`. Newton's method squares the residual, so later rounds leave far less than they
  /// find, and a run has the accuracy of those.
  static constexpr double first_share = 0.01;
  /// The same share for rows that are looked at again after the first round from a good guess.
  static constexpr double looked_share = 0.1;
  /// The largest residual [m or rad] after which round number `round`, counted from 0, is not
  /// needed.
  [[nodiscard]] static double residual_before(int round, const RowSystem& system,
                                              const Substep& substep);
  /// Largest gap of a row that counts as closed in the solution for velocities, relative to the
  /// scene's size: far below the motion of a substep, far above the solver's residual.
  static constexpr double closed = 1e-8;
  /// Largest distance, in the same unit, between the bodies and their place by the forces of the
  /// last round along the gradients of the next one. Rows do not contain this distance, because it
  /// is across them. The bodies are then moved to that place.
  static constexpr double across = 1e-9;
  /// A round that leaves more than this share of the violation is the last one, too.
  static constexpr double stagnation = 0.9;
  /// Share of the violation that a round of the fixed-point iteration may leave. Above this share
  /// corrections are added up instead (engine/solvers/row_system.h).
  static constexpr double slow = 0.5;
  /// Corrections are also added up once the violation exceeds that of the first round by this
  /// factor, even if features have just revised their discrete states.
  static constexpr double growth = 10.0;
  /// Largest turn of a body in a substep [rad] for which the first round is mostly the only one;
  /// gradients with an error of this size are accurate enough.
  static constexpr double least_swing = 1e-6;

  /// Largest displacement of the last round that counts as near a solution, as a share of the
  /// displacement of the first round.
  static constexpr double nearly = 1e-5;
  /// Added-up corrections can end far from implicit Euler, on another side of a short swing.
  /// Implicit Euler makes no energy. A result that makes more than this share of the kinetic energy
  /// is therefore no solution.
  static constexpr double unresolved = 1e-2;
  /// A result whose forces on a body are unbalanced by more than this share is no solution, either.
  /// A certificate doubts ten times this share.
  static constexpr double unbalanced = 1e-3;

  void solve(Substep& substep, Features features);

  /// Whether rounds have moved bodies out of all measure: rows are nearly linearly dependent.
  [[nodiscard]] static bool runs_away(const Substep& substep, double violated, double first);

  /// Whether bodies that are `astray` from the place that follows from the multipliers and the
  /// gradients [m or rad] count as being there. `before`: the distance at the last call, infinite at
  /// first; becomes `astray`.
  [[nodiscard]] static bool is_there(const Substep& substep, double astray, double& before);

 private:
  /// Course of the rounds: the violations [m or rad] of the last round, of the round before and of
  /// the first one, and the displacements that belong to the last and the first violation.
  struct Course {
    double violated = 0.0;
    double before = 0.0;
    double first = 0.0;
    double off = 0.0;
    double first_off = 0.0;
    bool adding_up = false;  ///< corrections were added up
  };
  /// Decides whether the substep has failed, and counts the result if not.
  void end_rounds(Substep& substep, Features features, Course course);

  /// Largest displacement that counts as near a solution, if the first round has found `first`.
  [[nodiscard]] static double left_at_most(const Substep& substep, double first);
  /// To be called if no active set was found: accepts the least violation or Gauss-Seidel's result
  /// in a substep that must not fail.
  void give_up(Substep& substep, Features features, bool adding_up);
  /// Moves the bodies to the place of least violation; false if that fails.
  bool make_do(Substep& substep, Features features, bool adding_up);

  /// Whether the bodies are at the place that follows from the multipliers and the gradients; if
  /// so, they are moved there exactly. `astray`: distance to that place at the last call, infinite
  /// at first; becomes the distance of now.
  bool arrives(Substep& substep, double& astray) const;

  /// Whether the motion found by solve() turns no row by more than rounding, according to the rows'
  /// own derivatives. Another evaluation of the rows would then give nothing new.
  bool leaves_nothing(const Substep& substep);

  /// From now on corrections are added up. `lost`: the rounds have diverged.
  void add_up(Substep& substep, Features features, bool lost);
  /// To be called after solve() in round number `round`, counted from 0: lets forces turn with the
  /// bodies, and tells whether another evaluation of the rows would give nothing new. `yields`: rows
  /// that share a load have moved. `near`: the round did not return from a place far away, where it
  /// may have found another solution.
  bool needs_no_look(const Substep& substep, int round, bool yields, bool near);

  /// Added-up corrections have moved bodies along the gradients of each round's start; the
  /// gradients of the end would have moved them elsewhere. Goes on from there with rounds that
  /// begin at the prediction, and goes back if the rounds do not converge. Returns whether they
  /// converge. `imbalance` becomes the imbalance of the forces before (RowSystem::imbalance()).
  bool confirm(Substep& substep, Features features, Course& course, double& imbalance);

  RowSystem system_;
  KeptPlace added_up_;
  GaussSeidelSolver sweeps_;
  LeastViolation least_;
};

}  // namespace sheave
