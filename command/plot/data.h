#pragma once
// The data of charts of runs: columns of tables, or observables of a simulation.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "scenes/quantity_list.h"

namespace sheave::command {

/// An event of a run.
struct PlotEvent {
  double time = 0.0;  ///< [s]
  std::string text;   ///< e.g. "rope break"
};

/// The data of one run in a chart.
struct PlotRun {
  std::string label;
  std::vector<std::string> names;  ///< the horizontal quantity, then the vertical ones
  std::vector<std::string> units;  ///< one per name; empty: a pure number, or unknown
  /// One list per name; all of equal length, NaN for a missing value.
  std::vector<std::vector<double>> values;
  std::vector<PlotEvent> events;
  /// The rows are no course, such as those of a sweep over several settings: points, not a line.
  bool scattered = false;
};

/// The horizontal and the vertical quantities of a chart.
struct PlotChoice {
  std::string x = "t";             ///< a name, or an expression
  std::vector<std::string> lists;  ///< lists of names, patterns with * ? [...], expressions
};

/// The columns of a .csv or .npy file from `sheave run --out`. Other CSV files also work if their
/// first line has the names. A cable or joint whose column "cut" or "broken" becomes 1 gives an
/// event. A Failure: 65 with the position of the fault, 2 if no column has a name of the choice,
/// 66, 74.
[[nodiscard]] PlotRun read_plot_table(const std::string& path, const PlotChoice& choice);

/// Records observables during a simulation. The samples are thinned out so that only some thousand
/// are stored.
class PlotRecorder {
 public:
  /// A Failure (2) if no observable has a name of the choice.
  PlotRecorder(const Simulation& simulation, const PlotChoice& choice);
  /// To be called at the start and after every step.
  void observe(const Simulation& simulation);
  /// The record with all events up to now.
  [[nodiscard]] PlotRun run(const std::string& label, const Simulation& simulation) const;

 private:
  void thin_out();

  QuantityList columns_;
  std::vector<Course> courses_;  // of statistics over time in the columns
  std::vector<double> sample_;
  std::vector<std::vector<double>> values_;  // samples of each column
  std::int64_t observed_ = 0;
  std::int64_t stride_ = 1;
};

/// The gnuplot chart of runs, one panel for each unit. The colours differ for colour-blind readers,
/// too; the dashes distinguish runs.
[[nodiscard]] GnuplotScript plot_script(const std::vector<PlotRun>& runs, const std::string& title,
                                        ChartFormat format);
/// The drawn lines as numbers, with the extremes of each line.
[[nodiscard]] std::string plot_json(const std::vector<PlotRun>& runs, const std::string& file);

}  // namespace sheave::command
