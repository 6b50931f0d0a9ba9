// sheave stress: running the cells of stability maps.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/state_file.h"
#include "command/interrupt.h"
#include "command/run/checker.h"
#include "command/run/summary.h"
#include "command/scene_options.h"
#include "command/stress/table.h"
#include "measure/similarity.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/suggestion.h"

namespace sheave::command {
namespace {

using measure::StressKind;
using measure::StressVerdict;

/// Computes the error against the run to which this run must be similar.
void compare(const measure::StressCell& cell, const StressSettings& settings, const Scene& scene,
             StressVerdict& verdict) {
  const SceneResult original = cell.original(settings.solver, settings.integrator);
  if (!original) return;
  const Result<double> error = measure::similarity_error(scene, *original, cell.length_factor,
                                                         cell.mass_factor, interrupted);
  if (!error) return;
  verdict.error = *error;
  verdict.detail = "differs from the run of the original scene";
  if (verdict.kind == StressKind::right && verdict.error > measure::stress_error_limit) {
    verdict.kind = StressKind::wrong;
  }
}

/// Gives the scene of a cell the state of --load-state. Returns why the cell cannot have it.
std::string add_start_state(const measure::StressCell& cell, Scene& scene) {
  if (cell.load_state.empty()) return "";
  if (!cell.similar_to.empty()) {
    return "a saved state is of one size and one mass; start at rest (--from-rest) for these maps";
  }
  try {
    scene.start_state = read_state(scene, cell.load_state, false);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

/// Runs the cell's scene as `sheave run` does, and collects its messages.
StressOutcome run_cell(const measure::StressCell& cell, const StressSettings& settings) {
  SceneResult scene = cell.scene(settings.solver, settings.integrator);
  std::string fault;
  if (!scene) {
    fault = scene.errors.empty() ? "is no valid scene" : to_string(scene.errors.front());
  } else {
    fault = add_start_state(cell, *scene.scene);
  }
  if (!fault.empty()) return {{StressKind::refused, std::nan(""), fault}, {}, {}};
  Result<Simulation> simulation = create_simulation(*scene);
  if (!simulation)
    return {{StressKind::refused, std::nan(""), to_text(simulation.errors())}, {}, {}};
  measure::StressJudge judge(*scene, *simulation);
  const std::int64_t steps = step_count(*scene);
  RunMonitor monitor(steps);
  Progress none("", 0.0, 1.0, true);
  const RunOutcome run = simulate(*simulation, steps, none, [&](const RunStatistics& so_far) {
    judge.observe(*simulation);
    monitor.observe(*simulation, so_far);
    return true;
  });
  monitor.finish(*simulation, run.statistics, measure::is_conservative(*scene));
  if (run.status == RunStatus::interrupted) throw Failure(ExitCode::interrupted, "interrupted");
  StressOutcome outcome{judge.verdict(*simulation, run.divergence), {}, {}};
  if (!cell.similar_to.empty() && !run.divergence) compare(cell, settings, *scene, outcome.verdict);
  if (interrupted()) throw Failure(ExitCode::interrupted, "interrupted");
  for (const Warning& warning : collect_warnings(*scene, *simulation, run.statistics, monitor)) {
    outcome.warnings.push_back(warning.kind);
  }
  if (!run.certificate.clean(default_trust)) {
    outcome.doubt = doubt_text(run.certificate, default_trust);
  }
  return outcome;
}

/// Sort key of outcomes: silent failures first, then by error.
double badness(const StressOutcome& outcome) {
  const double error = outcome.verdict.error;
  const double size = std::isfinite(error) ? std::log10(std::clamp(error, 1e-20, 1e20)) : 21.0;
  return size + (outcome.silent() ? 1000.0 : 0.0);
}

}  // namespace

std::string StressSettings::name() const {
  return fmt::format("{} + {}", solver_names[static_cast<std::size_t>(solver)],
                     integrator_names[static_cast<std::size_t>(integrator)]);
}

int StressResult::count(StressKind kind) const {
  return static_cast<int>(
      std::count_if(outcomes.begin(), outcomes.end(),
                    [&](const StressOutcome& outcome) { return outcome.verdict.kind == kind; }));
}

int StressResult::silent() const {
  return static_cast<int>(
      std::count_if(outcomes.begin(), outcomes.end(),
                    [](const StressOutcome& outcome) { return outcome.silent(); }));
}

int StressResult::failed() const {
  return static_cast<int>(
      std::count_if(outcomes.begin(), outcomes.end(),
                    [](const StressOutcome& outcome) { return outcome.verdict.failed(); }));
}

double StressResult::worst_error() const {
  double worst = 0.0;
  for (const StressOutcome& outcome : outcomes) {
    const StressVerdict& verdict = outcome.verdict;
    if (verdict.kind == StressKind::refused || verdict.kind == StressKind::diverged) continue;
    worst = std::max(worst, verdict.error);
  }
  return worst;
}

std::vector<std::size_t> StressResult::worst(std::size_t most) const {
  std::vector<std::size_t> failed;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].verdict.failed()) failed.push_back(i);
  }
  std::stable_sort(failed.begin(), failed.end(), [&](std::size_t a, std::size_t b) {
    return badness(outcomes[a]) > badness(outcomes[b]);
  });
  failed.resize(std::min(failed.size(), most));
  return failed;
}

std::vector<measure::StressMap> choose_maps(const StressOptions& options) {
  std::vector<measure::StressMap> maps;
  const measure::StressRange range{options.quick};
  if (options.scene.path.empty()) {
    maps = measure::standard_stress_maps(range);
    for (measure::StressMap& map : measure::built_in_stress_maps(range)) {
      maps.push_back(std::move(map));
    }
  } else {
    if (options.scene.path == "-") {
      throw Failure(ExitCode::usage, "stress reads a scene many times; it needs a file");
    }
    static_cast<void>(load(options.scene));  // its failure tells the fault
    std::vector<Override> start;
    if (options.scene.from_rest) start.push_back({"/start", "rest", "--from-rest"});
    Result<std::vector<measure::StressMap>> made =
        measure::scene_stress_maps(options.scene.path, range, start);
    if (!made) throw Failure(ExitCode::bad_scene, to_text(made.errors()));
    maps = std::move(made).value();
    for (measure::StressMap& map : maps) {
      for (measure::StressCell& cell : map.cells) cell.load_state = options.scene.load_state;
    }
  }
  if (options.map.empty()) return maps;
  Suggestion suggestion(options.map);
  std::string names;
  for (measure::StressMap& map : maps) {
    if (map.name == options.map) return {std::move(map)};
    suggestion.consider(map.name);
    names += (names.empty() ? "" : ", ") + map.name;
  }
  throw Failure(ExitCode::usage, fmt::format("--map {}: there is no such map{}; there are: {}",
                                             options.map, suggestion.question(), names));
}

std::vector<StressResult> measure_stress(const StressOptions& options) {
  const std::vector<measure::StressMap> maps = choose_maps(options);
  std::size_t cells = 0;
  for (const measure::StressMap& map : maps) cells += map.cells.size() * options.settings.size();
  Progress progress("stress", 0.0, static_cast<double>(cells), false);
  std::size_t done = 0;
  std::vector<StressResult> results;
  for (const measure::StressMap& map : maps) {
    for (const StressSettings& settings : options.settings) {
      StressResult& result = results.emplace_back(StressResult{map, settings, {}});
      for (const measure::StressCell& cell : map.cells) {
        result.outcomes.push_back(run_cell(cell, settings));
        progress.update(static_cast<double>(++done), map.name + ", " + settings.name());
      }
    }
  }
  return results;
}

}  // namespace sheave::command
