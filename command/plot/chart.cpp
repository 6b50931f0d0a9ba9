// sheave plot: runs as a chart, drawn by gnuplot, and in numbers.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/plot/data.h"

namespace sheave::command {
namespace {

using PlotJson = nlohmann::ordered_json;

/// Colours that colour-blind readers can distinguish (Okabe and Ito 2008), without the yellow,
/// which is too light for a line.
constexpr std::array<GnuplotPiece, 7> plot_colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                   "#E69F00", "#56B4E9", "#000000"};
/// With more events than this the marks have no text.
constexpr std::size_t most_worded_events = 12;

std::string axis_label(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

/// One panel: the quantities with one unit, of all runs.
struct PlotPanel {
  std::string unit;
  std::vector<std::string> names;
};

std::vector<PlotPanel> panels_of(const std::vector<PlotRun>& runs) {
  std::vector<PlotPanel> panels;
  for (const PlotRun& run : runs) {
    for (std::size_t i = 1; i < run.names.size(); ++i) {
      const std::string& unit = run.units[i];
      auto panel = std::find_if(panels.begin(), panels.end(),
                                [&](const PlotPanel& other) { return other.unit == unit; });
      if (panel == panels.end()) panel = panels.insert(panels.end(), PlotPanel{unit, {}});
      if (std::count(panel->names.begin(), panel->names.end(), run.names[i]) == 0) {
        panel->names.push_back(run.names[i]);
      }
    }
  }
  return panels;
}

std::string panel_label(const PlotPanel& panel) {
  if (panel.names.size() == 1) return axis_label(panel.names.front(), panel.unit);
  // The common last part of all names, if there is one: "tension [N]".
  std::string last = panel.names.front().substr(panel.names.front().rfind('.') + 1);
  for (const std::string& name : panel.names) {
    if (!name.ends_with("." + last)) last.clear();
  }
  if (panel.unit.empty()) return last;
  return last.empty() ? "[" + panel.unit + "]" : last + " [" + panel.unit + "]";
}

/// One quantity of a run against the horizontal quantity.
ChartRows plotted_rows(const PlotRun& run, std::size_t quantity) {
  const std::vector<double>& x = run.values[0];
  const std::vector<double>& y = run.values[quantity];
  ChartRows rows;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(y[i])) {
      rows.add({x[i], y[i]});
    } else if (!rows.empty()) {
      // A missing value, such as a force before the first step, interrupts the line.
      rows.add_gap();
    }
  }
  return rows;
}

/// Lines at the times of events, in all panels; texts only in the first panel.
void mark_events(const std::vector<PlotRun>& runs, bool worded, GnuplotScript& script) {
  std::map<double, std::string> events;
  for (const PlotRun& run : runs) {
    for (const PlotEvent& event : run.events) {
      std::string& text = events[event.time];
      if (text.find(event.text) != std::string::npos) continue;
      text += (text.empty() ? "" : ", ") + event.text;
    }
  }
  script.add({"unset arrow\nunset label\n"});
  for (const auto& [time, text] : events) {
    script.add({"set arrow from first ", time, ", graph 0 to first ", time,
                ", graph 1 nohead dt 3 lc rgb '#888888' back\n"});
    if (!worded || events.size() > most_worded_events) continue;
    script.add({"set label ", script.shown(text), " at first ", time,
                ", graph 0.98 rotate by 90 right font ',9' tc rgb '#555555' offset 0.7,0\n"});
  }
}

/// Whether a panel has a point; gnuplot finds no axis range without points.
bool has_points(const std::vector<PlotRun>& runs, const PlotPanel& panel) {
  for (const PlotRun& run : runs) {
    for (std::size_t q = 1; q < run.names.size(); ++q) {
      const bool drawn = std::count(panel.names.begin(), panel.names.end(), run.names[q]) > 0;
      for (std::size_t i = 0; drawn && i < run.values[q].size(); ++i) {
        if (std::isfinite(run.values[0][i]) && std::isfinite(run.values[q][i])) return true;
      }
    }
  }
  return false;
}

