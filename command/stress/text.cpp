// sheave stress: maps for people, as text and as Markdown.

#include <cmath>

#include <sheave_version.h>

#include <fmt/format.h>

#include "command/stress/table.h"
#include "command/text/one_line.h"
#include "command/text/table.h"

namespace sheave::command {
namespace {

using measure::StressKind;

constexpr std::size_t commands_shown = 1;  // per map and setting

std::string count_text(int count) { return count == 0 ? "-" : fmt::format("{}", count); }

/// "1e-5", "wrong 3e+01", "diverged"; "!" is appended to a silent failure.
std::string cell_text(const StressOutcome& outcome) {
  const measure::StressVerdict& verdict = outcome.verdict;
  std::string text;
  if (verdict.kind == StressKind::right) {
    text = fmt::format("{:.0e}", verdict.error);
  } else if (verdict.kind == StressKind::wrong) {
    text = fmt::format("**{:.0e}**", verdict.error);
  } else {
    text =
        fmt::format("**{}**", measure::stress_kind_names[static_cast<std::size_t>(verdict.kind)]);
  }
  return text + (outcome.silent() ? " !" : "");
}

const std::vector<std::string> stress_head{"map",         "setting",     "cells",   "worst error",
                                           "wrong",       "diverged",    "refused", "energy gain",
                                           "false slack", "lost length", "silent"};

std::vector<std::string> summary_cells(const StressResult& result) {
  return {result.map.name,
          result.settings.name(),
          fmt::format("{}", result.outcomes.size()),
          fmt::format("{:.1e}", result.worst_error()),
          count_text(result.count(StressKind::wrong)),
          count_text(result.count(StressKind::diverged)),
          count_text(result.count(StressKind::refused)),
          count_text(result.count(StressKind::energy_gain)),
          count_text(result.count(StressKind::false_slack)),
          count_text(result.count(StressKind::lost_length)),
          count_text(result.silent())};
}

/// The worst failures with commands that reproduce them.
std::string worst_text(const StressResult& result, std::string_view bullet) {
  std::string text;
  for (const std::size_t i : result.worst(commands_shown)) {
    const measure::StressCell& cell = result.map.cells[i];
    const StressOutcome& outcome = result.outcomes[i];
    text +=
        fmt::format("{}{}, {}: {} {:.3g}, {} {:.3g}: {}{}; {}\n    {}\n", bullet, result.map.name,
                    result.settings.name(), result.map.x.name, cell.x, result.map.y.name, cell.y,
                    measure::stress_kind_names[static_cast<std::size_t>(outcome.verdict.kind)],
                    outcome.silent() ? ", without a warning" : "", outcome.verdict.detail,
                    cell.command(result.settings.solver, result.settings.integrator));
  }
  return text;
}

std::string table_row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string map_table(const StressResult& result) {
  const measure::StressMap& map = result.map;
  std::vector<std::string> head{map.y.name + " \\ " + map.x.name};
  for (const double x : map.x.values) head.push_back(fmt::format("{:.2g}", x));
  std::string text = table_row(head) + table_row(std::vector<std::string>(head.size(), "---"));
  std::size_t i = 0;
  for (const double y : map.y.values) {
    std::vector<std::string> row{fmt::format("{:.2g}", y)};
    for (std::size_t k = 0; k < map.x.values.size(); ++k) {
      row.push_back(cell_text(result.outcomes[i++]));
    }
    text += table_row(row);
  }
  return text;
}

/// The conclusions from the maps, and their limits.
std::string conclusion_text(const std::vector<StressResult>& results) {
  std::size_t cells = 0;
  int failed = 0;
  int silent = 0;
  int refused = 0;
  std::string where;
  for (const StressResult& result : results) {
    cells += result.outcomes.size();
    failed += result.failed();
    silent += result.silent();
    refused += result.count(StressKind::refused);
    if (result.failed() == 0) continue;
    where += fmt::format("{}{} with {} ({})", where.empty() ? "" : ", ", result.map.name,
                         result.settings.name(), result.failed());
  }
  std::string text =
      fmt::format("\nIn all: {} of {} runs are right", cells - failed - refused, cells);
  if (refused > 0) text += fmt::format(", {} were refused as no valid scene or start", refused);
  if (failed > 0) {
    text += fmt::format(", {} failed, {} of them silently", failed, silent);
  }
  text += failed > 0 ? ": " + where + ".\n" : ".\n";
  return text +
         "Not tried: other durations, more or fewer substeps and iterations than the scene has, "
         "settings changed one by one, other starts, damage, and whatever a scene's controllers "
         "would meet in longer runs. Where there is no closed form, a run counts as right if "
         "it neither diverges nor gains energy nor loses cable, and if similar runs agree.\n";
}

}  // namespace

std::string stress_text(const std::vector<StressResult>& results) {
  TextTable table(stress_head, 2);
  std::string worst;
  for (const StressResult& result : results) {
    table.add(summary_cells(result));
    worst += worst_text(result, "  ");
  }
  int silent = 0;
  for (const StressResult& result : results) silent += result.silent();
  const std::string count =
      fmt::format("\n{} silent: wrong, without a warning, and with a clean certificate\n", silent);
  return table.text() + count + (worst.empty() ? "" : "\nThe worst cells:\n" + worst) +
         conclusion_text(results);
}

std::string stress_markdown(const std::vector<StressResult>& results,
                            const std::function<std::string(const StressResult&)>& picture) {
  std::string text = "# Stability at the extremes\n\n";
  text += fmt::format(
      "Made by `sheave stress --markdown`, sheave {}. Errors are relative to closed forms, to the "
      "same machine in other units, or of\nrigid cables' lengths, the largest of each run; above "
      "{:g} they are bold. `!`: a failure that `sheave run` shows neither by a warning nor by its "
      "certificate.\n\n",
      version_string, measure::stress_error_limit);
  text += table_row(stress_head) + table_row(std::vector<std::string>(stress_head.size(), "---"));
  for (const StressResult& result : results) text += table_row(summary_cells(result));
  for (const StressResult& result : results) {
    text += fmt::format("\n## {}, {}\n\n{}\n\n", result.map.name, result.settings.name(),
                        result.map.meaning);
    const std::string path = picture(result);
    if (!path.empty()) text += fmt::format("![{}]({})\n\n", result.map.name, path);
    text += map_table(result);
    const std::string worst = worst_text(result, "");
    if (!worst.empty()) text += "\n" + markdown_code(worst);
  }
  return text;
}

}  // namespace sheave::command
