// sheave sweep: its outcome as a picture, drawn by gnuplot.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "tools/gnuplot.h"
#include "tools/sweep_table.h"

namespace sheave::tools {
namespace {

constexpr int panel_height = 420;
/// A heat map with more cells than this is a cloud of points.
constexpr std::size_t most_cells = 10'000;
/// Numbers stand in the cells of a map of at most so many columns.
constexpr std::size_t most_written = 12;

/// One varied thing as an axis of a chart: numbers where they are, words side by side.
struct ChartAxis {
  std::string name;
  bool numeric = true;
  bool logarithmic = false;
  std::vector<std::string> values;  ///< the different ones, in order
  std::vector<double> places;       ///< of each row

  /// Of a value among `values`, from 0.
  [[nodiscard]] std::size_t index_of(const std::string& value) const {
    return static_cast<std::size_t>(std::find(values.begin(), values.end(), value) -
                                    values.begin());
  }
  [[nodiscard]] std::string tics(std::size_t every) const {
    std::string text;
    for (std::size_t i = 0; i < values.size(); i += every) {
      const std::string word =
          numeric ? fmt::format("{:.4g}", std::strtod(values[i].c_str(), nullptr)) : values[i];
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", gnuplot_quoted(word), i);
    }
    return "(" + text + ")";
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
    // Values that are even in the logarithm, over more than a decade and a half.
    axis.logarithmic = low > 0.0 && high > 30.0 * low && middle < 0.25 * (low + high);
  }
  return axis;
}

std::string measure_label(const SweepMeasure& measure) {
  return gnuplot_quoted(measure.unit.empty() ? measure.name
                                             : measure.name + " [" + measure.unit + "]");
}

class SweepChart {
 public:
  explicit SweepChart(const SweepTable& table) : table_(table) {
    for (std::size_t a = 0; a < table.head.axes.size(); ++a) axes_.push_back(chart_axis(table, a));
  }

  std::string script(const std::string& output) {
    const std::size_t columns = is_map() || axes_.size() == 1 ? 1 : axes_.size();
    const std::size_t rows = table_.head.measures.size();
    const int height = panel_height * static_cast<int>(rows) + 40;
    std::string text = gnuplot_terminal(output, height);
    text += "set datafile missing 'NaN'\nset grid lc rgb '#dddddd'\nset tics nomirror\n";
    text += fmt::format("set multiplot layout {},{} title {} noenhanced\n", rows, columns,
                        gnuplot_quoted(title()));
    for (std::size_t m = 0; m < rows; ++m) {
      if (is_map()) {
        text += map(m);
        continue;
      }
      for (const ChartAxis& axis : axes_) text += cloud(m, axis);
    }
    return text + "unset multiplot\nset output\n";
  }

 private:
  [[nodiscard]] bool is_map() const {
    if (axes_.size() != 2) return false;
    const std::size_t cells = axes_[0].values.size() * axes_[1].values.size();
    // Drawn values are all different: a map of them would be empty.
    return cells <= most_cells && cells <= 2 * table_.rows.size();
  }

  [[nodiscard]] std::string title() const {
    std::size_t unusable = 0;
    for (const SweepRow& row : table_.rows) unusable += row.usable() ? 0 : 1;
    std::string text = fmt::format("{}: {} runs", table_.head.scene, table_.rows.size());
    if (unusable > 0) text += fmt::format(", {} not done (crosses)", unusable);
    return text;
  }

  /// The least value of a measure; 0 without any.
  [[nodiscard]] double least_of(std::size_t m) const {
    double least = std::numeric_limits<double>::infinity();
    for (const SweepRow& row : table_.rows) {
      if (std::isfinite(row.measured[m])) least = std::min(least, row.measured[m]);
    }
    return std::isfinite(least) ? least : 0.0;
  }

