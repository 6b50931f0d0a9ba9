// sheave sweep: the results as a picture, drawn by gnuplot.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "command/output/gnuplot_script.h"
#include "command/sweep/table.h"

namespace sheave::command {
namespace {

constexpr int panel_height = 420;
constexpr int most_height = 32'000;  // limit of Cairo [pixels]
/// Results with more cells than this are drawn as a scatter plot instead of a heat map.
constexpr std::size_t most_cells = 10'000;
/// Numbers are written into the cells of a map with at most this many columns.
constexpr std::size_t most_written = 12;
/// Largest number of names at an axis of words, and at an axis of a map.
constexpr std::size_t most_words = 100;
constexpr std::size_t most_map_names = 16;

/// One varied quantity as an axis: numbers at their values, words at equal distances.
struct ChartAxis {
  std::string name;
  bool numeric = true;
  bool logarithmic = false;
  std::vector<std::string> values;  ///< the distinct values, in order
  std::vector<double> places;       ///< of each row

  /// Index of a value in `values`.
  [[nodiscard]] std::size_t index_of(const std::string& value) const {
    return static_cast<std::size_t>(std::find(values.begin(), values.end(), value) -
                                    values.begin());
  }
  /// At most `most` names, evenly distributed.
  [[nodiscard]] GnuplotCode tics(std::size_t most, GnuplotScript& script) const {
    GnuplotCode list;
    for (std::size_t i = 0; i < values.size(); i += 1 + values.size() / most) {
      if (i > 0) list.add({", "});
      const std::string shown =
          numeric ? fmt::format("{:.4g}", std::strtod(values[i].c_str(), nullptr)) : values[i];
      list.add({script.tic(shown, static_cast<double>(i))});
    }
    return {"(", list, ")"};
  }
};

bool is_number(const std::string& text, double& value) {
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(value);
}

ChartAxis chart_axis(const SweepTable& table, std::size_t a) {
  ChartAxis axis{table.head.axes[a], true, false, {}, {}};
  for (const SweepRow& row : table.rows) axis.values.push_back(row.values[a]);
  double number = 0.0;
  axis.numeric = std::all_of(axis.values.begin(), axis.values.end(),
                             [&](const std::string& text) { return is_number(text, number); });
  const auto before = [&](const std::string& x, const std::string& y) {
    return axis.numeric && std::strtod(x.c_str(), nullptr) < std::strtod(y.c_str(), nullptr);
  };
  std::stable_sort(axis.values.begin(), axis.values.end(), before);
  std::vector<std::string> different;
  for (std::string& value : axis.values) {
    const bool known = axis.numeric ? !different.empty() && different.back() == value
                                    : std::count(different.begin(), different.end(), value) > 0;
    if (!known) different.push_back(std::move(value));
  }
  axis.values = std::move(different);
  for (const SweepRow& row : table.rows) {
    axis.places.push_back(axis.numeric ? std::strtod(row.values[a].c_str(), nullptr)
                                       : static_cast<double>(axis.index_of(row.values[a])));
  }
  if (axis.numeric && axis.values.size() > 2) {
    const double low = std::strtod(axis.values.front().c_str(), nullptr);
    const double high = std::strtod(axis.values.back().c_str(), nullptr);
    const double middle = std::strtod(axis.values[axis.values.size() / 2].c_str(), nullptr);
    // Uses a logarithmic axis if the values are evenly spaced in the logarithm over more than 1.5
    // decades.
    axis.logarithmic = low > 0.0 && high > 30.0 * low && middle < 0.25 * (low + high);
  }
  return axis;
}

std::string measure_label(const SweepMeasure& measure) {
  return measure.unit.empty() ? measure.name : measure.name + " [" + measure.unit + "]";
}

/// The end of an axis of words or cells. An axis without values has a positive length, too.
double end_of(const ChartAxis& axis) {
  return static_cast<double>(std::max<std::size_t>(axis.values.size(), 1)) - 0.5;
}

class SweepChart {
 public:
  SweepChart(const SweepTable& table, ChartFormat format)
      : table_(table),
        script_(format,
                std::min(most_height,
                         panel_height * static_cast<int>(table.head.measures.size()) + 40)) {
    for (std::size_t a = 0; a < table.head.axes.size(); ++a) axes_.push_back(chart_axis(table, a));
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
    std::string text = fmt::format("{}: {} runs", table_.head.scene, table_.rows.size());
    if (unusable > 0) text += fmt::format(", {} not done (crosses)", unusable);
    return text;
  }

  /// The smallest value of a measure; 0 without values.
  [[nodiscard]] double least_of(std::size_t m) const {
    double least = std::numeric_limits<double>::infinity();
    for (const SweepRow& row : table_.rows) {
      if (std::isfinite(row.measured[m])) least = std::min(least, row.measured[m]);
    }
    return std::isfinite(least) ? least : 0.0;
  }

  /// The measure against one axis; connected by a line if no other axis is varied.
  void draw_cloud(std::size_t m, const ChartAxis& axis) {
    std::vector<std::size_t> order(table_.rows.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return axis.places[x] < axis.places[y]; });
    ChartRows data;
    ChartRows failed;
    const double bottom = least_of(m);  // place of points without a value
    for (const std::size_t i : order) {
      const double value = table_.rows[i].measured[m];
      if (std::isfinite(value)) {
        data.add({axis.places[i], value});
      } else {
        failed.add({axis.places[i], bottom});
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
      script_.add({"set xtics ", axis.tics(most_words, script_),
                   "\nset xrange [-0.5:", static_cast<double>(axis.values.size()) - 0.5, "]\n"});
    }
    script_.add({"set xlabel ", script_.shown(axis.name), "\nset ylabel ",
                 script_.shown(measure_label(table_.head.measures[m])), "\n"});
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

  /// A map of two axes with the measure as colour.
  void draw_map(std::size_t m) {
    const ChartAxis& x = axes_[0];
    const ChartAxis& y = axes_[1];
    ChartRows cells;
    ChartRows failed;
    failed.add({-9.0, -9.0});  // never empty: gnuplot refuses to plot an empty block
    double low = least_of(m);
    double high = low;
    for (const SweepRow& row : table_.rows) {
      const auto column = static_cast<double>(x.index_of(row.values[0]));
      const auto line = static_cast<double>(y.index_of(row.values[1]));
      const double value = row.measured[m];
      if (!std::isfinite(value)) {
        failed.add({column, line});
        continue;
      }
      cells.add({column, line, value, script_.shown_number(fmt::format("{:.4g}", value))});
      high = std::max(high, value);
    }
    if (cells.empty()) cells.add({-9.0, -9.0, 0.0, script_.shown_number("")});
    script_.add({"unset logscale\nset xtics ", x.tics(most_map_names, script_), "\nset ytics ",
                 y.tics(most_map_names, script_), "\n"});
    script_.add({"set xrange [-0.5:", end_of(x), "]\nset yrange [-0.5:", end_of(y), "]\n"});
    script_.add({"set xlabel ", script_.shown(x.name), "\nset ylabel ", script_.shown(y.name),
                 "\nset cblabel ", script_.shown(measure_label(table_.head.measures[m])), "\n"});
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
