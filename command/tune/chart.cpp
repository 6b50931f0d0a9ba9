// sheave tune: the course of a search as a picture, drawn by gnuplot.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "command/sweep/chart_axis.h"
#include "command/tune/tune.h"

namespace sheave::command {
namespace {

constexpr int goal_height = 420;
constexpr int setting_height = 240;
/// More settings are left to tables.
constexpr std::size_t most_settings_drawn = 12;

/// Points of the runs: those that keep all bounds, the others, those without a result.
struct CoursePoints {
  ChartRows kept, violated, failed, best;
};

class TuneChart {
 public:
  TuneChart(const TuneOptions& options, const TuneResult& result, ChartFormat format)
      : options_(options),
        result_(result),
        settings_(std::min(result.table.head.axes.size(), most_settings_drawn)),
        script_(format, goal_height + setting_height * static_cast<int>(settings_) + 40) {}

  GnuplotScript script() {
    const double whole = goal_height + setting_height * static_cast<double>(settings_) + 40.0;
    const SweepHead& head = result_.table.head;
    script_.add({"set grid lc rgb '#dddddd'\nset tics nomirror\nset multiplot\n"});
    script_.add(
        {"set xrange [-0.5:", std::max(static_cast<double>(result_.table.rows.size()), 1.0) - 0.5,
         "]\nset lmargin at screen 0.12\nset rmargin at screen 0.97\n"});
    // The key is at the top of the picture, the title below it.
    script_.add({"set label 1 ",
                 script_.shown(fmt::format("{}: {} runs", head.scene, result_.table.rows.size())),
                 " at screen 0.545, screen ", 1.0 - 40.0 / whole,
                 " center\nset key outside top center horizontal samplen 1\n"});
    double top = 1.0 - 60.0 / whole;
    const double goal_bottom = top - (goal_height - 80.0) / whole;
    place(top, goal_bottom);
    draw_goal();
    script_.add({"unset key\nunset label 1\n"});
    top = goal_bottom - 50.0 / whole;
    for (std::size_t a = 0; a < settings_; ++a) {
      const double bottom = top - (setting_height - 50.0) / whole;
      place(top, bottom);
      draw_setting(a);
      top = bottom - 50.0 / whole;
    }
    script_.add({"unset multiplot\n"});
    return script_;
  }

 private:
  void place(double top, double bottom) {
    script_.add({"set tmargin at screen ", top, "\nset bmargin at screen ", bottom, "\n"});
  }

  /// Sorts the runs by the state of their bounds; `value` gives the height of a run's point.
  template <class Value>
  CoursePoints points(const Value& value) const {
    CoursePoints points;
    const auto& rows = result_.table.rows;
    for (const SweepRow& row : rows) {
      const auto run = static_cast<double>(row.run);
      ChartRows& list = !is_result(row)                     ? points.failed
                        : violation_of(options_, row) > 0.0 ? points.violated
                                                            : points.kept;
      list.add({run, value(row)});
    }
    for (std::size_t i = 0; i < result_.improved.size(); ++i) {
      const std::size_t row = result_.improved[i];
      const std::size_t next =
          i + 1 < result_.improved.size() ? result_.improved[i + 1] : rows.size() - 1;
      points.best.add({static_cast<double>(row), value(rows[row])});
      points.best.add({static_cast<double>(next), value(rows[row])});
    }
    return points;
  }

  void draw(const CoursePoints& points, GnuplotCode plots = {}) {
    const auto add = [&](const ChartRows& rows, GnuplotPiece style) {
      if (rows.empty()) return;
      if (!plots.empty()) plots.add({", "});
      plots.add({script_.block(rows), " using 1:2 with ", style});
    };
    add(points.best, "lines lw 2 lc rgb '#56B4E9' title 'best so far'");
    add(points.kept, "points pt 7 ps 0.7 lc rgb '#0072B2' title 'run'");
    add(points.violated, "points pt 6 ps 0.9 lw 1.5 lc rgb '#E69F00' title 'violates a bound'");
    add(points.failed, "points pt 2 ps 1 lw 2 lc rgb '#D55E00' title 'not done'");
    if (plots.empty()) plots.add({"NaN notitle"});
    script_.add({"plot ", plots, "\n"});
  }

  void draw_goal() {
    const ShownMeasure shown(result_.table, 0);
    script_.add({"set ylabel ", script_.shown(shown.label), "\n"});
    GnuplotCode target;
    if (options_.goal.sense == TuneGoal::Sense::target) {
      target.add({options_.goal.target / shown.scale.factor,
                  " with lines dt 2 lc rgb 'black' title 'target'"});
    }
    // Runs without a value stand at the bottom.
    const auto height = [&](const SweepRow& row) {
      return std::isfinite(row.measured[0]) ? row.measured[0] / shown.scale.factor : shown.low;
    };
    draw(points(height), target);
  }

  void draw_setting(std::size_t a) {
    const SweepAxis& axis = options_.rows.plan.axes[a];
    const auto [low, high] = std::minmax(axis.low, axis.high);
    const double room = 0.05 * (high - low);
    script_.add({axis.logarithmic ? GnuplotPiece("set") : GnuplotPiece("unset"),
                 " logscale y\nset yrange [", axis.logarithmic ? low : low - room, ":",
                 axis.logarithmic ? high : high + room, "]\n"});
    script_.add({"set ylabel ", script_.shown(axis.name), "\n"});
    if (a + 1 == settings_) script_.add({"set xlabel 'run'\n"});
    draw(points([&](const SweepRow& row) { return std::strtod(row.values[a].c_str(), nullptr); }));
  }

  const TuneOptions& options_;
  const TuneResult& result_;
  std::size_t settings_;
  GnuplotScript script_;
};

}  // namespace

GnuplotScript tune_chart_script(const TuneOptions& options, const TuneResult& result,
                                ChartFormat format) {
  return TuneChart(options, result, format).script();
}

}  // namespace sheave::command
