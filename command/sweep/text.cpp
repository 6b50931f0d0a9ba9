// sheave sweep: the results as text, CSV and JSON.

#include <algorithm>
#include <array>
#include <cmath>

#include <sheave_version.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/sweep/chart_axis.h"
#include "command/sweep/rows_json.h"
#include "command/sweep/table.h"
#include "command/terminal.h"
#include "command/text/table.h"
#include "engine/field_check.h"

namespace sheave::command {
namespace {

using Json = nlohmann::ordered_json;

/// Longer tables are left to files.
constexpr std::size_t most_shown = 40;

/// "load = 200, parts = 4".
std::string values_text(const SweepHead& head, const SweepRow& row) {
  std::string text;
  for (std::size_t a = 0; a < head.axes.size(); ++a) {
    text += fmt::format("{}{} = {}", a > 0 ? ", " : "", printable_line(head.axes[a]),
                        printable_line(row.values[a]));
  }
  return text;
}

/// "done 990, diverged 10".
std::string statuses_text(const SweepTable& table) {
  std::array<std::size_t, sweep_status_names.size()> counts{};
  for (const SweepRow& row : table.rows) ++counts[static_cast<std::size_t>(row.status)];
  std::string text;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[s], sweep_status_names[s]);
  }
  return text;
}

std::string extremes_text(const SweepTable& table, std::size_t m) {
  const SweepRow* least = nullptr;
  const SweepRow* most = nullptr;
  for (const SweepRow& row : table.rows) {
    const double value = row.measured[m];
    if (!std::isfinite(value)) continue;
    if (least == nullptr || value < least->measured[m]) least = &row;
    if (most == nullptr || value > most->measured[m]) most = &row;
  }
  const ShownMeasure shown(table, m);
  if (least == nullptr) {
    return fmt::format("{}: measured in no run\n", printable_line(table.head.measures[m].name));
  }
  const std::string label = printable_line(shown.label);
  const auto part = [&](const char* word, const SweepRow& row) {
    return fmt::format("  {} {} at {}\n", word, short_number(row.measured[m] / shown.scale.factor),
                       values_text(table.head, row));
  };
  if (least->measured[m] == most->measured[m]) {
    return fmt::format("{}: {} in all runs\n", label,
                       short_number(least->measured[m] / shown.scale.factor));
  }
  return label + "\n" + part("least", *least) + part("most ", *most);
}

std::string rows_text(const SweepTable& table) {
  std::vector<std::string> names{"run"};
  std::vector<ChartAxis> axes;
  for (std::size_t a = 0; a < table.head.axes.size(); ++a) {
    names.push_back(printable_line(axes.emplace_back(table, a).label));
  }
  std::vector<ShownMeasure> measures;
  for (std::size_t m = 0; m < table.head.measures.size(); ++m) {
    names.push_back(printable_line(measures.emplace_back(table, m).label));
  }
  names.emplace_back("status");
  const bool certified = table.head.kind == SweepKind::run;
  if (certified) names.emplace_back("certificate");
  TextTable text(names, 0);
  for (const SweepRow& row : table.rows) {
    std::vector<std::string> cells{fmt::format("{}", row.run)};
    for (std::size_t a = 0; a < axes.size(); ++a) {
      // Without a prefix a value stays as it was given.
      const bool scaled = axes[a].numeric && axes[a].scale.factor != 1.0;
      cells.push_back(scaled ? axes[a].shown(row.values[a]) : row.values[a]);
    }
    for (std::size_t m = 0; m < measures.size(); ++m) {
      const double value = row.measured[m];
      cells.push_back(std::isfinite(value) ? short_number(value / measures[m].scale.factor) : "-");
    }
    cells.emplace_back(sweep_status_names[static_cast<std::size_t>(row.status)]);
    if (certified) {
      cells.push_back(std::isfinite(row.doubt) ? fmt::format("{:.1e}", row.doubt) : "-");
    }
    text.add(std::move(cells));
  }
  return text.text();
}

