#pragma once
// Stability maps as data: the results that `sheave stress` measures, prints and draws.

#include <functional>
#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "command/scene_options.h"
#include "measure/stress_judge.h"
#include "measure/stress_map.h"

namespace sheave::command {

/// The solver and the integrator of a run.
struct StressSettings {
  SolverKind solver = SolverKind::gauss_seidel;
  IntegratorKind integrator = IntegratorKind::xpbd;
  /// "direct + rattle".
  [[nodiscard]] std::string name() const;
};

/// The outcome of one cell with one setting.
struct StressOutcome {
  measure::StressVerdict verdict;
  std::vector<std::string> warnings;  ///< kinds of warnings from `sheave run`
  std::string doubt;  ///< doubts of `sheave run` with the default trust; empty: none
  /// A wrong result that no user would notice: the run was completed without a warning, and its
  /// certificate is clean.
  [[nodiscard]] bool silent() const { return verdict.failed() && !said(); }
  /// Whether the run itself reports a problem.
  [[nodiscard]] bool said() const {
    return verdict.kind == measure::StressKind::diverged || !warnings.empty() || !doubt.empty();
  }
};

/// One map with one setting.
struct StressResult {
  measure::StressMap map;
  StressSettings settings;
  std::vector<StressOutcome> outcomes;  ///< one per cell of the map

  [[nodiscard]] int count(measure::StressKind kind) const;
  [[nodiscard]] int silent() const;
  [[nodiscard]] int failed() const;
  /// Largest error of the cells that neither diverged nor were refused.
  [[nodiscard]] double worst_error() const;
  /// Failed cells, worst first, at most `most`.
  [[nodiscard]] std::vector<std::size_t> worst(std::size_t most) const;
};

struct StressOptions {
  SceneOptions scene;                    ///< path and start; no path: the standard machines
  std::string map;                       ///< name; empty: all
  std::vector<StressSettings> settings;  ///< settings to measure
  bool quick = false;
};

/// The maps that the options choose. A Failure if no map has that name (2), or a Failure from
/// loading the scene.
[[nodiscard]] std::vector<measure::StressMap> choose_maps(const StressOptions& options);
/// Runs all cells. Shows a progress bar on a terminal. A Failure if a signal came (130).
[[nodiscard]] std::vector<StressResult> measure_stress(const StressOptions& options);

/// A report for people: a summary of each map, and the commands of the worst cells.
[[nodiscard]] std::string stress_text(const std::vector<StressResult>& results);
/// Name of the picture of a result without its ending: "atwood-direct-xpbd".
[[nodiscard]] std::string stress_chart_name(const StressResult& result);
/// All cells, as a page with a table per map. `picture` gives the path of a result's picture
/// relative to the page; empty: none.
[[nodiscard]] std::string stress_markdown(
    const std::vector<StressResult>& results,
    const std::function<std::string(const StressResult&)>& picture);
/// All cells with their commands, as one JSON object in one line.
[[nodiscard]] std::string stress_json(const std::vector<StressResult>& results);
/// A gnuplot script that draws the heat map of one result.
[[nodiscard]] GnuplotScript stress_script(const StressResult& result, ChartFormat format);

}  // namespace sheave::command
