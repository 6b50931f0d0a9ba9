#pragma once

#include <cstdint>

namespace sheave {

/// Observations of a step: sums and maxima over its substeps.
struct StepStatistics {
  int rows = 0;                 ///< constraint rows solved per substep
  std::int64_t row_solves = 0;  ///< rows x iterations x substeps
  /// Largest correction, as a residual of a row, in the last sweep or round of a substep [m or
  /// rad]: the distance from convergence.
  double last_correction = 0.0;
  /// Number of times that a feature used a substitute because its geometry has no solution (a span
  /// without a tangent). The feature's report has the details.
  int geometry_fallbacks = 0;
  // The following counts belong to the direct solver and to `rattle`.
  /// Linear problems solved or swept over by Gauss-Seidel: rounds of Newton's method, and the
  /// velocities of `rattle`.
  std::int64_t rounds = 0;
  /// Rows added to or removed from the active set during its search.
  std::int64_t set_changes = 0;
  /// Factorisations of the search for the active set, at least one per round.
  std::int64_t factorisations = 0;
  /// Substeps left to Gauss-Seidel because no active set was found, for positions or for
  /// velocities.
  std::int64_t solver_fallbacks = 0;
  int redundant_rows = 0;  ///< the most in one round
  /// Rounds in which all rows gave way because rows contradicted each other (two drives of one
  /// coordinate).
  std::int64_t compromises = 0;
  /// With `direct`: substeps, or parts, with violated rows that no body can yield to. The
  /// prescribed motion is impossible (a rigid cable between two bodies that are driven apart).
  std::int64_t impossible = 0;
  double most_impossible = 0.0;  ///< largest residual of such rows [m or rad]
  /// With `direct`: substeps that end in a singular configuration: no pose nearby satisfies all
  /// rows, although their bodies can yield (engine/solvers/least_violation.h). `most_impossible`
  /// includes these substeps.
  std::int64_t dead_ends = 0;
  // Contacts between bodies.
  int contacts = 0;              ///< most points in one substep, including those about to touch
  double deepest_overlap = 0.0;  ///< [m]
  std::int64_t integrator_fallbacks = 0;  ///< substeps of `rattle` left to `xpbd`
  /// Work of the forces and torques that a program has set on bodies [J]
  double external_work = 0.0;
  // Substeps that did not converge (engine/substep_driver.h).
  std::int64_t cut_substeps = 0;   ///< substeps done in smaller parts
  std::int64_t substep_parts = 0;  ///< number of these parts
  /// Substeps, or parts, whose constraints are violated at the end although smaller parts have been
  /// tried.
  std::int64_t unconverged = 0;
  /// Substeps that used up their allowed rounds or factorisations before all parts were done, and
  /// were then done as a whole.
  std::int64_t exhausted = 0;
  /// Substeps, or parts, at whose end the forces of the instant are unknown, because a trial motion
  /// does not converge (engine/instant_forces.h). Mean forces have decided there.
  std::int64_t unknown_forces = 0;
  /// Energy that `xpbd` has taken from the vibration of elastic cables by numerical damping [J];
  /// the cables' own damping is not included.
  double numerical_damping = 0.0;
  // With a tolerance (engine/step_size.h):
  std::int64_t kept_substeps = 0;     ///< substeps that make up the motion
  std::int64_t undone_substeps = 0;   ///< substeps that were done for comparison, or were too long
  std::int64_t missed_tolerance = 0;  ///< kept substeps whose error is too large, but no shorter
                                      ///< ones were allowed
  double missed_error = 0.0;          ///< largest estimated error of one of these [m]
  double missed_time = 0.0;           ///< end of that substep [s]
  int missed_body = -1;               ///< index of the body with that error; -1: none
  // Of events whose instant is only known to lie within a substep, or within the bracket of a search:
  std::int64_t bracketed_events = 0;
  double event_distance = 0.0;  ///< sum of length x jump of a velocity [m]
  double event_speed = 0.0;     ///< sum of length x jump of an acceleration [m/s]
};

}  // namespace sheave
