// sheave trade: the work-precision chart, drawn by gnuplot.

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "tools/gnuplot.h"
#include "tools/trade_table.h"

namespace sheave::tools {
namespace {

constexpr std::array<std::array<const char*, 2>, 2> trade_colours{
    {{"#c0392b", "#e08e0b"}, {"#2471a3", "#1e8449"}}};  // [solver][integrator]

/// Rows of one solver and integrator; a logarithmic axis has no zero, and errors end where the reference knows no more.
std::string series_block(const TradeTable& table, SolverKind solver, IntegratorKind integrator) {
  const double least = std::max(table.doubt.position, rounding_error);
  std::string text;
  for (const TradeRow& row : table.rows) {
    const StepSettings& step = row.setting.step;
    if (!row.measured() || step.solver != solver || step.integrator != integrator) continue;
    text += fmt::format("{:.6e} {:.6e} {:.6e} {:.6e}\n", row.seconds.median,
                        std::max(row.error.position, least), row.seconds.lower, row.seconds.upper);
  }
  return text;
}

std::string front_block(const TradeTable& table) {
  const double least = std::max(table.doubt.position, rounding_error);
  std::vector<std::size_t> front = measure::pareto_front(table.points());
  std::string text;
  for (const std::size_t i : front) {
    const TradeRow& row = table.rows[i];
    text += fmt::format("{:.6e} {:.6e}\n", row.seconds.median, std::max(row.error.position, least));
  }
  return text;
}

/// "1.98", or nothing if there is no order.
std::string order_text(const TradeTable& table, SolverKind solver, IntegratorKind integrator) {
  for (const TradeFamily& family : table.families) {
    const bool same = family.name.starts_with(solver_names[static_cast<std::size_t>(solver)]) &&
                      family.name.ends_with(integrator_names[static_cast<std::size_t>(integrator)]);
    if (same && family.fit) return fmt::format(", order {:.2f}", family.fit->order);
  }
  return {};
}

}  // namespace

std::string trade_chart_script(const TradeTable& table, const std::string& output) {
  std::string blocks;
  std::string plots;
  for (std::size_t s = 0; s < solver_names.size(); ++s) {
    for (std::size_t i = 0; i < integrator_names.size(); ++i) {
      const auto solver = static_cast<SolverKind>(s);
      const auto integrator = static_cast<IntegratorKind>(i);
      const std::string data = series_block(table, solver, integrator);
      if (data.empty()) continue;
      const std::string name = fmt::format("$series{}{}", s, i);
      blocks += name + " << end\n" + data + "end\n";
      plots +=
          fmt::format("{}{} using 1:2:3:4 with xerrorbars pt 7 ps 1 lw 1.5 lc rgb '{}' title {}",
                      plots.empty() ? "" : ", ", name, trade_colours[s][i],
                      gnuplot_quoted(fmt::format("{}, {}{}", solver_names[s], integrator_names[i],
                                                 order_text(table, solver, integrator))));
    }
  }
  if (const std::string front = front_block(table); !front.empty()) {
    blocks += "$front << end\n" + front + "end\n";
    plots += ", $front using 1:2 with lines lw 2 lc rgb '#444444' title 'Pareto front'";
  }
  const auto failed = std::count_if(table.rows.begin(), table.rows.end(),
                                    [](const TradeRow& row) { return !row.measured(); });
  std::string script = blocks + gnuplot_terminal(output, 700);
  script += "set logscale xy\nset format xy '10^{%T}'\nset grid\n";
  script += "set key outside top center horizontal noenhanced\n";
  script += "set title " +
            gnuplot_quoted(failed > 0 ? fmt::format("{} ({} of {} settings failed)", table.scene,
                                                    failed, table.rows.size())
                                      : table.scene) +
            " noenhanced\n";
  script += "set xlabel 'CPU time per simulated second [s]'\n";
  script += "set ylabel 'position error [scene size]'\nplot " + plots + "\nset output\n";
  return script;
}

}  // namespace sheave::tools
