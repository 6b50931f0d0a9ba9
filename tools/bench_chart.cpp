// sheave bench: times and errors of all rows as a picture, drawn by gnuplot.

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "tools/bench_table.h"
#include "tools/failure.h"
#include "tools/gnuplot.h"

namespace sheave::tools {
namespace {

/// Rows that get one colour.
struct Series {
  const char* title;
  bool (*contains)(const BenchRow& row);
};
constexpr std::array<Series, 3> chart_series{
    {{"gauss-seidel, as in the paper",
      [](const BenchRow& row) { return row.settings.solver == SolverKind::gauss_seidel; }},
     {"direct",
      [](const BenchRow& row) {
        return row.settings.solver == SolverKind::direct &&
               row.settings.integrator == IntegratorKind::xpbd;
      }},
     {"direct, rattle", [](const BenchRow& row) {
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

/// Where a scene stands on the horizontal axis.
double place_of(const std::vector<std::string>& names, const std::string& scene) {
  return static_cast<double>(std::find(names.begin(), names.end(), scene) - names.begin());
}

/// Data blocks: $paper, then $series0, 1, ...: place, time, its quartiles, error.
std::string data_blocks(const BenchTable& table, const std::vector<std::string>& names) {
  std::string text = "$paper << end\n";
  for (const BenchRow& row : table.rows) {
    if (!row.measured() || !row.paper_seconds) continue;
    text += fmt::format("{} {:.6e}\n", place_of(names, row.scene) - 0.3, 1e3 * *row.paper_seconds);
  }
  text += "end\n";
  for (std::size_t s = 0; s < chart_series.size(); ++s) {
    text += fmt::format("$series{} << end\n", s);
    std::string last;
    for (const BenchRow& row : table.rows) {
      if (!row.measured() || !chart_series[s].contains(row)) continue;
      // Two settings of one scene and series stand side by side.
      const double aside = row.scene == last ? 0.07 : 0.0;
      last = row.scene;
      // A logarithmic axis has no zero; what is below 1e-16 is none.
      text += fmt::format("{} {:.6e} {:.6e} {:.6e} {:.6e}\n",
                          place_of(names, row.scene) - 0.12 + 0.18 * static_cast<double>(s) + aside,
                          1e3 * row.seconds.median, 1e3 * row.seconds.lower,
                          1e3 * row.seconds.upper, std::max(row.error.position, 1e-16));
    }
    text += "end\n";
  }
  return text;
}

}  // namespace

std::string chart_script(const BenchTable& table, const std::string& output) {
  const std::vector<std::string> names = scene_names(table);
  std::string script = data_blocks(table, names);
  script += chart_terminal(output, 1000, 800);
  script += "set output " + chart_quoted(output) + "\n";
  script += "set logscale y\nset format y '10^{%T}'\nset grid y\nset xtics (";
  for (std::size_t i = 0; i < names.size(); ++i) {
    script += fmt::format("{}{} {}", i > 0 ? ", " : "", chart_quoted(names[i]), i);
  }
  script +=
      fmt::format(") nomirror\nset xrange [-0.5:{}]\n", static_cast<double>(names.size()) - 0.5);
  script += "set multiplot layout 2,1\nset key outside top center horizontal\n";
  script += "set ylabel 'time of a frame [ms]'\nplot ";
  const bool paper = std::any_of(table.rows.begin(), table.rows.end(), [](const BenchRow& row) {
    return row.measured() && row.paper_seconds;
  });
  if (paper)
    script += "$paper using 1:2 with points pt 2 ps 1.5 lw 2 lc rgb '#888888' title 'paper, 2018'";
  constexpr std::array<const char*, 3> colours{"#c0392b", "#2471a3", "#1e8449"};
  std::string times;
  std::string errors;
  for (std::size_t s = 0; s < chart_series.size(); ++s) {
    const bool used = std::any_of(table.rows.begin(), table.rows.end(), [&](const BenchRow& row) {
      return row.measured() && chart_series[s].contains(row);
    });
    if (!used) continue;
    times += fmt::format(
        "{}$series{} using 1:2:3:4 with yerrorbars pt 7 ps 1.2 lw 2 lc rgb '{}' title '{}'",
        times.empty() && !paper ? "" : ", ", s, colours[s], chart_series[s].title);
    errors += fmt::format("{}$series{} using 1:5 with points pt 7 ps 1.2 lc rgb '{}' notitle",
                          errors.empty() ? "" : ", ", s, colours[s]);
  }
  script += times + "\nset ylabel 'error [scene size]'\nplot " + errors;
  return script + "\nunset multiplot\nset output\n";
}

void draw_chart(const BenchTable& table, const std::string& path) {
  if (!path.ends_with(".png") && !path.ends_with(".svg")) {
    throw Failure(ExitCode::usage, "--chart " + path + ": the name must end in .png or .svg");
  }
  if (scene_names(table).empty()) throw Failure(ExitCode::io, path + ": there is nothing to draw");
  draw_with_gnuplot(path, [&](const std::string& output) { return chart_script(table, output); });
}

}  // namespace sheave::tools
