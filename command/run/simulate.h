#pragma once
// Steps a simulation to its end, or to the step at which it must stop.

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "cable/run_check.h"
#include "cable/simulation.h"
#include "command/progress.h"

namespace sheave::command {

/// How a simulation ended.
enum class RunStatus { done, diverged, interrupted, time_limit };
/// "done", "diverged", "interrupted", "time limit".
[[nodiscard]] std::string_view name_of(RunStatus status);

/// StepStatistics of a whole run.
struct RunStatistics {
  int rows = 0;  ///< constraint rows per substep
  std::int64_t row_solves = 0;
  double last_correction = 0.0;  ///< largest correction of all steps [m or rad]
  std::int64_t geometry_fallbacks = 0;
  // For the direct solver and for `rattle`:
  std::int64_t rounds = 0;
  std::int64_t set_changes = 0;
  std::int64_t factorisations = 0;
  std::int64_t solver_fallbacks = 0;  ///< substeps left to Gauss-Seidel
  int redundant_rows = 0;             ///< largest number in one round
  std::int64_t compromises = 0;       ///< rounds with contradictory rows
  std::int64_t impossible = 0;        ///< substeps with residuals that no body can reduce
  /// Substeps near a singular configuration, where no state satisfies all rows.
  std::int64_t dead_ends = 0;
  double most_impossible = 0.0;           ///< largest such residual [m or rad]
  std::int64_t integrator_fallbacks = 0;  ///< substeps of `rattle` left to `xpbd`
  std::int64_t cut_substeps = 0;          ///< substeps done in smaller parts
  std::int64_t substep_parts = 0;         ///< total number of those parts
  std::int64_t unconverged = 0;           ///< substeps or parts with unmet constraints
  std::int64_t exhausted = 0;             ///< substeps whose parts used up the work limit
  std::int64_t unknown_forces = 0;        ///< substeps without the forces of their last instant
  int contacts = 0;                       ///< largest number of points in one substep
  double deepest_overlap = 0.0;           ///< deepest penetration of touching bodies [m]
  double numerical_damping = 0.0;         ///< energy of cable vibrations removed by `xpbd` [J]
  std::int64_t kept_substeps = 0;         ///< with a tolerance: substeps of the motion
  std::int64_t undone_substeps = 0;       ///< with a tolerance: substeps done to choose lengths
  std::int64_t missed_tolerance = 0;      ///< kept substeps with too large an error
  Energy energy;                          ///< energy at the last step
  // Set at the end of the run:
  double energy_taken = 0.0;      ///< RunCheck::energy_taken() [J]
  double energy_exchanged = 0.0;  ///< RunCheck::energy_exchanged() [J]
};

/// The outcome of a run.
struct RunOutcome {
  RunStatus status = RunStatus::done;
  std::optional<Divergence> divergence;  ///< set if diverged
  std::int64_t steps = 0;                ///< complete steps of this run
  double step_time = 0.0;                ///< wall time of the steps alone [s]
  double wall_time = 0.0;                ///< wall time including observers [s]
  RunStatistics statistics;
  Certificate certificate;  ///< over the checked steps
};

/// Steps until `last_step` steps are complete, the state diverges, a signal comes, or
/// `time_is_over` returns true. The last two are also polled within a step; the state is then that
/// of the last complete step. Calls `observe` with the statistics so far, at the start and after
/// every step. `observe` may return false to stop early, which counts as done. Calls `look` after
/// substeps within steps, if given.
RunOutcome simulate(Simulation& simulation, std::int64_t last_step, Progress& progress,
                    const std::function<bool(const RunStatistics&)>& observe,
                    const StopRequest& time_is_over = {}, const std::function<void()>& look = {});

}  // namespace sheave::command
