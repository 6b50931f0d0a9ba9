// sheave trade: the work-precision chart, drawn by gnuplot.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "command/output/log_axis.h"
#include "command/trade/table.h"

namespace sheave::command {
namespace {

/// The style of one solver and integrator. Colour-blind readers can distinguish the colours (Okabe
/// and Ito 2008); the shapes differ for print without colour.
struct SeriesStyle {
  GnuplotPiece colour;
  int filled = 0;  ///< gnuplot's point type for tangents in every iteration
  int hollow = 0;  ///< gnuplot's point type for tangents once per substep
};
constexpr std::array<std::array<SeriesStyle, 2>, 2> series_styles{
    {{{{"#D55E00", 7, 6}, {"#E69F00", 9, 8}}},
     {{{"#0072B2", 5, 4}, {"#009E73", 13, 12}}}}};  // [solver][integrator]
constexpr SeriesStyle tolerance_style{"#CC79A7", 11, 10};

/// Builds the chart in parts.
class TradeChart {
 public:
  TradeChart(const TradeTable& table, ChartFormat format)
      : table_(table),
        least_(std::max(table.doubt.position, rounding_error)),
        script_(format, 700) {
    if (table.tensions_known()) least_ = std::max(least_, table.doubt.tension);
    for (const TradeRow& row : table_.rows) {
      if (!row.measured()) continue;
      errors_.add(error_of(row));
      times_.add(row.seconds.lower);
      times_.add(row.seconds.upper);
    }
    for (const TradeRow& row : table_.rows) {
      if (!row.fault.empty()) times_.add(expected(row));
    }
    // A chart without measured rows needs a range for its axes.
    if (errors_.empty()) errors_.add(1.0);
    if (times_.empty()) times_.add(1.0);
  }

  GnuplotScript script() {
    for (std::size_t s = 0; s < solver_names.size(); ++s) {
      for (std::size_t i = 0; i < integrator_names.size(); ++i) add_series(s, i);
    }
    add_points(
        tolerance_style, [](const StepSettings& step) { return step.tolerance > 0.0; },
        "direct, rattle, tolerance");
    add_front();
    add_failures();
    times_.set('x', script_);
    errors_.set('y', script_);
    script_.add({"set grid lc rgb '#dddddd'\nset key outside top center horizontal maxrows 3\n"});
    add_levels();
    script_.add({"set title ", script_.shown(title()), "\n"});
    script_.add({"set xlabel 'CPU time per simulated second [s]'\n",
                 table_.tensions_known()
                     ? GnuplotPiece("set ylabel 'error of positions [size of the scene] or of "
                                    "tensions [their mean], the larger one'\n")
                     : GnuplotPiece("set ylabel 'largest position error [size of the scene]'\n")});
    if (plots_.empty()) plots_.add({"1/0 notitle"});
    script_.add({"plot ", plots_, "\n"});
    return script_;
  }

 private:
  /// The drawn error of a row; the resolution of the reference is its lower bound.
  [[nodiscard]] double error_of(const TradeRow& row) const {
    const double tension = table_.tensions_known() ? row.error.tension : 0.0;
    return std::max({row.error.position, std::isnan(tension) ? 0.0 : tension, least_});
  }
  /// Predicted time per simulated second, for a run that was not timed.
  [[nodiscard]] double expected(const TradeRow& row) const {
    return row.expected_seconds / std::max(table_.simulated_seconds, table_.dt);
  }

  void plot(std::initializer_list<GnuplotPiece> pieces) {
    if (!plots_.empty()) plots_.add({", "});
    plots_.add(pieces);
  }

  void add_series(std::size_t solver, std::size_t integrator) {
    const auto is_own = [&](const StepSettings& step) {
      return step.tolerance == 0.0 && static_cast<std::size_t>(step.solver) == solver &&
             static_cast<std::size_t>(step.integrator) == integrator;
    };
    add_points(series_styles[solver][integrator], is_own,
               fmt::format("{}, {}{}", solver_names[solver], integrator_names[integrator],
                           order_text(solver, integrator)));
  }

