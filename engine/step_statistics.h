#pragma once

#include <cstdint>

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
  /// With `direct`: substeps, or parts, in which rows were off that nothing can move: prescribed
  /// motion asks for what cannot be (a rigid cable between two bodies that are driven apart).
  std::int64_t impossible = 0;
  double most_impossible = 0.0;  ///< by how much the worst of them was off [m or rad]
  /// With `direct`: substeps at whose end nothing near satisfies all rows, though they do yield
  /// (engine/solvers/least_violation.h); `most_impossible` is of these, too.
  std::int64_t dead_ends = 0;
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

}  // namespace sheave
