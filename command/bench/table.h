#pragma once
// The paper's table on this machine, as data: the rows that `sheave bench` measures, prints, stores
// and compares.

#include <optional>
#include <string>
#include <vector>

#include "command/machine_info.h"
#include "command/output/gnuplot_script.h"
#include "measure/paper_table.h"
#include "measure/reference_run.h"
#include "measure/spread.h"

namespace sheave::command {

/// One scene with one setting.
struct BenchRow {
  std::string scene;       ///< its name in the paper
  std::string file;        ///< name of the scene file
  std::string cable_file;  ///< measure::PaperRow::cable_file
  int joints = 0;          ///< free spans, by our own count
  StepSettings settings;
  int paper_joints = 0;  ///< 0: the paper does not give them
  /// The time of this setting in the paper [s]. For the direct solver: the time of the scene's
  /// first row, which is the one in the paper's table.
  std::optional<double> paper_seconds;
  std::string paper_source;
  /// Reason why there are no numbers; empty if there are.
  std::string fault;

  measure::Spread seconds;             ///< per frame
  std::optional<double> instructions;  ///< per frame
  measure::RunError error;             ///< tension error is NaN if the reference is another scene
  measure::RunError reference_error;   ///< estimated error of the reference for `error`
  double stretch = 0.0;                ///< measure::Trajectory::stretch
  double length_error = 0.0;
  double row_solves = 0.0;     ///< per frame
  double rounds = 0.0;         ///< of the direct solver, per frame
  std::int64_t fallbacks = 0;  ///< measure::Trajectory::fallbacks

  [[nodiscard]] bool measured() const { return fault.empty(); }
  /// Total run time divided by the number of row solves [s].
  [[nodiscard]] double seconds_per_solve() const { return seconds.median / row_solves; }
  /// Scene and setting: the name by which rows are selected and matched.
  [[nodiscard]] std::string name() const { return scene + " " + measure::settings_text(settings); }
};

/// The reference run with which the rows of one scene were compared.
struct BenchReference {
  std::string scene;
  int substeps = 0;
  IntegratorKind integrator = IntegratorKind::rattle;
  double order = 0.0;  ///< order of convergence; NaN: unknown
  measure::RunError estimate;
  bool good = false;  ///< the reference's error is at most a tenth of every error measured with it
};

struct BenchTable {
  std::vector<BenchRow> rows;
  std::vector<BenchReference> references;
  MachineInfo machine;
  std::string version;
  int repetitions = 0;
  std::string no_instructions;  ///< reason why instructions are not counted; empty if they are
};

struct BenchOptions {
  std::string folder = "scenes/paper";
  std::string filter;  ///< part of a row's name; case does not matter
  int repetitions = 7;
  int reference_doublings = 5;      ///< largest number of doublings of the substeps
  double reference_seconds = 60.0;  ///< CPU time of one reference, approximately
};

/// Measures all rows that match the filter. Shows a progress bar on a terminal. A Failure if no row
/// matches (2), if the folder does not exist (66), or if a signal came (130).
[[nodiscard]] BenchTable measure_table(const BenchOptions& options);
/// The same rows without numbers; their fault is "not measured".
[[nodiscard]] BenchTable list_table(const BenchOptions& options);

/// A report for people, with the machine and remarks.
[[nodiscard]] std::string bench_text(const BenchTable& table);
[[nodiscard]] std::string bench_markdown(const BenchTable& table);
/// One JSON object with a line break, the format of a stored baseline.
[[nodiscard]] std::string bench_json(const BenchTable& table);

/// One row in the baseline and now.
struct BenchChange {
  std::string name;
  double before = 0.0;  ///< median time of a frame [s]
  double now = 0.0;
  /// True if the increase exceeds the allowed share and the spread: the lower quartile now is above
  /// the upper quartile of the baseline.
  bool slower = false;
  [[nodiscard]] double ratio() const { return now / before; }
};
struct BenchComparison {
  std::string path;
  std::vector<BenchChange> changes;
  std::vector<std::string> missing;  ///< rows that only one of the tables has
  std::string other_machine;         ///< machine of the baseline; empty if it is this one

  [[nodiscard]] bool any_slower() const;
};
/// Compares with a baseline from bench_json(). A Failure: 66 no such file, 65 no baseline.
[[nodiscard]] BenchComparison compare_with_baseline(const BenchTable& table,
                                                    const std::string& path, double allowed_ratio);
[[nodiscard]] std::string comparison_text(const BenchComparison& comparison);

/// Draws times and errors with gnuplot into a .png, .svg or .pdf file. A Failure: 2 another ending,
/// 74 no gnuplot or the file cannot be written.
void draw_chart(const BenchTable& table, const std::string& path);
/// The gnuplot script of the chart.
[[nodiscard]] GnuplotScript chart_script(const BenchTable& table, ChartFormat format);

}  // namespace sheave::command
