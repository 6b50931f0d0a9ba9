// sheave bench: times and errors of all rows as a picture, drawn by gnuplot.

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "command/bench/table.h"
#include "command/failure.h"
#include "command/output/gnuplot.h"
#include "command/output/log_axis.h"

namespace sheave::command {
namespace {

/// Rows with the same colour.
struct Series {
  const char* title;
  GnuplotPiece colour;
  bool (*contains)(const BenchRow& row);
};
constexpr std::array<Series, 3> chart_series{
    {{"gauss-seidel, as in the paper", "#c0392b",
      [](const BenchRow& row) { return row.settings.solver == SolverKind::gauss_seidel; }},
     {"direct", "#2471a3",
      [](const BenchRow& row) {
        return row.settings.solver == SolverKind::direct &&
               row.settings.integrator == IntegratorKind::xpbd;
      }},
     {"direct, rattle", "#1e8449", [](const BenchRow& row) {
        return row.settings.solver == SolverKind::direct &&
               row.settings.integrator == IntegratorKind::rattle;
      }}}};

std::vector<std::string> scene_names(const BenchTable& table) {
  std::vector<std::string> names;
  for (const BenchRow& row : table.rows) {
    const bool known = std::find(names.begin(), names.end(), row.scene) != names.end();
    if (row.measured() && !known) names.push_back(row.scene);
  }
  return names;
}

/// Position of a scene on the horizontal axis.
double place_of(const std::vector<std::string>& names, const std::string& scene) {
  return static_cast<double>(std::find(names.begin(), names.end(), scene) - names.begin());
}

/// The chart with the panel of times and the panel of errors.
class BenchChart {
 public:
  BenchChart(const BenchTable& table, ChartFormat format)
      : table_(table), names_(scene_names(table)), script_(format, 800) {}

  GnuplotScript script() {
    plot_paper();
    for (std::size_t s = 0; s < chart_series.size(); ++s) plot_series(s);
    GnuplotCode scenes;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (i > 0) scenes.add({", "});
      scenes.add({script_.tic(names_[i], static_cast<double>(i))});
    }
    script_.add({"set grid y\nset xtics (", scenes,
                 ") nomirror\nset xrange [-0.5:", static_cast<double>(names_.size()) - 0.5, "]\n"});
    script_.add({"set multiplot layout 2,1\nset key outside top center horizontal\n"});
    if (!times_.empty()) times_.set('y', script_);
    script_.add({"set ylabel 'time of a frame [ms]'\nplot ", time_plots_, "\n"});
    script_.add({"set ytics autofreq\n"});  // removes the tic names of the first panel
    if (!errors_.empty()) errors_.set('y', script_);
    script_.add({"set ylabel 'error [scene size]'\nplot ", error_plots_, "\nunset multiplot\n"});
    return script_;
  }

 private:
  static void plot(std::initializer_list<GnuplotPiece> pieces, GnuplotCode& plots) {
    if (!plots.empty()) plots.add({", "});
    plots.add(pieces);
  }

  void plot_paper() {
    ChartRows rows;
    for (const BenchRow& row : table_.rows) {
      if (!row.measured() || !row.paper_seconds) continue;
      const double time = 1e3 * *row.paper_seconds;
      rows.add({place_of(names_, row.scene) - 0.3, time});
      times_.add(time);
    }
    if (rows.empty()) return;
    plot({script_.block(rows),
          " using 1:2 with points pt 2 ps 1.5 lw 2 lc rgb '#888888' title 'paper, 2018'"},
         time_plots_);
  }

  void plot_series(std::size_t s) {
    const Series& series = chart_series[s];
    ChartRows rows;  // place, time, its quartiles, error
    std::string last;
    for (const BenchRow& row : table_.rows) {
      if (!row.measured() || !series.contains(row)) continue;
      // Two settings of one scene and series are drawn side by side.
      const double aside = row.scene == last ? 0.07 : 0.0;
      last = row.scene;
      // A logarithmic axis has no zero, so errors below 1e-16 are drawn at 1e-16.
      const double error = std::max(row.error.position, 1e-16);
      rows.add({place_of(names_, row.scene) - 0.12 + 0.18 * static_cast<double>(s) + aside,
                1e3 * row.seconds.median, 1e3 * row.seconds.lower, 1e3 * row.seconds.upper, error});
      times_.add(1e3 * row.seconds.lower);
      times_.add(1e3 * row.seconds.upper);
      errors_.add(error);
    }
    if (rows.empty()) return;
    const GnuplotCode block = script_.block(rows);
    plot({block, " using 1:2:3:4 with yerrorbars pt 7 ps 1.2 lw 2 lc rgb '", series.colour,
          "' title ", script_.shown(series.title)},
         time_plots_);
    plot({block, " using 1:5 with points pt 7 ps 1.2 lc rgb '", series.colour, "' notitle"},
         error_plots_);
  }

  const BenchTable& table_;
  std::vector<std::string> names_;
  GnuplotScript script_;
  LogAxis times_;
  LogAxis errors_;
  GnuplotCode time_plots_;
  GnuplotCode error_plots_;
};

}  // namespace

GnuplotScript chart_script(const BenchTable& table, ChartFormat format) {
  return BenchChart(table, format).script();
}

void draw_chart(const BenchTable& table, const std::string& path) {
  const ChartFormat format = chart_format(path);
  if (scene_names(table).empty()) throw Failure(ExitCode::io, path + ": there is nothing to draw");
  draw_with_gnuplot(path, chart_script(table, format));
}

}  // namespace sheave::command
