#include "command/plot/data.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string_view>

#include <fnmatch.h>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/run/summary.h"
#include "engine/joint_report.h"
#include "scenes/suggestion.h"

namespace sheave::command {
namespace {

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_table_bytes = std::size_t{512} << 20U;
/// Number of stored samples: more than a picture has pixel columns.
constexpr std::size_t most_moments = 8000;
/// Of one input, far more than can be told apart; gnuplot's time grows with their square.
constexpr std::size_t most_curves = 2000;

/// Indices of the columns of the choice, the horizontal one first.
std::vector<int> chosen_columns(const PlotChoice& choice, const std::vector<std::string>& names,
                                const std::function<std::string(const std::string&)>& missing) {
  std::vector<int> columns;
  std::vector<bool> drawn(names.size(), false);  // but for the horizontal one
  const auto add_all = [&](const std::string& pattern, bool one) {
    bool found = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] != pattern && ::fnmatch(pattern.c_str(), names[i].c_str(), 0) != 0) continue;
      found = true;
      const int column = static_cast<int>(i);
      if (one || !drawn[i]) columns.push_back(column);
      if (one) return;
      drawn[i] = true;
    }
    if (!found) throw Failure(ExitCode::usage, missing(pattern));
  };
  add_all(choice.x, true);
  for (const std::string& pattern : choice.patterns) add_all(pattern, false);
  if (columns.size() > 1 + most_curves) {
    throw Failure(
        ExitCode::usage,
        fmt::format("{} quantities are too many for a picture: at most {} can be drawn of "
                    "one input; name fewer",
                    columns.size() - 1, most_curves));
  }
  return columns;
}

std::string no_column(const std::string& path, const std::vector<std::string>& names,
                      const std::string& wanted) {
  Suggestion suggestion(wanted);
  for (const std::string& name : names) suggestion.consider(name);
  return fmt::format("{}: there is no column \"{}\"{}", path, wanted, suggestion.question());
}

/// Whether a column such as "rope.cut" or "joint.broken" indicates an event.
bool tells_event(const std::string& name) {
  return name.ends_with(".cut") || name.ends_with(".broken");
}

void add_event(const std::string& name, double before, double now, double time, PlotRun& run) {
  if (!(before == 0.0 && now == 1.0)) return;
  const std::size_t dot = name.rfind('.');
  run.events.push_back({time, name.substr(0, dot) + " " + name.substr(dot + 1)});
}

/// The cells of a line; quoted cells may contain commas.
std::vector<std::string> csv_cells(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

double csv_number(const std::string& text, const std::string& path, std::size_t line,
                  const std::string& column) {
  if (text.empty()) return missing_value;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw Failure(ExitCode::bad_scene, fmt::format("{}:{}: column \"{}\": \"{}\" is no number",
                                                   path, line, column, text));
  }
  return value;
}

PlotRun read_csv(const std::string& text, const std::string& path, const PlotChoice& choice) {
  std::size_t line_number = 0;
  std::size_t begin = 0;
  std::vector<std::string> names;
  std::vector<int> columns;
  std::vector<std::size_t> events;
  std::vector<double> last;
  PlotRun run;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    if (line.empty()) continue;
    const std::vector<std::string> cells = csv_cells(line);
    if (names.empty()) {
      names = cells;
      columns = chosen_columns(
          choice, names, [&](const std::string& wanted) { return no_column(path, names, wanted); });
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (tells_event(names[i])) events.push_back(i);
      }
      last.assign(events.size(), missing_value);
      for (const int column : columns) run.names.push_back(names[static_cast<std::size_t>(column)]);
      run.values.resize(columns.size());
      continue;
    }
    if (cells.size() != names.size()) {
      throw Failure(ExitCode::bad_scene,
                    fmt::format("{}:{}: {} cells where the first line has {} names", path,
                                line_number, cells.size(), names.size()));
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto column = static_cast<std::size_t>(columns[c]);
      run.values[c].push_back(csv_number(cells[column], path, line_number, names[column]));
    }
    for (std::size_t e = 0; e < events.size(); ++e) {
      const double now = csv_number(cells[events[e]], path, line_number, names[events[e]]);
      add_event(names[events[e]], last[e], now, run.values[0].back(), run);
      last[e] = now;
    }
  }
  if (names.empty()) throw Failure(ExitCode::bad_scene, path + ":1: there is no line of names");
  return run;
}

/// The header of a .npy file with one number per column and row.
struct NpyHeader {
  std::vector<std::string> names;
  std::size_t data = 0;  ///< offset of the data
};

[[noreturn]] void bad_npy(const std::string& path, const std::string& what) {
  throw Failure(ExitCode::bad_scene,
                path + ": " + what +
                    "; allowed is a structured array of float64, as `sheave run "
                    "--out` writes it");
}

