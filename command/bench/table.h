#pragma once
// The paper's table on this machine, as data: what `sheave bench` measures, prints, keeps and
// compares.

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
  int joints = 0;          ///< free spans, as we count them
  StepSettings settings;
  int paper_joints = 0;  ///< 0: not told
  /// The paper's time of this setting [s]; of the direct solver that of the scene's first row,
  /// which is the table's.
  std::optional<double> paper_seconds;
  std::string paper_source;
  /// Why there are no numbers; empty if there are.
  std::string fault;

  measure::Spread seconds;             ///< per frame
  std::optional<double> instructions;  ///< per frame
  measure::RunError error;             ///< of tensions NaN if the reference is another scene
  measure::RunError reference_error;   ///< estimate for what `error` is measured against
  double stretch = 0.0;                ///< measure::Trajectory::stretch
  double length_error = 0.0;
  double row_solves = 0.0;     ///< per frame
  double rounds = 0.0;         ///< of the direct solver, per frame
  std::int64_t fallbacks = 0;  ///< measure::Trajectory::fallbacks

  [[nodiscard]] bool measured() const { return fault.empty(); }
  /// Time for each time a row is solved, everything included [s].
  [[nodiscard]] double seconds_per_solve() const { return seconds.median / row_solves; }
  /// Scene and setting, by which rows are chosen and found again.
  [[nodiscard]] std::string name() const { return scene + " " + measure::settings_text(settings); }
};

/// What the rows of one scene were compared with.
struct BenchReference {
  std::string scene;
  int substeps = 0;
  IntegratorKind integrator = IntegratorKind::rattle;
  double order = 0.0;  ///< NaN: not known
  measure::RunError estimate;
  bool good = false;  ///< its error is at most a tenth of all errors measured with it
};

struct BenchTable {
  std::vector<BenchRow> rows;
  std::vector<BenchReference> references;
  MachineInfo machine;
  std::string version;
  int repetitions = 0;
  std::string no_instructions;  ///< why instructions are not counted; empty if they are
};

struct BenchOptions {
  std::string folder = "scenes/paper";
  std::string filter;  ///< part of a row's name; lower and upper case alike
  int repetitions = 7;
  int reference_doublings = 5;      ///< of the substeps, at most
  double reference_seconds = 60.0;  ///< CPU time of one reference, about
};

/// Measures all rows that the filter leaves. Shows a progress bar on a terminal. A Failure if
/// nothing is left (2), if the folder does not exist (66), or if a signal came (130).
[[nodiscard]] BenchTable measure_table(const BenchOptions& options);
/// The same rows without any numbers; their fault is "not measured".
[[nodiscard]] BenchTable list_table(const BenchOptions& options);

/// For people, with the machine and remarks.
[[nodiscard]] std::string bench_text(const BenchTable& table);
[[nodiscard]] std::string bench_markdown(const BenchTable& table);
/// One JSON object with a line break; the form in which a baseline is kept.
[[nodiscard]] std::string bench_json(const BenchTable& table);

/// One row then and now.
struct BenchChange {
  std::string name;
  double before = 0.0;  ///< median time of a frame [s]
  double now = 0.0;
  /// More than what is allowed, and apart by more than the spread: the quartile below is now above
  /// the quartile above then.
  bool slower = false;
  [[nodiscard]] double ratio() const { return now / before; }
};
struct BenchComparison {
  std::string path;
  std::vector<BenchChange> changes;
  std::vector<std::string> missing;  ///< rows of one that the other does not have
  std::string other_machine;         ///< what it was measured on, if that was another machine

  [[nodiscard]] bool any_slower() const;
};
/// Compares with what bench_json() wrote. A Failure: 66 no such file, 65 no baseline.
[[nodiscard]] BenchComparison compare_with_baseline(const BenchTable& table,
                                                    const std::string& path, double allowed_ratio);
[[nodiscard]] std::string comparison_text(const BenchComparison& comparison);

/// Draws times and errors with gnuplot into a .png, .svg or .pdf file. A Failure: 2 other name, 74
/// no gnuplot or no file.
void draw_chart(const BenchTable& table, const std::string& path);
/// What gnuplot is told.
[[nodiscard]] GnuplotScript chart_script(const BenchTable& table, ChartFormat format);

}  // namespace sheave::command
