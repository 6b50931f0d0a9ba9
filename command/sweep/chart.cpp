// sheave sweep: the results as a picture, drawn by gnuplot.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "command/output/gnuplot_script.h"
#include "command/sweep/chart_axis.h"
#include "command/sweep/table.h"

namespace sheave::command {
namespace {

constexpr int panel_height = 420;
constexpr int most_height = 32'000;  // limit of Cairo [pixels]
/// Results with more cells than this are drawn as a scatter plot instead of a heat map.
constexpr std::size_t most_cells = 10'000;
/// Numbers are written into the cells of a map with at most this many columns.
constexpr std::size_t most_written = 12;
/// Numbers are written at bars if there are at most this many.
constexpr std::size_t most_bar_numbers = 16;
/// Largest number of names at an axis of words, and at an axis of a map.
constexpr std::size_t most_words = 100;
constexpr std::size_t most_map_names = 16;

class SweepChart {
 public:
  SweepChart(const SweepTable& table, ChartFormat format)
      : table_(table),
        script_(format,
                std::min(most_height,
                         panel_height * static_cast<int>(table.head.measures.size()) + 40)) {
    for (std::size_t a = 0; a < table.head.axes.size(); ++a) axes_.emplace_back(table, a);
  }

  GnuplotScript script() {
    const std::size_t columns = is_map() || axes_.size() == 1 ? 1 : axes_.size();
    const std::size_t rows = table_.head.measures.size();
    script_.add({"set datafile missing 'NaN'\nset grid lc rgb '#dddddd'\nset tics nomirror\n"});
    script_.add({"set multiplot layout ", rows, ",", columns, " title ", script_.shown(title()),
                 "\nunset key\n"});
    for (std::size_t m = 0; m < rows; ++m) {
      if (is_map()) {
        draw_map(m);
        continue;
      }
      if (axes_.size() == 1 && !axes_.front().numeric) {
        draw_bars(m, axes_.front());
        continue;
      }
      for (const ChartAxis& axis : axes_) draw_cloud(m, axis);
    }
    script_.add({"unset multiplot\n"});
    return script_;
  }

 private:
  [[nodiscard]] bool is_map() const {
    if (axes_.size() != 2) return false;
    const std::size_t cells = axes_[0].values.size() * axes_[1].values.size();
    // Randomly drawn values are all distinct, so a map of them would be nearly empty.
    return cells <= most_cells && cells <= 2 * table_.rows.size();
  }

  [[nodiscard]] std::string title() const {
    std::size_t unusable = 0;
    for (const SweepRow& row : table_.rows) unusable += row.usable() ? 0 : 1;
    const std::string_view of = table_.head.kind == SweepKind::run ? "" : name_of(table_.head.kind);
    std::string text = fmt::format("{}: {} {}", table_.head.scene, table_.rows.size(),
                                   of.empty() ? "runs" : fmt::format("searches of {}", of));
    if (unusable > 0) text += fmt::format(", {} not done (crosses)", unusable);
    return text;
  }

  /// The measure against one axis; connected by a line if no other axis is varied.
  void draw_cloud(std::size_t m, const ChartAxis& axis) {
    std::vector<std::size_t> order(table_.rows.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return axis.places[x] < axis.places[y]; });
    ChartRows data;
    ChartRows failed;
    const ShownMeasure shown(table_, m);
    for (const std::size_t i : order) {
      const double value = table_.rows[i].measured[m];
      if (std::isfinite(value)) {
        data.add({axis.places[i], value / shown.scale.factor});
      } else {
        failed.add({axis.places[i], shown.low});  // the place of points without a value
      }
    }
    script_.add({axis.logarithmic ? GnuplotPiece("set") : GnuplotPiece("unset"), " logscale x\n"});
    if (axis.numeric) {
      script_.add({"set xtics autofreq\n"});
      if (table_.rows.empty()) {
        script_.add({"set xrange [0:1]\nset yrange [0:1]\n"});
      } else {
        script_.add({"set xrange [*:*]\n"});
      }
    } else {
      script_.add(
          {"set xtics ", axis.tics(most_words, script_), "\nset xrange [-0.5:", axis.end(), "]\n"});
    }
    script_.add({"set xlabel ", script_.shown(axis.label), "\nset ylabel ",
                 script_.shown(shown.label), "\n"});
    GnuplotCode plots;
    if (!data.empty()) {
      const bool line = axes_.size() == 1 && axis.numeric;
      plots.add({script_.block(data), " using 1:2 with ",
                 line ? GnuplotPiece("linespoints lw 2") : GnuplotPiece("points"),
                 " pt 7 ps 0.8 lc rgb '#0072B2'"});
    }
    if (!failed.empty() || data.empty()) {
      if (!plots.empty()) plots.add({", "});
      plots.add({script_.block(failed), " using 1:2 with points pt 2 ps 1 lw 2 lc rgb '#D55E00'"});
    }
    script_.add({"plot ", plots, "\n"});
  }

