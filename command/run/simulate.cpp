#include "command/run/simulate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "command/interrupt.h"

namespace sheave::command {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void accumulate(const StepStatistics& step, RunStatistics& total) {
  total.rows = std::max(total.rows, step.rows);
  total.last_correction = std::max(total.last_correction, step.last_correction);
  total.geometry_fallbacks += step.geometry_fallbacks;
  total.row_solves += step.row_solves;
  total.rounds += step.rounds;
  total.set_changes += step.set_changes;
  total.factorisations += step.factorisations;
  total.solver_fallbacks += step.solver_fallbacks;
  total.compromises += step.compromises;
  total.impossible += step.impossible;
  total.dead_ends += step.dead_ends;
  total.most_impossible = std::max(total.most_impossible, step.most_impossible);
  total.redundant_rows = std::max(total.redundant_rows, step.redundant_rows);
  total.integrator_fallbacks += step.integrator_fallbacks;
  total.cut_substeps += step.cut_substeps;
  total.substep_parts += step.substep_parts;
  total.unconverged += step.unconverged;
  total.exhausted += step.exhausted;
  total.unknown_forces += step.unknown_forces;
  total.contacts = std::max(total.contacts, step.contacts);
  total.numerical_damping += step.numerical_damping;
  total.kept_substeps += step.kept_substeps;
  total.undone_substeps += step.undone_substeps;
  total.missed_tolerance += step.missed_tolerance;
  total.deepest_overlap = std::max(total.deepest_overlap, step.deepest_overlap);
}

std::function<void()> both(std::function<void()> first, const std::function<void()>& second) {
  if (!second) return first;
  if (!first) return second;
  return [first = std::move(first), &second] {
    first();
    second();
  };
}

}  // namespace

std::string_view name_of(RunStatus status) {
  constexpr std::array<std::string_view, 4> names{"done", "diverged", "interrupted", "time limit"};
  return names[static_cast<std::size_t>(status)];
}

RunOutcome simulate(Simulation& simulation, std::int64_t last_step, Progress& progress,
                    const std::function<bool(const RunStatistics&)>& observe,
                    const StopRequest& time_is_over, const std::function<void()>& look) {
  RunOutcome outcome;
  World& world = simulation.world;
  const Clock::time_point start = Clock::now();
  RunCheck check(simulation);
  outcome.statistics.energy = check.energy();
  const StopRequest stop = [&] {
    if (interrupted()) {
      outcome.status = RunStatus::interrupted;
    } else if (time_is_over && time_is_over()) {
      outcome.status = RunStatus::time_limit;
    }
    return outcome.status != RunStatus::done;
  };
  bool wanted = observe(outcome.statistics);
  while (wanted && world.state().steps < last_step) {
    const Clock::time_point step_start = Clock::now();
    StepReport report = simulation.step(stop, both(check.within(simulation), look), {});
    if (report.stopped) break;
    outcome.step_time += seconds_since(step_start);
    accumulate(report.statistics, outcome.statistics);
    if (!report.ok()) {
      outcome.status = RunStatus::diverged;
      outcome.divergence = std::move(report.divergence);
      break;
    }
    ++outcome.steps;
    if (simulation.supervisor != nullptr && simulation.supervisor->has_stopped(world.state())) {
      last_step = world.state().steps;
    }
    check.observe(simulation, report.statistics, world.state().steps >= last_step);
    outcome.statistics.energy = check.energy();
    wanted = observe(outcome.statistics);
    if (progress.due()) {
      progress.update(static_cast<double>(world.state().steps),
                      fmt::format("t = {:.4g} s", world.state().time));
    }
  }
  outcome.certificate = check.certificate();
  outcome.statistics.energy_taken = check.energy_taken();
  outcome.statistics.energy_exchanged = check.energy_exchanged();
  outcome.wall_time = seconds_since(start);
  return outcome;
}

}  // namespace sheave::command
