// Bends, tensions and damage along ropes, drawn by gnuplot.

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/output/gnuplot.h"
#include "command/run/rope_files.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

/// More ropes are left to tables.
constexpr std::size_t most_drawn_ropes = 6;
constexpr int rope_panel_height = 260;

using OfSection = std::function<double(const measure::SectionHistory&)>;

/// One curve of a panel.
struct RopeCurve {
  const char* title;
  GnuplotPiece colour;
  OfSection value;
};

/// One panel: curves with one unit.
struct RopePanel {
  const char* label;
  std::vector<RopeCurve> curves;
};

std::vector<RopePanel> rope_panels(bool with_damage) {
  using Section = measure::SectionHistory;
  std::vector<RopePanel> panels;
  panels.push_back(
      {"bends",
       {{"simple bends", "#0072B2",
         [](const Section& s) { return s.all_bends().bends - s.all_bends().reverse; }},
        {"reverse bends", "#D55E00", [](const Section& s) { return s.all_bends().reverse; }}}});
  panels.push_back({"tension [N]",
                    {{"largest", "#000000", [](const Section& s) { return s.most_tension; }},
                     {"largest at a bend", "#D55E00",
                      [](const Section& s) {
                        return s.bends.empty() ? std::nan("") : s.all_bends().most_tension;
                      }},
                     {"least", "#56B4E9", [](const Section& s) { return s.least_tension; }}}});
  if (!with_damage) return panels;
  panels.push_back(
      {"damage of the run",
       {{"all bends", "#000000", [](const Section& s) { return s.damage(); }},
        {"simple bends", "#0072B2", [](const Section& s) { return s.all_bends().simple_damage; }},
        {"reverse bends", "#D55E00",
         [](const Section& s) { return s.all_bends().reverse_damage; }}}});
  return panels;
}

/// A value is that of a whole section, so the curve is a staircase.
ChartRows staircase(const measure::CableHistory& cable, const OfSection& value) {
  ChartRows rows;
  for (const measure::SectionHistory& section : cable.sections) {
    const double y = value(section);
    if (std::isfinite(y)) {
      rows.add({section.from, y});
      rows.add({section.to, y});
    } else if (!rows.empty()) {
      rows.add_gap();
    }
  }
  return rows;
}

void add_rope_panel(const measure::CableHistory& cable, const RopePanel& panel,
                    GnuplotScript& script) {
  GnuplotCode plots;
  for (const RopeCurve& curve : panel.curves) {
    const ChartRows rows = staircase(cable, curve.value);
    if (rows.empty()) continue;
    if (!plots.empty()) plots.add({", "});
    plots.add({script.block(rows), " using 1:2 with lines lw 2 lc rgb '", curve.colour, "' title ",
               script.shown(curve.title)});
  }
  if (plots.empty()) plots = {"NaN notitle"};
  script.add({"set xrange [0:", cable.sections.back().to, "]\nset xlabel ",
              script.shown(fmt::format("along \"{}\", from its first end [m]", cable.cable)),
              "\nset ylabel ", script.shown(panel.label), "\nplot ", plots, "\n"});
}

}  // namespace

void draw_rope_chart(const RopeOptions& options, const std::vector<measure::CableHistory>& cables,
                     const std::string& title) {
  std::vector<const measure::CableHistory*> drawn;
  for (const measure::CableHistory& cable : cables) {
    if (cable.followed && !cable.sections.empty()) drawn.push_back(&cable);
  }
  if (drawn.empty()) {
    throw Failure(ExitCode::usage,
                  options.chart +
                      ": no cable has sections to draw; closed and cut cables, and "
                      "cables on wrappable bodies, have none");
  }
  if (drawn.size() > most_drawn_ropes) {
    print_note(fmt::format("{}: the first {} of {} cables are drawn; --rope-history lists all",
                           options.chart, most_drawn_ropes, drawn.size()));
    drawn.resize(most_drawn_ropes);
  }
  const std::vector<RopePanel> panels = rope_panels(!options.life.empty());
  const std::size_t rows = drawn.size() * panels.size();
  GnuplotScript script(chart_format(options.chart),
                       60 + rope_panel_height * static_cast<int>(rows));
  script.add({"set grid lc rgb '#dddddd'\nset key outside right top spacing 1.2\n"});
  script.add({"set multiplot layout ", rows, ",1 title ", script.shown(title), "\n"});
  // Equal margins align the panels. A tension or a count of zero is at the lower edge.
  script.add({"set lmargin 12\nset rmargin 24\nset yrange [0:*]\nset offsets 0,0,graph 0.08,0\n"});
  for (const measure::CableHistory* cable : drawn) {
    for (const RopePanel& panel : panels) add_rope_panel(*cable, panel, script);
  }
  script.add({"unset multiplot\n"});
  draw_with_gnuplot(options.chart, script);
}

}  // namespace sheave::command
