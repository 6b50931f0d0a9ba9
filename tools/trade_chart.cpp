// sheave trade: the work-precision chart, drawn by gnuplot.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/gnuplot.h"
#include "tools/trade_table.h"

namespace sheave::tools {
namespace {

/// How the rows of one solver and integrator look. Colours that the colour-blind tell apart (Okabe
/// and Ito 2008), and different shapes for print without any.
struct SeriesStyle {
  const char* colour;
  int filled;  ///< gnuplot's point type: tangents in every iteration
  int hollow;  ///< tangents once per substep
};
constexpr std::array<std::array<SeriesStyle, 2>, 2> series_styles{
    {{{{"#D55E00", 7, 6}, {"#E69F00", 9, 8}}},
     {{{"#0072B2", 5, 4}, {"#009E73", 13, 12}}}}};  // [solver][integrator]

/// Whole decades round everything that is drawn; a logarithmic axis has no zero.
class LogRange {
 public:
  /// A third of a decade beside it stays free, so that no point lies on the frame.
  void add(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return;
    lowest_ = std::min(lowest_, 0.5 * value);
    highest_ = std::max(highest_, 2.0 * value);
  }
  [[nodiscard]] double lower() const { return std::pow(10.0, std::floor(std::log10(lowest_))); }
  [[nodiscard]] double upper() const {
    return std::max(std::pow(10.0, std::ceil(std::log10(highest_))), 10.0 * lower());
  }
  [[nodiscard]] bool empty() const { return !(lowest_ <= highest_); }
  [[nodiscard]] std::string text() const { return fmt::format("[{:g}:{:g}]", lower(), upper()); }

 private:
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = 0.0;
};

/// What gnuplot is told, piece by piece.
class TradeChart {
 public:
  explicit TradeChart(const TradeTable& table)
      : table_(table), least_(std::max(table.doubt.position, rounding_error)) {
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
    // Without anything measured there are still axes.
    if (errors_.empty()) errors_.add(1.0);
    if (times_.empty()) times_.add(1.0);
  }

  std::string script(const std::string& output) {
    for (std::size_t s = 0; s < solver_names.size(); ++s) {
      for (std::size_t i = 0; i < integrator_names.size(); ++i) add_series(s, i);
    }
    add_front();
    add_failures();
    std::string text = blocks_ + gnuplot_terminal(output, 700);
    text += "set logscale xy\nset format xy '10^{%T}'\nset grid lc rgb '#dddddd'\n";
    text += "set xrange " + times_.text() + "\nset yrange " + errors_.text() + "\n";
    text += "set key outside top center horizontal noenhanced maxrows 3\n";
    text += levels();
    text += "set title " + gnuplot_quoted(title()) + " noenhanced\n";
    text += "set xlabel 'CPU time per simulated second [s]'\n";
    text += table_.tensions_known()
                ? "set ylabel 'error of positions [size of the scene] or of tensions [their mean], "
                  "the larger one'\n"
                : "set ylabel 'largest position error [size of the scene]'\n";
    if (plots_.empty()) plots_ = "1/0 notitle";
    return text + "plot " + plots_ + "\nset output\n";
  }

 private:
  /// Errors end where the reference knows no more.
  [[nodiscard]] double error_of(const TradeRow& row) const {
    const double tension = table_.tensions_known() ? row.error.tension : 0.0;
    return std::max({row.error.position, std::isnan(tension) ? 0.0 : tension, least_});
  }
  /// Per simulated second, of a run that has no time.
  [[nodiscard]] double expected(const TradeRow& row) const {
    return row.expected_seconds / std::max(table_.simulated_seconds, table_.dt);
  }

  void plot(const std::string& text) { plots_ += (plots_.empty() ? "" : ", ") + text; }