/// The plot command of a panel.
GnuplotCode panel_plots(const std::vector<PlotRun>& runs, const PlotPanel& panel,
                        GnuplotScript& script) {
  GnuplotCode plots;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t q = 1; q < runs[r].names.size(); ++q) {
      const auto found = std::find(panel.names.begin(), panel.names.end(), runs[r].names[q]);
      if (found == panel.names.end()) continue;
      const auto place = static_cast<std::size_t>(found - panel.names.begin());
      // Colours distinguish quantities and dashes distinguish runs. If there is one quantity, both
      // distinguish runs.
      const std::size_t colour = panel.names.size() == 1 ? r : place;
      std::string label = runs[r].names[q];
      if (runs.size() > 1) label += ", " + runs[r].label;
      if (!plots.empty()) plots.add({", "});
      plots.add(
          {script.block(plotted_rows(runs[r], q)), " using 1:2 with ",
           runs[r].scattered ? GnuplotPiece("points pt 7 ps 0.8") : GnuplotPiece("lines lw 2 dt "),
           runs[r].scattered ? GnuplotCode() : GnuplotCode{r % 5 + 1}, " lc rgb '",
           plot_colours[colour % plot_colours.size()], "' title ", script.shown(label)});
    }
  }
  return plots;
}

}  // namespace

GnuplotScript plot_script(const std::vector<PlotRun>& runs, const std::string& title,
                          ChartFormat format) {
  const std::vector<PlotPanel> panels = panels_of(runs);
  constexpr int first_height = 560;
  constexpr int next_height = 320;
  const int height =
      panels.size() == 1
          ? first_height
          : 60 + next_height * static_cast<int>(std::max<std::size_t>(panels.size(), 1));
  GnuplotScript script(format, height);
  script.add({"set grid lc rgb '#dddddd'\nset key outside right top spacing 1.2\n"});
  script.add({"set multiplot layout ", panels.size(), ",1 title ", script.shown(title), "\n"});
  script.add({"set lmargin 12\nset rmargin 30\n"});  // equal margins align the panels
  for (std::size_t p = 0; p < panels.size(); ++p) {
    mark_events(runs, p == 0, script);
    if (has_points(runs, panels[p])) {
      script.add({"set xrange [*:*]\nset yrange [*:*]\n"});
    } else {
      script.add({"set xrange [0:1]\nset yrange [0:1]\n"});
    }
    script.add({"set xlabel ",
                script.shown(axis_label(runs.front().names.front(), runs.front().units.front())),
                "\nset ylabel ", script.shown(panel_label(panels[p])), "\nplot ",
                panel_plots(runs, panels[p], script), "\n"});
  }
  script.add({"unset multiplot\n"});
  return script;
}

std::string plot_json(const std::vector<PlotRun>& runs, const std::string& file) {
  PlotJson series = PlotJson::array();
  PlotJson events = PlotJson::array();
  for (const PlotRun& run : runs) {
    for (std::size_t q = 1; q < run.names.size(); ++q) {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      std::size_t points = 0;
      for (const double value : run.values[q]) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
        ++points;
      }
      series.push_back({{"run", run.label},
                        {"x", run.names.front()},
                        {"quantity", run.names[q]},
                        {"unit", run.units[q]},
                        {"points", points},
                        {"minimum", points > 0 ? PlotJson(low) : PlotJson(nullptr)},
                        {"maximum", points > 0 ? PlotJson(high) : PlotJson(nullptr)}});
    }
    for (const PlotEvent& event : run.events) {
      events.push_back({{"run", run.label}, {"time", event.time}, {"event", event.text}});
    }
  }
  const PlotJson json{{"file", file}, {"series", std::move(series)}, {"events", std::move(events)}};
  return json.dump(-1, ' ', false, PlotJson::error_handler_t::replace) + "\n";
}

}  // namespace sheave::command