/// Messages of runs that are not done; if there are many, the first few.
std::string faults_text(const SweepTable& table) {
  constexpr std::size_t most_told = 5;
  std::string text;
  std::size_t told = 0;
  std::size_t all = 0;
  for (const SweepRow& row : table.rows) {
    if (row.message.empty()) continue;
    ++all;
    if (told == most_told) continue;
    ++told;
    text += fmt::format("  run {} ({}): {}\n", row.run, values_text(table.head, row),
                        printable_line(row.message));
  }
  if (all > told) text += fmt::format("  ... and {} more; --csv and --json list all\n", all - told);
  return text.empty() ? "" : "\n" + text;
}

/// As CSV has it (RFC 4180).
/// Quoted where a table needs it; a terminal may be shown it, too.
std::string csv_cell(const std::string& from) {
  const std::string text = printable(from);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string number_cell(double value) { return std::isfinite(value) ? number_text(value) : ""; }

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// A value of an axis as its JSON value; a bare word becomes a string.
Json axis_value(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_discarded() ? Json(text) : value;
}

}  // namespace

std::string sweep_text(const SweepTable& table) {
  const SweepHead& head = table.head;
  const std::string rows =
      head.kind == SweepKind::run ? "runs" : fmt::format("searches of {}", name_of(head.kind));
  std::string text = fmt::format("{}: {} {}: {}\n", printable_line(head.scene), table.rows.size(),
                                 rows, statuses_text(table));
  if (head.shard.count > 1) {
    text += fmt::format("part {} of {}; `sheave merge` merges the journals\n", head.shard.index,
                        head.shard.count);
  }
  text += "\n";
  for (std::size_t m = 0; m < head.measures.size(); ++m) text += extremes_text(table, m);
  if (table.rows.size() <= most_shown) {
    text += "\n" + rows_text(table);
  }
  return text + faults_text(table);
}

std::string sweep_csv(const SweepTable& table) {
  std::string text = "run";
  for (const std::string& axis : table.head.axes) text += "," + csv_cell(axis);
  for (const SweepMeasure& measure : table.head.measures) text += "," + csv_cell(measure.name);
  text += ",status,end,certificate,certificate_item,message\n";
  for (const SweepRow& row : table.rows) {
    text += fmt::format("{}", row.run);
    for (const std::string& value : row.values) text += "," + csv_cell(value);
    for (const double value : row.measured) text += "," + number_cell(value);
    text +=
        fmt::format(",{},{},{},{},{}\n", sweep_status_names[static_cast<std::size_t>(row.status)],
                    number_cell(row.end), number_cell(row.doubt), csv_cell(row.doubt_of),
                    csv_cell(row.message));
  }
  return text;
}

nlohmann::ordered_json sweep_rows_json(const SweepTable& table) {
  const SweepHead& head = table.head;
  Json rows = Json::array();
  for (const SweepRow& row : table.rows) {
    Json values = Json::object();
    for (std::size_t a = 0; a < head.axes.size(); ++a) {
      values[head.axes[a]] = axis_value(row.values[a]);
    }
    Json measured = Json::object();
    for (std::size_t m = 0; m < head.measures.size(); ++m) {
      measured[head.measures[m].name] = number_or_null(row.measured[m]);
    }
    rows.push_back({{"run", row.run},
                    {"values", std::move(values)},
                    {"measured", std::move(measured)},
                    {"status", sweep_status_names[static_cast<std::size_t>(row.status)]},
                    {"end", row.end},
                    {"certificate", number_or_null(row.doubt)},
                    {"certificate_item", row.doubt_of},
                    {"message", row.message}});
  }
  return rows;
}

std::string sweep_json(const SweepTable& table) {
  const SweepHead& head = table.head;
  Json measures = Json::array();
  for (const SweepMeasure& measure : head.measures) {
    measures.push_back({{"name", measure.name}, {"unit", measure.unit}});
  }
  const Json json{{"version", version_string},
                  {"scene", head.scene},
                  {"of", name_of(head.kind)},
                  {"runs", head.runs},
                  {"shard", {head.shard.index, head.shard.count}},
                  {"varied", head.axes},
                  {"measures", std::move(measures)},
                  {"rows", sweep_rows_json(table)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sheave::command
