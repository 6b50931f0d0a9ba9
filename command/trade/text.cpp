// sheave trade: the report for people, as text and as Markdown.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "command/progress.h"
#include "command/terminal.h"
#include "command/text/one_line.h"
#include "command/text/table.h"
#include "command/trade/table.h"

namespace sheave::command {
namespace {

const std::vector<std::string> trade_head{
    "setting",      "",        "ms / s",       "quartiles", "position error", "tension error",
    "energy error", "stretch", "length error", "solves / s"};

std::string milliseconds_text(double seconds) { return fmt::format("{:.3g}", 1e3 * seconds); }

std::vector<std::string> trade_cells(const TradeRow& row, const measure::RunError& doubt) {
  std::vector<std::string> cells{row.setting.name(), row.on_front ? "*" : ""};
  if (!row.measured()) {
    cells.emplace_back(row.skipped.empty() ? "failed" : "skipped");
    cells.resize(trade_head.size());
    return cells;
  }
  const auto& time = row.seconds;
  const std::vector<std::string> numbers{
      milliseconds_text(time.median),
      time.count > 1 ? milliseconds_text(time.lower) + " - " + milliseconds_text(time.upper)
                     : "one sample",
      error_text(row.error.position, doubt.position),
      error_text(row.error.tension, doubt.tension),
      error_text(row.error.energy, doubt.energy),
      fmt::format("{:.1e}", row.stretch),
      fmt::format("{:.1e}", row.length_error),
      fmt::format("{:.3g}", row.row_solves)};
  cells.insert(cells.end(), numbers.begin(), numbers.end());
  return cells;
}

std::string reference_line(const TradeTable& table) {
  const measure::Reference& reference = table.reference;
  const std::string steps = reference.tolerance > 0.0
                                ? fmt::format("within {:.3g} m", reference.tolerance)
                                : fmt::format("{} substeps", reference.substeps);
  std::string line = fmt::format("reference: direct, {}, {}; its own error {:.1e}",
                                 integrator_names[static_cast<std::size_t>(reference.integrator)],
                                 steps, reference.estimate.position);
  if (std::isfinite(reference.order)) line += fmt::format(", order {:.1f}", reference.order);
  return line;
}

/// Remarks about the time after which the reference is not valid.
std::vector<std::string> span_lines(const TradeTable& table) {
  std::vector<std::string> lines;
  if (table.compared_seconds < table.simulated_seconds) {
    lines.push_back(
        fmt::format("positions and tensions are compared for {:.4g} of {:.4g} s: until then the "
                    "reference has an error of {:.1e}, later a larger one. Energy, stretch and "
                    "length are those of the whole run",
                    table.compared_seconds, table.simulated_seconds, table.doubt.position));
  }
  if (table.compared_seconds >= table.simulated_seconds && table.doubt.position > 1e-2) {
    lines.push_back(
        fmt::format("the reference itself has an error of {:.1e}, from the first frames on: "
                    "smaller errors of settings cannot be measured",
                    table.doubt.position));
  }
  if (!table.tensions_known()) {
    lines.push_back(fmt::format(
        "the tensions of the reference have an error of {:.1e} of their mean (the tension of an "
        "impact grows as the substep shrinks): settings are chosen by positions "
        "alone",
        table.doubt.tension));
  }
  if (table.motion > 0.0 && table.motion < little_motion) {
    lines.push_back(
        fmt::format("the bodies move by no more than {:.1e} of the scene's size: relative to their "
                    "motion the errors are {:.3g} times those shown",
                    table.motion, 1.0 / table.motion));
  }
  if (table.chaos_rate) {
    lines.push_back(
        fmt::format("chaotic: differences grow by a factor of e every {:.3g} s, so later positions "
                    "have no correct value, for any step",
                    1.0 / *table.chaos_rate));
  }
  return lines;
}

std::string percent_text(double share) { return fmt::format("{:g} %", 100.0 * share); }

/// "gauss-seidel 4 x 10: 0.12 ms per frame, position error 3.0e-04, tension error 1.0e-03".
std::string choice_text(const TradeTable& table, std::size_t index) {
  const TradeRow& row = table.rows[index];
  return fmt::format("{}: {} ms per frame of {:.4g} s, {} ms per simulated second, {}",
                     row.setting.name(), milliseconds_text(row.seconds.median * table.dt), table.dt,
                     milliseconds_text(row.seconds.median), errors_text(table, row));
}

/// Answers to the most common questions, one line each.
std::vector<std::string> trade_answers(const TradeTable& table) {
  std::vector<std::string> lines;
  for (const double level : trade_levels) {
    const auto choice = answer(table, {.error = level});
    lines.push_back(fmt::format("cheapest setting for {}: {}", percent_text(level),
                                choice ? choice_text(table, *choice) : "none of these"));
  }
  return lines;
}

/// Further conclusions from the rows, one line each.
std::vector<std::string> trade_remarks(const TradeTable& table) {
  std::vector<std::string> lines;
  for (const TradeFamily& family : table.families) {
    lines.push_back(family.fit
                        ? fmt::format("order of {}: {:.2f} ({} steps)", family.name,
                                      family.fit->order, family.fit->points)
                        : fmt::format("order of {}: fewer than three steps show it", family.name));
  }
  int left = 0;
  for (const TradeRow& row : table.rows) {
    if (!row.skipped.empty()) continue;
    if (!row.measured()) {
      lines.push_back(fmt::format("{}: failed: {}", row.setting.name(), row.fault));
    } else if (row.fallbacks > 0) {
      ++left;
    }
  }
  if (left > 0) {
    lines.push_back(fmt::format(
        "{} settings left substeps to gauss-seidel or xpbd (--json has the numbers)", left));
  }
  return lines;
}

/// Settings not run for lack of time, cheapest first.
std::vector<std::string> skipped_lines(const TradeTable& table) {
  std::vector<const TradeRow*> skipped;
  double seconds = 0.0;
  for (const TradeRow& row : table.rows) {
    if (row.skipped.empty()) continue;
    skipped.push_back(&row);
    seconds += row.expected_seconds;
  }
  std::stable_sort(skipped.begin(), skipped.end(), [](const TradeRow* a, const TradeRow* b) {
    return a->expected_seconds < b->expected_seconds;
  });
  std::vector<std::string> lines = table.limits;
  if (skipped.empty()) return lines;
  std::string names;
  for (const TradeRow* row : skipped) {
    names += (names.empty() ? "" : "; ") + row->setting.name() + " (" +
             duration_text(row->expected_seconds) + ")";
  }
  lines.push_back(fmt::format(
      "{} of {} settings were skipped, for which {:g} minutes are too few (--minutes). Their runs "
      "take about {} of CPU time, cheapest first: {}",
      skipped.size(), table.rows.size(), table.most_minutes, duration_text(seconds), names));
  return lines;
}

std::string head_line(const TradeTable& table) {
  return fmt::format(
      "{}: {:.4g} s in frames of {:.4g} s; sheave {}, {}, {}{}", printable_line(table.scene),
      table.simulated_seconds, table.dt, table.version, table.machine.cpu, table.machine.compiler,
      table.machine.assertions ? "; built WITH ASSERTIONS: the times are meaningless" : "");
}

std::string trade_markdown_row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

}  // namespace

std::string trade_text(const TradeTable& table) {
  std::string result;
  for (const std::string& line : trade_answers(table)) result += line + "\n";
  result += "\n" + head_line(table) + "\n" + reference_line(table) + "\n";
  for (const std::string& line : span_lines(table)) result += line + "\n";
  TextTable text(trade_head, 2);
  for (const TradeRow& row : table.rows) text.add(trade_cells(row, table.doubt));
  result += "\n" + text.text() + "\n  * nothing is faster and at least as accurate\n\n";
  for (const std::string& line : trade_remarks(table)) result += "  " + line + "\n";
  for (const std::string& line : skipped_lines(table)) result += "  " + line + "\n";
  return result + ladder_text(table);
}

std::string trade_markdown(const TradeTable& table) {
  std::string result = fmt::format("# {}: speed against accuracy\n\n", markdown_text(table.scene));
  for (const std::string& line : trade_answers(table)) result += "* " + markdown_text(line) + "\n";
  result += "\nMade by `sheave trade --markdown`. " + markdown_text(head_line(table)) + "; " +
            reference_line(table) + ".\n\n";
  for (const std::string& line : span_lines(table)) result += "* " + markdown_text(line) + "\n";
  result += fmt::format(
      "\nms / s: CPU time per simulated second, median and quartiles of {} interleaved "
      "repetitions of the whole scene; one sample for "
      "settings that are twice as slow as one that is as accurate.\nPosition error: largest of all "
      "frames, root mean square "
      "over the bodies, relative to the scene's size; tension and\nenergy error: "
      "measure/run_error.h. Setting: solver, substeps (x iterations). *: nothing is faster and at "
      "least as accurate.\n\n",
      table.repetitions);
  result += trade_markdown_row(trade_head);
  result += trade_markdown_row(std::vector<std::string>(trade_head.size(), "---"));
  for (const TradeRow& row : table.rows) {
    result += trade_markdown_row(trade_cells(row, table.doubt));
  }
  result += "\n";
  for (const std::string& line : trade_remarks(table)) result += "* " + markdown_text(line) + "\n";
  for (const std::string& line : skipped_lines(table)) result += "* " + markdown_text(line) + "\n";
  return result + ladder_markdown(table);
}

}  // namespace sheave::command
