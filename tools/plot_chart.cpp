// sheave plot: runs as a chart, drawn by gnuplot, and in numbers.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/quantity_unit.h"
#include "tools/gnuplot.h"
#include "tools/plot_data.h"

namespace sheave::tools {
namespace {

using PlotJson = nlohmann::ordered_json;

/// Colours that the colour-blind tell apart (Okabe and Ito 2008), without the yellow, which is too
/// light for a line.
constexpr std::array<const char*, 7> plot_colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#E69F00", "#56B4E9", "#000000"};
/// More events than this are marked without words.
constexpr std::size_t most_worded_events = 12;

std::string axis_label(const std::string& name) {
  const std::string unit = quantity_unit(name).value_or("");
  return unit.empty() ? name : name + " [" + unit + "]";
}

/// What is drawn in one panel: quantities with one unit, of all runs.
struct PlotPanel {
  std::string unit;
  std::vector<std::string> names;
};

std::vector<PlotPanel> panels_of(const std::vector<PlotRun>& runs) {
  std::vector<PlotPanel> panels;
  for (const PlotRun& run : runs) {
    for (std::size_t i = 1; i < run.names.size(); ++i) {
      const std::string unit = quantity_unit(run.names[i]).value_or("");
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
  if (panel.names.size() == 1) return axis_label(panel.names.front());
  // What all names end in, if they all do: "tension [N]".
  std::string last = panel.names.front().substr(panel.names.front().rfind('.') + 1);
  for (const std::string& name : panel.names) {
    if (!name.ends_with("." + last)) last.clear();
  }
  if (panel.unit.empty()) return last;
  return last.empty() ? "[" + panel.unit + "]" : last + " [" + panel.unit + "]";
}

std::string block_name(std::size_t run, std::size_t quantity) {
  return fmt::format("$data{}_{}", run, quantity);
}

std::string data_blocks(const std::vector<PlotRun>& runs) {
  std::string text;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t q = 1; q < runs[r].names.size(); ++q) {
      text += block_name(r, q) + " << end\n";
      const std::vector<double>& x = runs[r].values[0];
      const std::vector<double>& y = runs[r].values[q];
      bool any = false;
      for (std::size_t i = 0; i < x.size(); ++i) {
        // A gap, as in the first row of forces, breaks the line.
        const bool drawn = std::isfinite(x[i]) && std::isfinite(y[i]);
        if (drawn) {
          text += fmt::format("{:.12g} {:.12g}\n", x[i], y[i]);
        } else if (any) {
          text += "\n";
        }
        any = any || drawn;
      }
      if (!any) text += "NaN NaN\n";
      text += "end\n";
    }
  }
  return text;
}

/// Lines at the moments when something happened, the same in all panels; words in the first.
std::string event_marks(const std::vector<PlotRun>& runs, bool worded) {
  std::map<double, std::string> events;
  for (const PlotRun& run : runs) {
    for (const PlotEvent& event : run.events) {
      std::string& text = events[event.time];
      if (text.find(event.text) != std::string::npos) continue;
      text += (text.empty() ? "" : ", ") + event.text;
    }
  }
  std::string script = "unset arrow\nunset label\n";
  for (const auto& [time, text] : events) {
    script += fmt::format(
        "set arrow from first {0:.12g}, graph 0 to first {0:.12g}, graph 1 nohead dt 3 lc rgb "
        "'#888888' back\n",
        time);
    if (!worded || events.size() > most_worded_events) continue;
    script += fmt::format(
        "set label {} at first {:.12g}, graph 0.98 rotate by 90 right noenhanced font ',9' tc rgb "
        "'#555555' offset 0.7,0\n",
        gnuplot_quoted(text), time);
  }
  return script;
}

}  // namespace

std::string plot_script(const std::vector<PlotRun>& runs, const std::string& title,
                        const std::string& output) {
  const std::vector<PlotPanel> panels = panels_of(runs);
  constexpr int first_height = 560;
  constexpr int next_height = 320;
  const int height =
      panels.size() == 1
          ? first_height
          : 60 + next_height * static_cast<int>(std::max<std::size_t>(panels.size(), 1));
  std::string script = data_blocks(runs) + gnuplot_terminal(output, height);
  script += "set grid lc rgb '#dddddd'\nset key outside right top noenhanced spacing 1.2\n";
  script += fmt::format("set multiplot layout {},1 title {} noenhanced\n", panels.size(),
                        gnuplot_quoted(title));
  script += "set lmargin 12\nset rmargin 30\n";  // one below the other
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const PlotPanel& panel = panels[p];
    script += event_marks(runs, p == 0);
    script += "set xlabel " + gnuplot_quoted(axis_label(runs.front().names.front())) +
              " noenhanced\nset ylabel " + gnuplot_quoted(panel_label(panel)) + " noenhanced\n";
    std::string plots;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      for (std::size_t q = 1; q < runs[r].names.size(); ++q) {
        const auto found = std::find(panel.names.begin(), panel.names.end(), runs[r].names[q]);
        if (found == panel.names.end()) continue;
        const auto place = static_cast<std::size_t>(found - panel.names.begin());
        // Colours tell quantities apart and dashes runs; of one quantity, both tell runs apart.
        const std::size_t colour = panel.names.size() == 1 ? r : place;
        std::string label = runs[r].names[q];
        if (runs.size() > 1) label += ", " + runs[r].label;
        plots += fmt::format("{}{} using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}",
                             plots.empty() ? "" : ", ", block_name(r, q), r % 5 + 1,
                             plot_colours[colour % plot_colours.size()], gnuplot_quoted(label));
      }
    }
    script += "plot " + plots + "\n";
  }
  return script + "unset multiplot\nset output\n";
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
                        {"unit", quantity_unit(run.names[q]).value_or("")},
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

}  // namespace sheave::tools
