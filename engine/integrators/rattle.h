#pragma once
// The integrator `rattle`: RATTLE (Andersen 1983) on constraint rows.
//
//   v_half = v0 + h/2 M^-1 f + J(x0)^T l / h,   x1 = x0 + h v_half,   C(x1) = 0,   l >= 0 where C pulls one way
//   v1 = v_half + h/2 M^-1 f + J(x1)^T m,       J(x1) v1 + dC/dt = 0,  m >= 0 likewise
//
// Multipliers act along the gradients of the start in the first half of the substep, and along the
// gradients of the end in the second half. The map is therefore its own inverse under reversal of
// time, and of second order; the energy neither grows nor decays. The mean force of the substep, l
// / h^2 + m / h, is the force at its middle to second order.
//
// - The positions are those of xpbd for half the load with frozen gradients: x1 = x* + W J(x0)^T l.
//   Newton's matrix J(x) W J(x0)^T is not symmetric.
// - A row with compliance has the force of the middle of the substep, F = 2 l / h^2, in both halves
//   (engine/solvers/row_system.h). This rule conserves the energy of linear springs and is stable
//   for all stiffnesses.
// - A row that closes in a substep stops the closing motion: an inelastic impact. No row makes
//   energy.
// - Free rotation is an explicit midpoint step that conserves the angular momentum
//   (engine/integrators/xpbd.cpp).
// - Substeps in which bodies meet and rebound are done by xpbd, whose impulses act at the poses of
//   the end.
// - The substep has failed if no l brings C(x1) to 0. A swing by a right angle in one substep has
//   no such l. The substep has also failed if forces that do no work have done more than a share of
//   the kinetic energy: the gradient of a row that turns far in a substep differs in the middle
//   from the gradients at both ends. The driver then cuts the substep into smaller ones. A smallest
//   part that fails is done by xpbd, and counted.

#include "engine/solvers/direct.h"
#include "engine/solvers/row_system.h"
#include "engine/solvers/velocity_system.h"
#include "engine/step_settings.h"

namespace sheave {

/// Solver of the constraints for this integrator, with its scratch.
class RattleSolver {
 public:
  /// Work of forces that should do none, as a share of the kinetic energy, above which a substep
  /// has failed. A row that turns by an angle a in the substep does work of about a^3 of the
  /// kinetic energy.
  static constexpr double unresolved = 1e-2;

  explicit RattleSolver(SolverKind solver) : solver_(solver) {}

  /// To be called before any body moves.
  void begin(Substep& substep, Features features);
  /// To be called after the prediction: moves the bodies to x1, or does the substep by xpbd.
  void solve_positions(Substep& substep, Features features);
  /// To be called after the second half of the loads.
  void solve_velocities(Substep& substep, Features features);

 private:
  [[nodiscard]] bool try_positions(Substep& substep, Features features);
  /// Solves round number `round`, counted from 0, of Newton's method; false if it has no solution.
  bool solve_round(Substep& substep, int round);
  /// Whether rounds that end with the violation `violated` have found a solution; counts the
  /// solution. `first`: the violation of the first round. `off`, `first_off`: the displacements of
  /// both.
  bool found(Substep& substep, double violated, double first, double off, double first_off) const;

  SolverKind solver_;
  RowSystem positions_;
  VelocitySystem velocities_;
  DirectSolver direct_;
  GaussSeidelSolver sweeps_;
};

}  // namespace sheave