NpyHeader npy_header(const std::string& text, const std::string& path) {
  constexpr std::string_view magic = "\x93NUMPY";
  if (!text.starts_with(magic) || text.size() < 12) bad_npy(path, "is no .npy file");
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  std::size_t length = byte(8) | static_cast<std::size_t>(byte(9)) << 8U;
  std::size_t begin = 10;
  if (byte(6) > 1) {
    length |= static_cast<std::size_t>(byte(10)) << 16U | static_cast<std::size_t>(byte(11)) << 24U;
    begin = 12;
  }
  if (begin + length > text.size()) bad_npy(path, "ends within its header");
  const std::string_view header = std::string_view(text).substr(begin, length);
  NpyHeader result;
  result.data = begin + length;
  const std::string type = std::endian::native == std::endian::little ? "'<f8'" : "'>f8'";
  std::size_t at = header.find("'descr': [");
  if (at == std::string_view::npos) bad_npy(path, "has no named columns");
  at += std::string_view("'descr': [").size();
  while (at < header.size() && header[at] == '(') {
    const std::size_t end = header.find('\'', at + 2);
    if (!header.substr(at).starts_with("('") || end == std::string_view::npos)
      bad_npy(path, "bad header");
    result.names.emplace_back(header.substr(at + 2, end - at - 2));
    if (header.substr(end + 1, type.size() + 3) != ", " + type + ")") {
      bad_npy(path, "column \"" + result.names.back() + "\" is no float64 of this machine");
    }
    at = end + type.size() + 4;
    while (at < header.size() && (header[at] == ',' || header[at] == ' ')) ++at;
  }
  if (result.names.empty()) bad_npy(path, "has no named columns");
  return result;
}

PlotRun read_npy(const std::string& text, const std::string& path, const PlotChoice& choice) {
  const NpyHeader header = npy_header(text, path);
  const std::size_t row = header.names.size() * sizeof(double);
  if ((text.size() - header.data) % row != 0) bad_npy(path, "ends within a row");
  const std::size_t count = (text.size() - header.data) / row;
  const std::vector<int> columns = chosen_columns(
      choice, header.names,
      [&](const std::string& wanted) { return no_column(path, header.names, wanted); });
  const auto value = [&](std::size_t k, std::size_t column) {
    double number = 0.0;
    const std::size_t at = header.data + k * row + column * sizeof(double);
    std::memcpy(&number, text.data() + at, sizeof number);
    return number;
  };
  PlotRun run;
  for (const int column : columns) {
    const auto c = static_cast<std::size_t>(column);
    run.names.push_back(header.names[c]);
    std::vector<double>& values = run.values.emplace_back(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = value(k, c);
  }
  for (std::size_t c = 0; c < header.names.size(); ++c) {
    if (!tells_event(header.names[c])) continue;
    for (std::size_t k = 1; k < count; ++k) {
      add_event(header.names[c], value(k - 1, c), value(k, c), run.values[0][k], run);
    }
  }
  return run;
}

}  // namespace

PlotRun read_plot_table(const std::string& path, const PlotChoice& choice) {
  const std::string text = read_input(path, most_table_bytes);
  PlotRun run =
      path.ends_with(".npy") ? read_npy(text, path, choice) : read_csv(text, path, choice);
  // The events can be placed only on an axis of time.
  if (run.names.front() != "t") run.events.clear();
  std::stable_sort(run.events.begin(), run.events.end(),
                   [](const PlotEvent& a, const PlotEvent& b) { return a.time < b.time; });
  return run;
}

PlotRecorder::PlotRecorder(const Simulation& simulation, const PlotChoice& choice)
    : observables_(simulation) {
  columns_ = chosen_columns(choice, observables_.names(), [&](const std::string& wanted) {
    return to_text(observables_.index_of(wanted).errors());
  });
  sample_.resize(columns_.size());
  values_.resize(columns_.size());
}

void PlotRecorder::observe(const Simulation& simulation) {
  if (observed_++ % stride_ != 0) return;
  observables_.sample(simulation, columns_, sample_);
  const bool at_start = simulation.world.state().steps == 0;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const bool unknown = at_start && !observables_.known_at_start(columns_[c]);
    values_[c].push_back(unknown ? missing_value : sample_[c]);
  }
  if (values_.front().size() > most_moments) thin_out();
}

void PlotRecorder::thin_out() {
  for (std::vector<double>& values : values_) {
    for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
    values.resize((values.size() + 1) / 2);
  }
  stride_ *= 2;
}

PlotRun PlotRecorder::run(const std::string& label, const Simulation& simulation) const {
  PlotRun run;
  run.label = label;
  for (const int column : columns_) {
    run.names.push_back(observables_.names()[static_cast<std::size_t>(column)]);
  }
  run.values = values_;
  if (run.names.front() != "t") return run;
  for (const RunEvent& event : collect_events(simulation, joint_reports(simulation.world))) {
    std::string text = event.subject + " " + std::string(event.kind);
    if (!event.body.empty()) text += " " + event.body;
    run.events.push_back({event.time, std::move(text)});
  }
  return run;
}

}  // namespace sheave::command
