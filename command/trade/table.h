#pragma once
// Speed against accuracy of one scene, as data: the results that `sheave trade` measures, prints
// and selects from.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command/machine_info.h"
#include "command/output/gnuplot_script.h"
#include "command/scene_options.h"
#include "command/text/error_text.h"
#include "measure/error_growth.h"
#include "measure/model_rung.h"
#include "measure/reference_run.h"
#include "measure/spread.h"
#include "measure/work_precision.h"

namespace sheave::command {

/// The varied settings. Combinations with equal effect are run once. No list may be empty.
struct TradeGrid {
  std::vector<int> substeps{1, 2, 4, 8, 16, 32};
  std::vector<int> iterations{1, 10,
                              100};  ///< of Gauss-Seidel; the direct solver keeps the scene's
  std::vector<SolverKind> solvers{SolverKind::gauss_seidel, SolverKind::direct};
  std::vector<IntegratorKind> integrators{IntegratorKind::xpbd, IntegratorKind::rattle};
  /// For all cables; without effect in a scene without cables.
  std::vector<TangentUpdate> tangents{TangentUpdate::iteration, TangentUpdate::substep};
  /// With the direct solver and `rattle`, in place of numbers of substeps; none if it is empty.
  std::vector<GivenTolerance> tolerances{{1e-2, true}, {1e-3, true}, {1e-4, true}, {1e-5, true}};
};

/// One combination of settings for the scene.
struct TradeSetting {
  StepSettings step;
  std::optional<TangentUpdate> tangents;  ///< nullopt: the scene has no cables

  /// "gauss-seidel 4 x 10, rattle, tangents per substep".
  [[nodiscard]] std::string name() const;
  /// The scene with this setting.
  [[nodiscard]] Scene applied(const Scene& scene) const;
};

/// All settings of a grid for a scene, in the grid's order. Tolerances beyond the range that a scene
/// allows are left out.
[[nodiscard]] std::vector<TradeSetting> trade_settings(const TradeGrid& grid, const Scene& scene);

struct TradeRow {
  TradeSetting setting;
  std::string fault;    ///< why there are no numbers; empty if there are
  std::string skipped;  ///< why it was not run (not enough time left); empty if it was run
  double expected_seconds = 0.0;  ///< CPU time of a run, predicted from the first frames
  double run_seconds = 0.0;       ///< CPU time of the run that gave the error
  /// CPU time per simulated second. One sample only if more cannot bring the setting to the front.
  measure::Spread seconds;
  /// Whether the time was measured with nothing else running. Otherwise it is the time of the run
  /// that gave the error.
  bool timed_alone = false;
  /// Positions and tensions: within TradeTable::compared_seconds; tensions are NaN without cables.
  /// Energy: over the whole run; NaN if the reference's energy is rounding.
  measure::RunError error;
  double stretch = 0.0;        ///< measure::Trajectory::stretch
  double length_error = 0.0;   ///< measure::Trajectory::length_error
  double row_solves = 0.0;     ///< per simulated second
  std::int64_t fallbacks = 0;  ///< measure::Trajectory::fallbacks
  bool on_front = false;       ///< no other row is both faster and as accurate

  [[nodiscard]] bool measured() const { return fault.empty() && skipped.empty(); }
};

/// Error and saved time of one change of the model.
struct LadderRow {
  std::string name, things, change;  ///< those of the measure::ModelRung
  int changed = 0;                   ///< number of changed things
  std::string fault;  ///< why there are no numbers (no valid scene, diverged); empty if there are
  /// Difference from the scene as written with the same setting, within the compared time.
  measure::ModelDifference difference{};
  measure::Spread seconds{};  ///< CPU time per simulated second
  double row_solves = 0.0;    ///< per simulated second
};

/// The scene with one effect at a time changed, all with one setting.
struct TradeLadder {
  TradeSetting setting;
  double setting_error = 0.0;  ///< bound of its position error in the scene as written
  measure::Spread seconds;     ///< of the scene as written
  double row_solves = 0.0;     ///< of the scene as written
  std::vector<LadderRow> rows;
  std::vector<std::string> absent;  ///< names of the rungs that change nothing in this scene
  std::string skipped;              ///< why there are no rows; empty if there are
};

/// Convergence of one solver and integrator with the step.
struct TradeFamily {
  std::string name;
  std::optional<measure::FittedOrder> fit;
};

struct TradeTable {
  std::string scene;  ///< name of the scene, or of its file
  double dt = 0.0;    ///< time of a frame [s]
  double simulated_seconds = 0.0;
  /// Time up to which positions and tensions are compared [s]; less than the whole run if the
  /// reference is not valid later.
  double compared_seconds = 0.0;
  measure::Reference reference;      ///< without its frames
  measure::RunError doubt;           ///< the reference's own error within the compared time
  double motion = 0.0;               ///< measure::motion_of the reference within the compared time
  std::optional<double> chaos_rate;  ///< measure::ErrorGrowth::rate
  std::vector<TradeRow> rows;
  std::vector<TradeFamily> families;
  std::optional<TradeLadder> ladder;  ///< nullopt: not requested
  std::vector<std::string> limits;    ///< work omitted for lack of time, one line each
  MachineInfo machine;
  std::string version;
  int repetitions = 0;
  double most_minutes = 0.0;  ///< time budget given to the command