  /// The measured rows of which `is_own` is true.
  template <class Filter>
  void add_points(const SeriesStyle& style, const Filter& is_own, const std::string& title) {
    bool titled = false;
    for (const bool hollow : {false, true}) {
      ChartRows rows;
      for (const TradeRow& row : table_.rows) {
        if (!row.measured() || !is_own(row.setting.step)) continue;
        if ((row.setting.tangents == TangentUpdate::substep) != hollow) continue;
        rows.add({row.seconds.median, error_of(row), row.seconds.lower, row.seconds.upper});
      }
      if (rows.empty()) continue;
      const std::string name = titled ? "" : title;
      plot({script_.block(rows), " using 1:2:3:4 with xerrorbars pt ",
            hollow ? style.hollow : style.filled, " ps 1.1 lw 1.5 lc rgb '", style.colour,
            "' title ", script_.shown(name)});
      titled = true;
    }
  }

  /// ", order 1.98"; empty if the order is unknown.
  [[nodiscard]] std::string order_text(std::size_t solver, std::size_t integrator) const {
    for (const TradeFamily& family : table_.families) {
      const bool same = family.name.starts_with(solver_names[solver]) &&
                        family.name.ends_with(integrator_names[integrator]);
      if (same && family.fit) return fmt::format(", order {:.2f}", family.fit->order);
    }
    return {};
  }

  void add_front() {
    ChartRows rows;
    for (const std::size_t i : measure::pareto_front(table_.points())) {
      rows.add({table_.rows[i].seconds.median, error_of(table_.rows[i])});
    }
    if (rows.empty()) return;
    plot({script_.block(rows),
          " using 1:2 with lines lw 2 lc rgb '#444444' title 'nothing is faster and better'"});
  }

  /// Marks failed rows at the upper edge, at their predicted time.
  void add_failures() {
    ChartRows rows;
    for (const TradeRow& row : table_.rows) {
      if (row.fault.empty()) continue;
      rows.add({std::max(expected(row), times_.lower()), errors_.upper()});
    }
    if (rows.empty()) return;
    plot({script_.block(rows),
          " using 1:2 with points pt 2 ps 1.3 lw 2 lc rgb '#000000' title 'failed'"});
  }

  /// Dashed lines at the error levels of the report and at the reference's error.
  void add_levels() {
    for (const double level : trade_levels) {
      if (level <= errors_.lower() || level >= errors_.upper()) continue;
      add_level(level, {"dt 3"}, {"graph 0.995"}, {"right offset 0,0.5"},
                fmt::format("{:g} %", 100.0 * level));
    }
    if (least_ > errors_.lower()) {
      add_level(least_, {"dt 2"}, {"graph 0.005"}, {"left offset 0,-0.6"},
                "accuracy of the reference");
    }
  }

  void add_level(double level, const GnuplotCode& dashes, const GnuplotCode& place,
                 const GnuplotCode& side, const std::string& text) {
    script_.add({"set arrow from graph 0, first ", level, " to graph 1, first ", level, " nohead ",
                 dashes, " lc rgb '#888888'\nset label ", script_.shown(text), " at ", place,
                 ", first ", level, " ", side, " tc rgb '#555555'\n"});
  }

  [[nodiscard]] std::string title() const {
    int failed = 0;
    int skipped = 0;
    bool hollow = false;
    for (const TradeRow& row : table_.rows) {
      failed += row.fault.empty() ? 0 : 1;
      skipped += row.skipped.empty() ? 0 : 1;
      hollow = hollow || (row.measured() && row.setting.tangents == TangentUpdate::substep);
    }
    std::string text = table_.scene;
    if (failed > 0) text += fmt::format("; {} of {} settings failed", failed, table_.rows.size());
    if (skipped > 0) text += fmt::format("; {} skipped for lack of time", skipped);
    return text + (hollow ? "; hollow: tangents once per substep" : "");
  }

  const TradeTable& table_;
  double least_;
  LogAxis errors_;
  LogAxis times_;
  GnuplotScript script_;
  GnuplotCode plots_;
};

}  // namespace

GnuplotScript trade_chart_script(const TradeTable& table, ChartFormat format) {
  return TradeChart(table, format).script();
}

}  // namespace sheave::command
