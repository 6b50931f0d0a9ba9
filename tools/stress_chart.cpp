// sheave stress: one map as a heat map, drawn by gnuplot.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tools/gnuplot.h"
#include "tools/stress_table.h"

namespace sheave::tools {
namespace {

using measure::StressKind;

/// Errors shown by colour, as powers of ten; all that is outside is shown as the nearest.
constexpr double least_power = -12.0;
constexpr double most_power = 2.0;

/// The letter of a fault in a cell; empty for numbers.
std::string letter_of(const StressOutcome& outcome) {
  constexpr std::array<const char*, 7> letters{"", "", "r", "D", "E", "S", "L"};
  return std::string(letters[static_cast<std::size_t>(outcome.verdict.kind)]) +
         (outcome.silent() ? "!" : "");
}

std::string tics(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("{}'{:.2g}' {}", i > 0 ? ", " : "", values[i], i);
  }
  return text;
}

}  // namespace

std::string stress_script(const StressResult& result, const std::string& output) {
  const measure::StressMap& map = result.map;
  const std::size_t columns = map.x.values.size();
  std::string errors = "$errors << end\n";
  std::string letters = "$letters << end\n";
  for (std::size_t i = 0; i < result.outcomes.size(); ++i) {
    const StressOutcome& outcome = result.outcomes[i];
    const double error = outcome.verdict.error;
    const double power = std::isfinite(error) ? std::clamp(std::log10(std::max(error, 1e-300)),
                                                           least_power, most_power)
                                              : most_power;
    // What was refused has no colour.
    const bool refused = outcome.verdict.kind == StressKind::refused;
    errors += fmt::format("{} {} {}\n", i % columns, i / columns,
                          refused ? "NaN" : fmt::format("{:.3f}", power));
    const std::string letter = letter_of(outcome);
    if (!letter.empty()) letters += fmt::format("{} {} {}\n", i % columns, i / columns, letter);
  }
  // Never empty: gnuplot refuses to plot nothing.
  letters += "-9 -9 .\nend\n";
  std::string script = errors + "end\n" + letters + gnuplot_terminal(output, 480);
  script +=
      "set title " + gnuplot_quoted(map.name + ", " + result.settings.name()) + " noenhanced\n";
  script +=
      "set label 1 'D diverged, E energy gain, S false slack, L lost length, r refused, ! no "
      "warning' at graph 0.5, -0.22 center font ',9'\n";
  script += "set bmargin 6\nunset key\nset datafile missing 'NaN'\n";
  script += fmt::format("set xtics ({})\nset ytics ({})\n", tics(map.x.values), tics(map.y.values));
  script += "set xlabel " + gnuplot_quoted(map.x.name) + " noenhanced\n";
  script += "set ylabel " + gnuplot_quoted(map.y.name) + " noenhanced\n";
  script += fmt::format("set xrange [-0.5:{}]\nset yrange [-0.5:{}]\n",
                        static_cast<double>(columns) - 0.5,
                        static_cast<double>(map.y.values.size()) - 0.5);
  script +=
      fmt::format("set cbrange [{}:{}]\nset cblabel 'relative error'\n", least_power, most_power);
  script += "set format cb '10^{%.0f}'\n";
  // Green up to a thousandth, yellow at a hundredth, red from a tenth on.
  script +=
      "set palette defined (-12 '#1a9850', -6 '#66bd63', -3 '#d9ef8b', -2 '#fee08b', "
      "-1 '#f46d43', 2 '#a50026')\n";
  script +=
      "set style fill solid\nplot $errors using 1:2:(0.5):(0.5):3 with boxxyerror palette, "
      "$letters using 1:2:3 with labels font ',9'\n";
  return script + "set output\n";
}

}  // namespace sheave::tools