  void add_series(std::size_t solver, std::size_t integrator) {
    bool titled = false;
    for (const bool hollow : {false, true}) {
      std::string data;
      for (const TradeRow& row : table_.rows) {
        const StepSettings& step = row.setting.step;
        if (!row.measured() || static_cast<std::size_t>(step.solver) != solver ||
            static_cast<std::size_t>(step.integrator) != integrator) {
          continue;
        }
        if ((row.setting.tangents == TangentUpdate::substep) != hollow) continue;
        data += fmt::format("{:.6e} {:.6e} {:.6e} {:.6e}\n", row.seconds.median, error_of(row),
                            row.seconds.lower, row.seconds.upper);
      }
      if (data.empty()) continue;
      const std::string name =
          fmt::format("$series{}{}{}", solver, integrator, hollow ? "hollow" : "");
      blocks_ += name + " << end\n" + data + "end\n";
      const SeriesStyle& style = series_styles[solver][integrator];
      const std::string title =
          titled ? "notitle"
                 : "title " + gnuplot_quoted(fmt::format("{}, {}{}", solver_names[solver],
                                                         integrator_names[integrator],
                                                         order_text(solver, integrator)));
      plot(fmt::format("{} using 1:2:3:4 with xerrorbars pt {} ps 1.1 lw 1.5 lc rgb '{}' {}", name,
                       hollow ? style.hollow : style.filled, style.colour, title));
      titled = true;
    }
  }

  /// ", order 1.98", or nothing if there is no order.
  [[nodiscard]] std::string order_text(std::size_t solver, std::size_t integrator) const {
    for (const TradeFamily& family : table_.families) {
      const bool same = family.name.starts_with(solver_names[solver]) &&
                        family.name.ends_with(integrator_names[integrator]);
      if (same && family.fit) return fmt::format(", order {:.2f}", family.fit->order);
    }
    return {};
  }

  void add_front() {
    std::string data;
    for (const std::size_t i : measure::pareto_front(table_.points())) {
      data +=
          fmt::format("{:.6e} {:.6e}\n", table_.rows[i].seconds.median, error_of(table_.rows[i]));
    }
    if (data.empty()) return;
    blocks_ += "$front << end\n" + data + "end\n";
    plot("$front using 1:2 with lines lw 2 lc rgb '#444444' title 'nothing is faster and better'");
  }

  /// At the upper edge, where they were expected to be in time.
  void add_failures() {
    std::string data;
    for (const TradeRow& row : table_.rows) {
      if (row.fault.empty()) continue;
      data +=
          fmt::format("{:.6e} {:.6e}\n", std::max(expected(row), times_.lower()), errors_.upper());
    }
    if (data.empty()) return;
    blocks_ += "$failed << end\n" + data + "end\n";
    plot("$failed using 1:2 with points pt 2 ps 1.3 lw 2 lc rgb '#000000' title 'failed'");
  }

  /// Dashed lines at the errors that settings are named for, and at that of the reference.
  [[nodiscard]] std::string levels() const {
    std::string text;
    for (const double level : trade_levels) {
      if (level <= errors_.lower() || level >= errors_.upper()) continue;
      text += fmt::format(
          "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dt 3 lc rgb "
          "'#888888'\nset label '{1:g} %' at graph 0.995, first {0:g} right offset 0,0.5 tc rgb "
          "'#555555'\n",
          level, 100.0 * level);
    }
    if (least_ > errors_.lower()) {
      text += fmt::format(
          "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dt 2 lc rgb "
          "'#888888'\nset label 'the reference tells no more' at graph 0.005, first {0:g} left "
          "offset 0,-0.6 tc rgb '#555555'\n",
          least_);
    }
    return text;
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
    if (skipped > 0) text += fmt::format("; {} skipped for want of time", skipped);
    return text + (hollow ? "; hollow: tangents once per substep" : "");
  }

  const TradeTable& table_;
  double least_;
  LogRange errors_;
  LogRange times_;
  std::string blocks_;
  std::string plots_;
};

}  // namespace

std::string trade_chart_script(const TradeTable& table, const std::string& output) {
  return TradeChart(table).script(output);
}

}  // namespace sheave::tools