  /// The measure over one axis: a line if that is all that is varied.
  [[nodiscard]] std::string cloud(std::size_t m, const ChartAxis& axis) const {
    std::vector<std::size_t> order(table_.rows.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return axis.places[x] < axis.places[y]; });
    std::string data = "$data << end\n";
    std::string failed = "$failed << end\n";
    bool any = false;
    bool any_failed = false;
    const double bottom = least_of(m);  // what has no height stands there
    for (const std::size_t i : order) {
      const double value = table_.rows[i].measured[m];
      if (std::isfinite(value)) {
        data += fmt::format("{:.12g} {:.12g}\n", axis.places[i], value);
        any = true;
      } else {
        failed += fmt::format("{:.12g} {:.12g}\n", axis.places[i], bottom);
        any_failed = true;
      }
    }
    std::string text = data + "end\n" + failed + "end\nunset key\n";
    text += axis.logarithmic ? "set logscale x\n" : "unset logscale x\n";
    text += axis.numeric ? "set xtics autofreq\n" : "set xtics " + axis.tics(1) + "\n";
    text += axis.numeric ? "set xrange [*:*]\n"
                         : fmt::format("set xrange [-0.5:{}]\n",
                                       static_cast<double>(axis.values.size()) - 0.5);
    text += "set xlabel " + gnuplot_quoted(axis.name) + " noenhanced\n";
    text += "set ylabel " + measure_label(table_.head.measures[m]) + " noenhanced\n";
    std::string plots;
    if (any) {
      const bool line = axes_.size() == 1 && axis.numeric;
      plots = fmt::format("$data using 1:2 with {} pt 7 ps 0.8 lc rgb '#0072B2'",
                          line ? "linespoints lw 2" : "points");
    }
    if (any_failed && any) {
      plots += ", $failed using 1:2 with points pt 2 ps 1 lw 2 lc rgb '#D55E00'";
    }
    if (plots.empty()) plots = "$failed using 1:2 with points pt 2 ps 1 lw 2 lc rgb '#D55E00'";
    return text + "plot " + plots + "\n";
  }

  /// Two axes side by side with the measure as colour.
  [[nodiscard]] std::string map(std::size_t m) const {
    const ChartAxis& x = axes_[0];
    const ChartAxis& y = axes_[1];
    std::string cells = "$cells << end\n";
    std::string failed = "$failed << end\n-9 -9\n";  // never empty: gnuplot plots no nothing
    double low = 0.0;
    double high = 0.0;
    bool any = false;
    for (const SweepRow& row : table_.rows) {
      const std::string place =
          fmt::format("{} {}", x.index_of(row.values[0]), y.index_of(row.values[1]));
      const double value = row.measured[m];
      if (!std::isfinite(value)) {
        failed += place + "\n";
        continue;
      }
      cells += fmt::format("{} {:.12g} {:.4g}\n", place, value, value);
      low = any ? std::min(low, value) : value;
      high = any ? std::max(high, value) : value;
      any = true;
    }
    if (!any) cells += "-9 -9 0 0\n";
    const double middle = 0.5 * (low + high);
    std::string text = cells + "end\n" + failed + "end\nunset key\nunset logscale\n";
    text += "set xtics " + x.tics(1 + x.values.size() / 16) + "\n";
    text += "set ytics " + y.tics(1 + y.values.size() / 16) + "\n";
    text += fmt::format("set xrange [-0.5:{}]\nset yrange [-0.5:{}]\n",
                        static_cast<double>(x.values.size()) - 0.5,
                        static_cast<double>(y.values.size()) - 0.5);
    text += "set xlabel " + gnuplot_quoted(x.name) + " noenhanced\n";
    text += "set ylabel " + gnuplot_quoted(y.name) + " noenhanced\n";
    text += "set cblabel " + measure_label(table_.head.measures[m]) + " noenhanced\n";
    text += high > low ? fmt::format("set cbrange [{:.12g}:{:.12g}]\n", low, high)
                       : "set cbrange [*:*]\n";
    // Cividis (Nuñez, Anderton, Renslow 2018): the same to the eyes of the colour-blind.
    text +=
        "set palette defined (0 '#00224e', 1 '#123570', 2 '#3b496c', 3 '#575d6d', 4 '#707173', "
        "5 '#8a8678', 6 '#a59c74', 7 '#c3b369', 8 '#e1cc55', 9 '#fee838')\n"
        "set style fill solid noborder\n"
        "plot $cells using 1:2:(0.5):(0.5):3 with boxxyerror palette, "
        "$failed using 1:2 with points pt 2 ps 1.5 lw 2 lc rgb '#D55E00'";
    if (x.values.size() <= most_written) {
      text += fmt::format(
          ", $cells using 1:2:4:($3 < {0:.12g} ? 0xffffff : 0) with labels font ',10' "
          "tc rgb variable",
          middle);
    }
    return text + "\n";
  }

  const SweepTable& table_;
  std::vector<ChartAxis> axes_;
};

}  // namespace

std::string sweep_chart_script(const SweepTable& table, const std::string& output) {
  return SweepChart(table).script(output);
}

}  // namespace sheave::tools
