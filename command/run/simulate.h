#pragma once
// Steps a simulation to its end, or to where it has to stop.

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
  double last_correction = 0.0;  ///< the largest of all steps [m or rad]
  std::int64_t geometry_fallbacks = 0;
  // Of the direct solver and of `rattle`.
  std::int64_t rounds = 0;
  std::int64_t set_changes = 0;
  std::int64_t factorisations = 0;
  std::int64_t solver_fallbacks = 0;      ///< substeps left to Gauss-Seidel
  int redundant_rows = 0;                 ///< the most in one round
  std::int64_t compromises = 0;           ///< rounds in which rows contradicted each other
  std::int64_t impossible = 0;            ///< substeps with rows off that nothing can move
  std::int64_t dead_ends = 0;             ///< substeps near which nothing satisfies all rows
  double most_impossible = 0.0;           ///< by how much [m or rad]
  std::int64_t integrator_fallbacks = 0;  ///< substeps of `rattle` left to `xpbd`
  std::int64_t cut_substeps = 0;          ///< done in smaller parts
  std::int64_t substep_parts = 0;         ///< in how many, all together
  std::int64_t unconverged = 0;           ///< substeps or parts whose constraints are not met
  std::int64_t exhausted = 0;             ///< substeps whose parts took all the work they may
  int contacts = 0;                       ///< the most points in one substep
  double deepest_overlap = 0.0;           ///< of bodies that touch [m]
  double numerical_damping = 0.0;         ///< of elastic cables' vibration, by `xpbd`, in all [J]
  Energy energy;                          ///< now
};

/// What a run came to.
struct RunOutcome {
  RunStatus status = RunStatus::done;
  std::optional<Divergence> divergence;  ///< set if diverged
  std::int64_t steps = 0;                ///< complete steps of this run
  double step_time = 0.0;                ///< wall time spent in steps alone [s]
  double wall_time = 0.0;                ///< including observers [s]
  RunStatistics statistics;
  Certificate certificate;  ///< of the steps that were checked
};

/// Steps until `last_step` steps are complete, the state diverges, a signal comes or `time_is_over`
/// says so, which both are looked at within steps, too: the state is then that of the last complete
/// step. Calls `observe` with what the steps did so far, at the start and after every step; it may
/// return false to stop early, which counts as done.
RunOutcome simulate(Simulation& simulation, std::int64_t last_step, Progress& progress,
                    const std::function<bool(const RunStatistics&)>& observe,
                    const StopRequest& time_is_over = {});

}  // namespace sheave::command
