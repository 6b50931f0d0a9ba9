#pragma once
// The integrator `rattle`: RATTLE (Andersen 1983) on constraint rows.
//
//   v_half = v0 + h/2 M^-1 f + J(x0)^T l / h,   x1 = x0 + h v_half,   C(x1) = 0,   l >= 0 where C pulls one way
//   v1 = v_half + h/2 M^-1 f + J(x1)^T m,       J(x1) v1 + dC/dt = 0,  m >= 0 likewise
//
// Multipliers act along the gradients of the start in the first half and of the end in the second,
// so the map is its own inverse with time reversed: second order, and energy that neither grows nor
// dies away. The mean force of the substep, l / h^2 + m / h, is the force at its middle to second
// order.
//
// - The positions are those that xpbd finds for half the load with frozen gradients: x1 = x* + W J(x0)^T l. Newton's
//   matrix is J(x) W J(x0)^T, not symmetric.
// - A row with compliance has the force of the middle of the substep, F = 2 l / h^2, in both halves
//   (engine/solvers/row_system.h): it conserves the energy of linear springs and is stable for any of them.
// - A row that closes in a substep stops the motion against it: an inelastic impact. No row makes energy.
// - Free rotation is an explicit midpoint step that conserves the angular momentum (engine/integrators/xpbd.cpp).
// - A substep in which bodies meet and rebound is done by xpbd, whose impulses act where bodies are at its end.
// - Where no l brings C(x1) to 0 (a swing of a right angle in one substep has no such l) the substep has failed, and so it
//   has where forces that do no work have done more than a share of the kinetic energy: rows that turn far in a substep
//   have another gradient in its middle than at either end. What cannot be cut any smaller is done by xpbd, and counted.

#include "engine/solvers/direct.h"
#include "engine/solvers/row_system.h"
#include "engine/step_settings.h"

namespace sheave {

/// The constraint part of the integrator and its scratch.
class RattleSolver {
 public:
  /// Work of workless forces above which a substep counts as failed, as a share of the kinetic
  /// energy. Rows that turn by an angle a in the substep do about a^3 of it.
  static constexpr double unresolved = 1e-2;

  explicit RattleSolver(SolverKind solver) : solver_(solver) {}

  /// Before anything moves.
  void begin(Substep& substep, Features features);
  /// After the prediction: moves the bodies to x1, or does the substep by xpbd.
  void solve_positions(Substep& substep, Features features);
  /// After the second half of the loads.
  void solve_velocities(Substep& substep, Features features);

 private:
  [[nodiscard]] bool try_positions(Substep& substep, Features features);
  /// Whether rounds that have left this violation, of what the first one found, are a solution;
  /// counts it if so.
  bool found(Substep& substep, double violated, double first, double off, double first_off) const;

  SolverKind solver_;
  RowSystem positions_;
  RowSystem velocities_;
  DirectSolver direct_;
  GaussSeidelSolver sweeps_;
};

}  // namespace sheave
