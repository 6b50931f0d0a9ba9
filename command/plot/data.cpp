#include "command/plot/data.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/input/quantity_choice.h"
#include "command/run/summary.h"
#include "engine/joint_report.h"
#include "scenes/csv.h"
#include "scenes/expression_list.h"
#include "scenes/quantity_unit.h"
#include "scenes/suggestion.h"
#include "scenes/unit.h"

namespace sheave::command {
namespace {

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_table_bytes = std::size_t{512} << 20U;
/// Number of stored samples: more than a picture has pixel columns.
constexpr std::size_t most_moments = 8000;
/// Of one input, far more than can be told apart; gnuplot's time grows with their square.
constexpr std::size_t most_curves = 2000;

/// Appends the quantities of the choice to a list, the horizontal one first. A Failure starts with
/// `place`.
template <class List>
void choose_columns(const PlotChoice& choice, const std::vector<std::string>& names,
                    const QuantityNames& index, const std::string& place, List& list) {
  std::vector<bool> drawn(names.size(), false);  // but for the horizontal one
  std::unordered_set<std::string> expressions;
  const auto find = [&](const std::string& text) {
    auto found = chosen_quantities(text, names, index);
    if (!found) throw Failure(ExitCode::usage, place + to_text(found.errors()));
    return std::move(*found);
  };
  ChosenQuantities x = find(choice.x);
  const auto add = [&](Expression&& expression, const std::string& text) {
    if constexpr (std::is_same_v<List, QuantityList>) {
      const Errors faults = list.add(std::move(expression), text);
      if (!faults.empty()) throw Failure(ExitCode::usage, place + to_text(faults));
    } else {
      list.add(std::move(expression), text);
    }
  };
  if (x.expression) add(std::move(*x.expression), choice.x);
  if (!x.expression) list.add(x.indices.front());
  for (const std::string& text : split_quantities(choice.lists)) {
    ChosenQuantities found = find(text);
    for (const int column : found.indices) {
      if (!drawn[static_cast<std::size_t>(column)]) list.add(column);
      drawn[static_cast<std::size_t>(column)] = true;
    }
    if (found.expression && expressions.insert(text).second) {
      add(std::move(*found.expression), text);
    }
  }
  if (list.size() <= 1 + most_curves) return;
  throw Failure(ExitCode::usage,
                fmt::format("{} quantities are too many for a picture: at most {} can be drawn of "
                            "one input; name fewer",
                            list.size() - 1, most_curves));
}

/// A column name with a unit behind it, "from [m]": the name and the unit. Nothing for others.
std::optional<std::pair<std::string, std::string>> with_unit(const std::string& name) {
  const std::size_t open = name.rfind(" [");
  if (open == std::string::npos || open == 0 || !name.ends_with(']')) return {};
  std::string unit = name.substr(open + 2, name.size() - open - 3);
  if (unit.empty() || !unit_powers(unit)) return {};
  return std::pair(name.substr(0, open), std::move(unit));
}

/// The columns of a table as quantities.
class ColumnNames final : public QuantityNames {
 public:
  /// `names` must outlive this object.
  explicit ColumnNames(const std::vector<std::string>& names) : names_(names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      indices_.emplace(names[i], static_cast<int>(i));
      longest_ = std::max(longest_, names[i].size());
    }
  }
  [[nodiscard]] std::optional<int> find(std::string_view name) const override {
    const auto found = indices_.find(name);
    return found == indices_.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] std::size_t longest() const override { return longest_; }
  [[nodiscard]] Unit unit(int index) const override {
    const std::optional<std::string> text = unit_text(index);
    // Open where the name does not tell the unit; a product with an open unit has no text.
    return text ? Unit(*text) : Unit("unknown").times(Unit());
  }
  [[nodiscard]] std::string fault(std::string_view name) const override {
    Suggestion suggestion(name);
    for (const std::string& candidate : names_) suggestion.consider(candidate);
    return fmt::format("there is no column \"{}\"{}", name, suggestion.question());
  }
  [[nodiscard]] std::optional<std::string> unit_text(int index) const {
    const std::string& name = names_[static_cast<std::size_t>(index)];
    if (const auto parts = with_unit(name)) return parts->second;
    return quantity_unit(name);
  }
  /// The name without its unit.
  [[nodiscard]] std::string label(int index) const {
    const std::string& name = names_[static_cast<std::size_t>(index)];
    const auto parts = with_unit(name);
    return parts ? parts->first : name;
  }

 private:
  const std::vector<std::string>& names_;
  std::unordered_map<std::string_view, int> indices_;
  std::size_t longest_ = 0;
};

/// The chosen columns of a table, and the chosen expressions of columns.
class TableColumns {
 public:
  TableColumns(const PlotChoice& choice, const std::vector<std::string>& names,
               const std::string& path) {
    const ColumnNames index(names);
    choose_columns(choice, names, index, path + ": ", list_);
    courses_.resize(list_.course_count());
    if (!courses_.empty()) {
      if (!index.find("t")) {
        throw Failure(ExitCode::usage,
                      path + ": a statistic over time needs the column \"t\", the time [s]");
      }
      // Its value is the last operand, whether it is drawn or not.
      list_.need(*index.find("t"));
      const auto& needed = list_.operands();
      time_ = static_cast<std::size_t>(std::find(needed.begin(), needed.end(), *index.find("t")) -
                                       needed.begin());
    }
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const int column = list_.quantity(i);
      run.names.push_back(column < 0 ? list_.text(i) : index.label(column));
      run.units.push_back(column < 0 ? list_.unit(i).text() : index.unit_text(column).value_or(""));
    }
    run.values.resize(list_.size());
    values_.resize(list_.size());
  }
  /// The columns that add_row() needs.
  [[nodiscard]] const std::vector<int>& needed() const { return list_.operands(); }
  /// `cells` has the values of needed().
  void add_row(const std::vector<double>& cells) {
    const ExpressionMoment moment{courses_.empty() ? 0.0 : cells[time_], rows_++ == 0, courses_};
    list_.evaluate(cells, values_, &moment);
    for (std::size_t i = 0; i < values_.size(); ++i) run.values[i].push_back(values_[i]);
  }