  /// The measure over words, such as the names of cases: bars with their numbers.
  void draw_bars(std::size_t m, const ChartAxis& axis) {
    const ShownMeasure shown(table_, m);
    // Bars begin at 0; there is room for the numbers at their ends.
    const double low = std::min(shown.low, 0.0);
    const double high = std::max(shown.high, 0.0);
    const double room = high > low ? 0.12 * (high - low) : 1.0;
    ChartRows bars;
    ChartRows failed;
    failed.add({-9.0, 0.0});  // never empty: gnuplot refuses to plot an empty block
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      const double value = table_.rows[i].measured[m] / shown.scale.factor;
      if (std::isfinite(value)) {
        bars.add({axis.places[i], value, script_.shown_number(shown.cell(value)),
                  value + std::copysign(0.4 * room, value)});
      } else {
        failed.add({axis.places[i], 0.0});
      }
    }
    if (bars.empty()) bars.add({-9.0, 0.0, script_.shown_number(""), 0.0});
    script_.add({"unset logscale x\nset xtics ", axis.tics(most_words, script_),
                 "\nset xrange [-0.5:", axis.end(), "]\nset yrange [", low < 0.0 ? low - room : 0.0,
                 ":", high > 0.0 || low == 0.0 ? high + room : 0.0, "]\n"});
    script_.add({"set xlabel ", script_.shown(axis.label), "\nset ylabel ",
                 script_.shown(shown.label), "\nset style fill solid 0.8 noborder\n"});
    const GnuplotCode block = script_.block(bars);
    script_.add({"plot ", block, " using 1:2:(0.6) with boxes lc rgb '#0072B2', ",
                 script_.block(failed),
                 " using 1:2 with points pt 2 ps 1.5 lw 2 lc rgb '#D55E00'"});
    if (table_.rows.size() <= most_bar_numbers) {
      script_.add({", ", block, " using 1:4:", GnuplotScript::shown_of_column(3), " with labels"});
    }
    script_.add({"\n"});
  }

  /// A map of two axes with the measure as colour.
  void draw_map(std::size_t m) {
    const ChartAxis& x = axes_[0];
    const ChartAxis& y = axes_[1];
    ChartRows cells;
    ChartRows failed;
    failed.add({-9.0, -9.0});  // never empty: gnuplot refuses to plot an empty block
    const ShownMeasure shown(table_, m);
    const double low = shown.low;
    const double high = shown.high;
    for (const SweepRow& row : table_.rows) {
      const auto column = static_cast<double>(x.index_of(row.values[0]));
      const auto line = static_cast<double>(y.index_of(row.values[1]));
      const double value = row.measured[m] / shown.scale.factor;
      if (!std::isfinite(value)) {
        failed.add({column, line});
        continue;
      }
      cells.add({column, line, value, script_.shown_number(shown.cell(value))});
    }
    if (cells.empty()) cells.add({-9.0, -9.0, 0.0, script_.shown_number("")});
    script_.add({"unset logscale\nset xtics ", x.tics(most_map_names, script_), "\nset ytics ",
                 y.tics(most_map_names, script_), "\n"});
    script_.add({"set xrange [-0.5:", x.end(), "]\nset yrange [-0.5:", y.end(), "]\n"});
    script_.add({"set xlabel ", script_.shown(x.label), "\nset ylabel ", script_.shown(y.label),
                 "\nset cblabel ", script_.shown(shown.label), " offset 1.5\n"});
    // A range that vanishes in the digits written for gnuplot gives no colour scale.
    const double size = std::max(std::abs(low), std::abs(high));
    const double room = high - low > 1e-9 * size ? 0.0 : (size > 0.0 ? 0.1 * size : 1.0);
    script_.add({"set cbrange [", low - room, ":", high + room, "]\n"});
    // Cividis (Nuñez, Anderton, Renslow 2018): looks the same with and without colour blindness.
    script_.add(
        {"set palette defined (0 '#00224e', 1 '#123570', 2 '#3b496c', 3 '#575d6d', 4 '#707173', "
         "5 '#8a8678', 6 '#a59c74', 7 '#c3b369', 8 '#e1cc55', 9 '#fee838')\n"
         "set style fill solid noborder\n"});
    const GnuplotCode block = script_.block(cells);
    script_.add({"plot ", block, " using 1:2:(0.5):(0.5):3 with boxxyerror palette, ",
                 script_.block(failed),
                 " using 1:2 with points pt 2 ps 1.5 lw 2 lc rgb '#D55E00'"});
    if (x.values.size() <= most_written) {
      script_.add({", ", block, " using 1:2:", GnuplotScript::shown_of_column(4), ":($3 < ",
                   0.5 * (low + high), " ? 0xffffff : 0) with labels font ',10' tc rgb variable"});
    }
    script_.add({"\n"});
  }

  const SweepTable& table_;
  std::vector<ChartAxis> axes_;
  GnuplotScript script_;
};

}  // namespace

GnuplotScript sweep_chart_script(const SweepTable& table, ChartFormat format) {
  return SweepChart(table, format).script();
}

}  // namespace sheave::command
