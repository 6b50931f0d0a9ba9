// sheave stress: one map as a heat map, drawn by gnuplot.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "command/output/log_axis.h"
#include "command/stress/table.h"

namespace sheave::command {
namespace {

using measure::StressKind;

/// The range of errors shown by colour, as powers of ten. Errors outside get the nearest colour.
constexpr double least_power = -12.0;
constexpr double most_power = 2.0;
/// Above this power the colours are so dark that the text is white.
constexpr double dark_power = -0.5;

/// The mark in a cell, which makes the map readable without colours: the power of ten of the error,
/// or the letter of the kind of failure.
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

/// "1/60", "10⁴", "0.3", "5x10⁻⁶".
std::string tic_text(double value) {
  for (const double part : {30.0, 60.0}) {
    if (std::abs(value * part - 1.0) < 1e-9) return fmt::format("1/{:g}", part);
  }
  if (value == 0.0 || (std::abs(value) >= 0.01 && std::abs(value) < 1000.0)) {
    return fmt::format("{:.3g}", value);
  }
  const double power = std::floor(std::log10(std::abs(value)) + 1e-9);
  const double factor = value / std::pow(10.0, power);
  const std::string ten = power_of_ten(static_cast<int>(power));
  return std::abs(factor - 1.0) < 1e-6 ? ten : fmt::format("{:.2g}x{}", factor, ten);
}

GnuplotCode tics(const std::vector<double>& values, GnuplotScript& script) {
  GnuplotCode list;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) list.add({", "});
    list.add({script.tic(tic_text(values[i]), static_cast<double>(i))});
  }
  return list;
}

/// The data of the cells: positions, powers of ten of the errors, and marks.
struct StressRows {
  ChartRows errors;
  ChartRows on_dark;   ///< white marks, for dark cells
  ChartRows on_light;  ///< black marks, for light cells
};

StressRows stress_rows(const StressResult& result, GnuplotScript& script) {
  const std::size_t columns = result.map.x.values.size();
  StressRows rows;
  for (std::size_t i = 0; i < result.outcomes.size(); ++i) {
    const StressOutcome& outcome = result.outcomes[i];
    const double error = outcome.verdict.error;
    const double power = std::isfinite(error) ? std::clamp(std::log10(std::max(error, 1e-300)),
                                                           least_power, most_power)
                                              : most_power;
    // A refused cell has no colour.
    const bool refused = outcome.verdict.kind == StressKind::refused;
    const auto x = static_cast<double>(i % columns);
    const auto line = i / columns;
    const auto y = static_cast<double>(line);
    rows.errors.add({x, y, refused ? std::numeric_limits<double>::quiet_NaN() : power});
    const bool dark = !refused && power > dark_power;
    (dark ? rows.on_dark : rows.on_light).add({x, y, script.shown_number(mark_of(outcome))});
  }
  // A point outside the map: gnuplot refuses to plot an empty block.
  for (ChartRows* marks : {&rows.on_dark, &rows.on_light}) {
    marks->add({-9.0, -9.0, script.shown_number(".")});
  }
  return rows;
}

/// The colour scale.
void set_palette(GnuplotScript& script) {
  GnuplotCode powers;
  for (int i = static_cast<int>(least_power); i <= static_cast<int>(most_power); i += 2) {
    if (!powers.empty()) powers.add({", "});
    powers.add({script.tic(power_of_ten(i), i)});
  }
  script.add({"set cbrange [", least_power, ":", most_power, "]\nset cbtics (", powers,
              ")\nset cblabel 'relative error'\n"});
  // White to blue up to an error of 0.1, orange to brown above. People with any kind of colour
  // vision, and grey prints, can distinguish the two ranges.
  script.add(
      {"set palette defined (-12 '#ffffff', -6 '#deebf7', -3 '#c6dbef', -1.01 '#9ecae1', "
       "-1 '#fdae6b', 0 '#e6550d', 2 '#7f2704')\n"});
}

}  // namespace

std::string stress_chart_name(const StressResult& result) {
  return fmt::format("{}-{}-{}", result.map.name,
                     solver_names[static_cast<std::size_t>(result.settings.solver)],
                     integrator_names[static_cast<std::size_t>(result.settings.integrator)]);
}

GnuplotScript stress_script(const StressResult& result, ChartFormat format) {
  const measure::StressMap& map = result.map;
  GnuplotScript script(format, 480);
  const StressRows rows = stress_rows(result, script);
  script.add({"set title ", script.shown(map.name + ", " + result.settings.name()), "\n"});
  script.add(
      {"set label 1 'in a cell: the power of ten that its error is below, or the failure: W "
       "error above 10 %, D diverged and stopped,' at graph 0.5, -0.23 center font ',10'\n"
       "set label 2 'E energy gain, S false slack, L lost length; ! without a warning; r refused: "
       "not a valid scene' at graph 0.5, -0.29 center font ',10'\n"});
  script.add({"set bmargin 7\nunset key\nset datafile missing 'NaN'\n"});
  script.add({"set xtics (", tics(map.x.values, script), ")\nset ytics (",
              tics(map.y.values, script), ")\n"});
  script.add(
      {"set xlabel ", script.shown(map.x.name), "\nset ylabel ", script.shown(map.y.name), "\n"});
  script.add({"set xrange [-0.5:", static_cast<double>(map.x.values.size()) - 0.5,
              "]\nset yrange [-0.5:", static_cast<double>(map.y.values.size()) - 0.5, "]\n"});
  set_palette(script);
  const GnuplotCode mark = GnuplotScript::shown_of_column(3);
  script.add({"set style fill solid border lc rgb '#d0d0d0'\nplot ", script.block(rows.errors),
              " using 1:2:(0.5):(0.5):3 with boxxyerror palette, ", script.block(rows.on_light),
              " using 1:2:", mark, " with labels font ',10' tc rgb 'black', ",
              script.block(rows.on_dark), " using 1:2:", mark,
              " with labels font ',10' tc rgb 'white'\n"});
  return script;
}

}  // namespace sheave::command
