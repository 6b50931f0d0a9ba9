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
constexpr double dark_power = -0.5;  ///< above it the colours are so dark that text is white

/// What stands in a cell, so that nobody needs to tell colours apart: the power of ten of its
/// error, or the letter of what it failed by.
std::string mark_of(const StressOutcome& outcome) {
  constexpr std::array<const char*, 7> letters{"", "W", "r", "D", "E", "S", "L"};
  const StressKind kind = outcome.verdict.kind;
  if (kind == StressKind::right) {
    return outcome.verdict.error > 0.0
               ? fmt::format("{:.0f}", std::ceil(std::log10(outcome.verdict.error)))
               : "exact";
  }
  return std::string(letters[static_cast<std::size_t>(kind)]) + (outcome.silent() ? "!" : "");
}

/// "1/60", "10^{4}", "0.3", "5x10^{-6}".
std::string tic_text(double value) {
  for (const double part : {30.0, 60.0}) {
    if (std::abs(value * part - 1.0) < 1e-9) return fmt::format("1/{:g}", part);
  }
  if (value == 0.0 || (std::abs(value) >= 0.01 && std::abs(value) < 1000.0)) {
    return fmt::format("{:.3g}", value);
  }
  const double power = std::floor(std::log10(std::abs(value)) + 1e-9);
  const double factor = value / std::pow(10.0, power);
  const std::string ten = fmt::format("10^{{{:g}}}", power);
  return std::abs(factor - 1.0) < 1e-6 ? ten : fmt::format("{:.2g}x{}", factor, ten);
}

std::string tics(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("{}'{}' {}", i > 0 ? ", " : "", tic_text(values[i]), i);
  }
  return text;
}

}  // namespace

std::string stress_chart_name(const StressResult& result) {
  return fmt::format("{}-{}-{}", result.map.name,
                     solver_names[static_cast<std::size_t>(result.settings.solver)],
                     integrator_names[static_cast<std::size_t>(result.settings.integrator)]);
}

std::string stress_script(const StressResult& result, const std::string& output) {
  const measure::StressMap& map = result.map;
  const std::size_t columns = map.x.values.size();
  std::string errors = "$errors << end\n";
  // Never empty: gnuplot refuses to plot nothing.
  std::string dark = "$dark << end\n-9 -9 .\n";
  std::string light = "$light << end\n-9 -9 .\n";
  for (std::size_t i = 0; i < result.outcomes.size(); ++i) {
    const StressOutcome& outcome = result.outcomes[i];
    const double error = outcome.verdict.error;
    const double power = std::isfinite(error) ? std::clamp(std::log10(std::max(error, 1e-300)),
                                                           least_power, most_power)
                                              : most_power;
    // What was refused has no colour.
    const bool refused = outcome.verdict.kind == StressKind::refused;
    const std::string place = fmt::format("{} {}", i % columns, i / columns);
    errors += fmt::format("{} {}\n", place, refused ? "NaN" : fmt::format("{:.3f}", power));
    const bool on_dark = !refused && power > dark_power;
    (on_dark ? light : dark) += place + " " + mark_of(outcome) + "\n";
  }
  std::string script =
      errors + "end\n" + dark + "end\n" + light + "end\n" + gnuplot_terminal(output, 480);
  script +=
      "set title " + gnuplot_quoted(map.name + ", " + result.settings.name()) + " noenhanced\n";
  script +=
      "set label 1 'in a cell: the power of ten that its error is below, or what it failed by: W "
      "error "
      "above 10 %, D diverged and stopped,' at graph 0.5, -0.23 center font ',10'\n"
      "set label 2 'E energy gain, S false slack, L lost length; ! without a warning; r refused: "
      "not a "
      "valid scene' at graph 0.5, -0.29 center font ',10'\n";
  script += "set bmargin 7\nunset key\nset datafile missing 'NaN'\n";
  script += fmt::format("set xtics ({})\nset ytics ({})\n", tics(map.x.values), tics(map.y.values));
  script += "set xlabel " + gnuplot_quoted(map.x.name) + " noenhanced\n";
  script += "set ylabel " + gnuplot_quoted(map.y.name) + " noenhanced\n";
  script += fmt::format("set xrange [-0.5:{}]\nset yrange [-0.5:{}]\n",
                        static_cast<double>(columns) - 0.5,
                        static_cast<double>(map.y.values.size()) - 0.5);
  script +=
      fmt::format("set cbrange [{}:{}]\nset cblabel 'relative error'\n", least_power, most_power);
  script += "set format cb '10^{%.0f}'\n";
  // From white to blue up to a tenth, from orange to brown above: told apart by all kinds of colour
  // vision, and in grey.
  script +=
      "set palette defined (-12 '#ffffff', -6 '#deebf7', -3 '#c6dbef', -1.01 '#9ecae1', "
      "-1 '#fdae6b', 0 '#e6550d', 2 '#7f2704')\n";
  script +=
      "set style fill solid border lc rgb '#d0d0d0'\n"
      "plot $errors using 1:2:(0.5):(0.5):3 with boxxyerror palette, "
      "$dark using 1:2:3 with labels font ',10' tc rgb 'black', "
      "$light using 1:2:3 with labels font ',10' tc rgb 'white'\n";
  return script + "set output\n";
}

}  // namespace sheave::tools