  PlotRun run;

 private:
  ExpressionList list_;
  std::vector<double> values_;
  std::vector<Course> courses_;
  std::size_t time_ = 0;  // its place among the cells
  std::size_t rows_ = 0;
};

/// Whether a column such as "rope.cut" or "joint.broken" indicates an event.
bool tells_event(const std::string& name) {
  return name.ends_with(".cut") || name.ends_with(".broken");
}

void add_event(const std::string& name, double before, double now, double time, PlotRun& run) {
  if (!(before == 0.0 && now == 1.0)) return;
  const std::size_t dot = name.rfind('.');
  run.events.push_back({time, name.substr(0, dot) + " " + name.substr(dot + 1)});
}

/// Whether the columns are those of a table of `sheave sweep` or `sheave tune`.
bool is_sweep(const std::vector<std::string>& names) {
  return names.front() == "run" && std::count(names.begin(), names.end(), "status") > 0 &&
         std::count(names.begin(), names.end(), "certificate") > 0;
}

/// The number in a cell, NaN in an empty one; a Failure with its place.
double csv_number(const CsvReader& reader, std::size_t column, const std::string& path) {
  if (reader.cells()[column].text.empty()) return missing_value;
  const auto number = reader.number(column);
  if (const auto* const fault = std::get_if<CsvFault>(&number)) {
    throw Failure(ExitCode::bad_scene, fault->text(path));
  }
  return std::get<double>(number);
}

/// Columns that tell events.
struct EventColumns {
  std::vector<std::size_t> columns;
  std::vector<double> last;  // values in the row before

  explicit EventColumns(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (tells_event(names[i])) columns.push_back(i);
    }
    last.assign(columns.size(), missing_value);
  }
};

PlotRun read_csv(const std::string& text, const std::string& path, const PlotChoice& choice) {
  CsvReader reader(text);
  const auto fail = [&](const CsvFault& fault) {
    throw Failure(ExitCode::bad_scene, fault.text(path));
  };
  const auto found_names = reader.names();
  if (const auto* const fault = std::get_if<CsvFault>(&found_names)) fail(*fault);
  const auto& names = std::get<std::vector<std::string>>(found_names);
  TableColumns columns(choice, names, path);
  EventColumns events(names);
  std::vector<double> row;
  // Tables of ropes have the rows of one cable after those of another; a curve ends with its cable.
  const bool of_cables = names.front() == "cable";
  std::string cable;
  while (true) {
    const auto next = reader.next();
    if (const auto* const fault = std::get_if<CsvFault>(&next)) fail(*fault);
    if (!std::get<bool>(next)) break;
    const auto number = [&](std::size_t column) { return csv_number(reader, column, path); };
    if (of_cables && !cable.empty() && cable != reader.cells().front().text) {
      columns.add_row(std::vector<double>(columns.needed().size(), missing_value));
    }
    if (of_cables) cable = reader.cells().front().text;
    row.clear();
    for (const int column : columns.needed())
      row.push_back(number(static_cast<std::size_t>(column)));
    columns.add_row(row);
    for (std::size_t e = 0; e < events.columns.size(); ++e) {
      const std::size_t column = events.columns[e];
      const double now = number(column);
      add_event(names[column], events.last[e], now, columns.run.values[0].back(), columns.run);
      events.last[e] = now;
    }
  }
  PlotRun run = std::move(columns.run);
  const std::vector<double>& x = run.values.front();
  run.scattered =
      is_sweep(names) && std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end();
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
  while (at + 1 < header.size() && header[at] == '(') {
    const char quote = header[at + 1];  // names with an apostrophe stand in double quotes
    const std::size_t end = header.find(quote, at + 2);
    if ((quote != '\'' && quote != '"') || end == std::string_view::npos)
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
  TableColumns columns(choice, header.names, path);
  const auto value = [&](std::size_t k, std::size_t column) {
    double number = 0.0;
    const std::size_t at = header.data + k * row + column * sizeof(double);
    std::memcpy(&number, text.data() + at, sizeof number);
    return number;
  };
  std::vector<double> cells(columns.needed().size());
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      cells[c] = value(k, static_cast<std::size_t>(columns.needed()[c]));
    }
    columns.add_row(cells);
  }
  PlotRun run = std::move(columns.run);
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
    : columns_(std::make_shared<const QuantityIndex>(simulation), Taken::along_run) {
  const QuantityIndex& index = columns_.index();
  choose_columns(choice, index.set().names(), index, "", columns_);
  sample_.resize(columns_.size());
  courses_.resize(columns_.course_count());
  values_.resize(columns_.size());
}

void PlotRecorder::observe(const Simulation& simulation) {
  const bool drawn = observed_++ % stride_ == 0;
  if (!drawn && courses_.empty()) return;
  columns_.follow(simulation, courses_, sample_);
  if (!drawn) return;
  for (std::size_t c = 0; c < sample_.size(); ++c) values_[c].push_back(sample_[c]);
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
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    run.names.push_back(columns_.text(i));
    run.units.push_back(columns_.unit(i));
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