  /// Whether the reference's tensions are known to a tenth of their mean. Where bodies collide
  /// their tensions are not: the tension of a substep grows there as the substep shrinks. True
  /// without cables.
  [[nodiscard]] bool tensions_known() const;
  // Upper bounds of the errors: the row's error plus the reference's.
  [[nodiscard]] double position_bound(const TradeRow& row) const;
  [[nodiscard]] double tension_bound(const TradeRow& row) const;  ///< 0 without cables
  /// The larger of both bounds; the position bound alone if tensions are not known.
  [[nodiscard]] double bound(const TradeRow& row) const;
  /// Cost in seconds per simulated second and bound() of each row.
  [[nodiscard]] std::vector<measure::WorkPoint> points() const;
};

struct TradeOptions {
  TradeGrid grid;
  int repetitions = 5;
  double reference_seconds = 30.0;  ///< CPU time of one reference, approximately
  double minutes = 5.0;             ///< wall time, approximately; runs that do not fit are skipped
  int threads = 0;                  ///< threads that measure errors; 0: one per core
  bool ladder = true;               ///< whether rungs of the model are measured
  std::string resume;  ///< journal of the results (command/trade/journal.h); empty: none
  bool quiet = false;  ///< no progress bar
  measure::Clock clock;
};

/// Measures the scene. A Failure if there is no reference (75) or if a signal came (130).
[[nodiscard]] TradeTable measure_trade(const Scene& scene, const TradeOptions& options);

/// Fills in families and front of the table from its rows.
void judge(TradeTable& table);

/// A motion below this part of the scene's size makes errors relative to the size look small; the
/// report mentions such a motion.
inline constexpr double little_motion = 0.1;

/// The levels that the report names a setting for: 1 %, 0.1 %, 0.01 %.
inline constexpr std::array<double, 3> trade_levels{1e-2, 1e-3, 1e-4};

/// The report for people.
[[nodiscard]] std::string trade_text(const TradeTable& table);
/// The text of the model ladder, also part of the Markdown; empty if there is no ladder.
[[nodiscard]] std::string ladder_text(const TradeTable& table);
[[nodiscard]] std::string ladder_markdown(const TradeTable& table);
[[nodiscard]] std::string trade_markdown(const TradeTable& table);
/// One JSON object with a line break.
[[nodiscard]] std::string trade_json(const TradeTable& table);
/// A line of names, then one line per row (RFC 4180).
[[nodiscard]] std::string trade_csv(const TradeTable& table);
/// The gnuplot script of the work-precision chart.
[[nodiscard]] GnuplotScript trade_chart_script(const TradeTable& table, ChartFormat format);

/// A user's requirement: a time, or errors.
struct TradeQuestion {
  /// Largest time per frame [s]; the most accurate row answers.
  std::optional<double> seconds_per_frame{};
  /// Largest error of positions, and of tensions if these are known; the cheapest row answers.
  std::optional<double> error{};
  /// Largest error of tensions instead, whether or not these are known.
  std::optional<double> tension_error{};

  [[nodiscard]] bool asks_for_errors() const { return error || tension_error; }
};
/// "2ms/frame", "500us/frame"; a Failure (2) for anything else.
[[nodiscard]] double budget_seconds(const std::string& text);
/// "0.1%", "1e-3"; a Failure (2) for anything else, which names `option`.
[[nodiscard]] double error_share(const std::string& text, const std::string& option = "--error");
/// "position error 1.0e-03, tension error 2.0e-02". The second only if there are cables.
[[nodiscard]] std::string errors_text(const TradeTable& table, const TradeRow& row);
/// The row that answers; nullopt if none does.
[[nodiscard]] std::optional<std::size_t> answer(const TradeTable& table,
                                                const TradeQuestion& question);

}  // namespace sheave::command
