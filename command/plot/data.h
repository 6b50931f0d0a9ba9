#pragma once
// What charts of runs are drawn from: columns of tables, or quantities of a simulation.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "scenes/observables.h"

namespace sheave::command {

/// Something that happened at a moment of a run.
struct PlotEvent {
  double time = 0.0;  ///< [s]
  std::string text;   ///< e.g. "rope break"
};

/// What is drawn of one run.
struct PlotRun {
  std::string label;
  std::vector<std::string> names;           ///< the horizontal quantity, then the vertical ones
  std::vector<std::vector<double>> values;  ///< of each; as many of all, NaN where there is none
  std::vector<PlotEvent> events;
};

/// What is drawn over what.
struct PlotChoice {
  std::string x = "t";
  std::vector<std::string> patterns;  ///< names, or patterns with * ? [...]
};

/// The columns of a .csv or .npy file as `sheave run --out` writes them; of a CSV file, whose first
/// line has the names, also of others. Cables and joints whose column "cut" or "broken" becomes 1
/// are events. A Failure: 65 with the place of what is wrong, 2 if a name is in no column, 66, 74.
[[nodiscard]] PlotRun read_plot_table(const std::string& path, const PlotChoice& choice);

/// Records quantities of a simulation as it goes, thinned out so that no more than some thousand
/// moments are kept.
class PlotRecorder {
 public:
  /// A Failure (2) if a name is that of no quantity.
  PlotRecorder(const Simulation& simulation, const PlotChoice& choice);
  /// To be called at the start and after every step.
  void observe(const Simulation& simulation);
  /// What was recorded, with what happened until now.
  [[nodiscard]] PlotRun run(const std::string& label, const Simulation& simulation) const;

 private:
  void thin_out();

  ObservableSet observables_;
  std::vector<int> columns_;
  std::vector<double> sample_;
  std::vector<std::vector<double>> values_;  // of each column
  std::int64_t observed_ = 0;
  std::int64_t stride_ = 1;
};

/// The chart of runs for gnuplot, one panel for each unit; in colours that the colour-blind tell
/// apart, runs by dashes.
[[nodiscard]] GnuplotScript plot_script(const std::vector<PlotRun>& runs, const std::string& title,
                                        ChartFormat format);
/// The same in numbers: what is drawn, with the extremes of each line.
[[nodiscard]] std::string plot_json(const std::vector<PlotRun>& runs, const std::string& file);

}  // namespace sheave::command
