#pragma once
// Stability maps as data: what `sheave stress` measures, prints and draws.

#include <functional>
#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "measure/stress_judge.h"
#include "measure/stress_map.h"

namespace sheave::command {

/// How rows are solved and states carried on.
struct StressSettings {
  SolverKind solver = SolverKind::gauss_seidel;
  IntegratorKind integrator = IntegratorKind::xpbd;
  /// "direct + rattle".
  [[nodiscard]] std::string name() const;
};

/// What became of one cell with one setting.
struct StressOutcome {
  measure::StressVerdict verdict;
  std::vector<std::string> warnings;  ///< kinds of the warnings that `sheave run` gives
  std::string doubt;  ///< what `sheave run` calls doubtful, with its default trust; empty: nothing
  /// A wrong result that nobody would notice: the run ended well, without any warning, and its
  /// certificate is clean.
  [[nodiscard]] bool silent() const { return verdict.failed() && !said(); }
  /// Whether the run itself says that something is not as it should be.
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
  /// Largest error of cells that did not diverge and were not refused.
  [[nodiscard]] double worst_error() const;
  /// Cells that failed, the worst first, at most so many.
  [[nodiscard]] std::vector<std::size_t> worst(std::size_t most) const;
};

struct StressOptions {
  std::string scene;                     ///< empty: the standard machines
  std::string map;                       ///< name; empty: all
  std::vector<StressSettings> settings;  ///< to be measured
  bool quick = false;
};

/// The maps that the options choose. A Failure if there is none of that name (2), or as for loading
/// the scene.
[[nodiscard]] std::vector<measure::StressMap> choose_maps(const StressOptions& options);
/// Runs all cells. Shows a progress bar on a terminal; a Failure if a signal came (130).
[[nodiscard]] std::vector<StressResult> measure_stress(const StressOptions& options);

/// For people: a summary of each map, and the commands of the worst cells.
[[nodiscard]] std::string stress_text(const std::vector<StressResult>& results);
/// Name of the picture of a result, without its ending: "atwood-direct-xpbd".
[[nodiscard]] std::string stress_chart_name(const StressResult& result);
/// Every cell, as a page with a table per map. `picture` gives the path of a result's picture from
/// the page, empty: none.
[[nodiscard]] std::string stress_markdown(
    const std::vector<StressResult>& results,
    const std::function<std::string(const StressResult&)>& picture);
/// Every cell with its command, one JSON object in one line.
[[nodiscard]] std::string stress_json(const std::vector<StressResult>& results);
/// A gnuplot script that draws the heat map of one result.
[[nodiscard]] GnuplotScript stress_script(const StressResult& result, ChartFormat format);

}  // namespace sheave::command
