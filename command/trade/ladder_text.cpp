// sheave trade: the text of the model ladder.

#include <cmath>

#include <fmt/format.h>

#include "command/text/one_line.h"
#include "command/text/table.h"
#include "command/trade/table.h"

namespace sheave::command {
namespace {

const std::vector<std::string> ladder_head{
    "change of the model", "changed",    "position",    "tension", "ms / s",
    "quartiles",           "time saved", "solves saved"};

/// Both runs have the same setting, so there is no reference error to account for. Only rounding
/// must be recognised.
std::string difference_text(double difference) { return error_text(difference, 0.0); }

/// "12 %", "-340 %": the saving relative to `before`. Empty if `before` is 0.
std::string saved_text(double now, double before) {
  if (!(before > 0.0)) return "-";
  return fmt::format("{:.0f} %", 100.0 * (1.0 - now / before) + 0.0);
}

std::vector<std::string> ladder_cells(const TradeLadder& ladder, const LadderRow& row) {
  std::vector<std::string> cells{row.name, fmt::format("{}: {}", row.things, row.changed)};
  if (!row.fault.empty()) {
    cells.emplace_back("not possible");
    cells.resize(ladder_head.size());
    return cells;
  }
  const measure::Spread& time = row.seconds;
  cells.push_back(difference_text(row.difference.position));
  cells.push_back(difference_text(row.difference.tension));
  cells.push_back(fmt::format("{:.3g}", 1e3 * time.median));
  cells.push_back(fmt::format("{:.3g} - {:.3g}", 1e3 * time.lower, 1e3 * time.upper));
  cells.push_back(saved_text(time.median, ladder.seconds.median));
  cells.push_back(saved_text(row.row_solves, ladder.row_solves));
  return cells;
}

std::vector<std::string> written_cells(const TradeLadder& ladder) {
  const measure::Spread& time = ladder.seconds;
  return {"as written",
          "",
          "",
          "",
          fmt::format("{:.3g}", 1e3 * time.median),
          fmt::format("{:.3g} - {:.3g}", 1e3 * time.lower, 1e3 * time.upper),
          "",
          ""};
}

std::string explanation(const TradeTable& table) {
  const TradeLadder& ladder = *table.ladder;
  return fmt::format(
      "{}, whose own position error is below {:.1e}; position and tension: how far the run is from "
      "that of the scene as written with the same setting, in the first {:.4g} s",
      ladder.setting.name(), ladder.setting_error, table.compared_seconds);
}

/// Remarks without a place in the table.
std::vector<std::string> ladder_remarks(const TradeLadder& ladder) {
  std::vector<std::string> lines;
  for (const LadderRow& row : ladder.rows) {
    if (!row.fault.empty()) lines.push_back(fmt::format("{}: {}", row.name, row.fault));
  }
  if (!ladder.absent.empty()) {
    lines.push_back(
        fmt::format("nothing to change in this scene: {}", fmt::join(ladder.absent, ", ")));
  }
  return lines;
}

std::string ladder_row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

}  // namespace

std::string ladder_text(const TradeTable& table) {
  if (!table.ladder) return {};
  const TradeLadder& ladder = *table.ladder;
  if (!ladder.skipped.empty()) return "\n  model ladder: " + ladder.skipped + "\n";
  std::string result = "\n  model ladder: " + explanation(table) + "\n\n";
  TextTable text(ladder_head, 2);
  text.add(written_cells(ladder));
  for (const LadderRow& row : ladder.rows) text.add(ladder_cells(ladder, row));
  result += text.text() + "\n";
  for (const std::string& line : ladder_remarks(ladder)) result += "  " + line + "\n";
  return result;
}

std::string ladder_markdown(const TradeTable& table) {
  if (!table.ladder) return {};
  const TradeLadder& ladder = *table.ladder;
  std::string result = "\n## Model ladder\n\n";
  if (!ladder.skipped.empty()) return result + markdown_text(ladder.skipped) + "\n";
  result += "Setting: " + explanation(table) + ".\n\n";
  result +=
      ladder_row(ladder_head) + ladder_row(std::vector<std::string>(ladder_head.size(), "---"));
  result += ladder_row(written_cells(ladder));
  for (const LadderRow& row : ladder.rows) result += ladder_row(ladder_cells(ladder, row));
  result += "\n";
  for (const std::string& line : ladder_remarks(ladder))
    result += "* " + markdown_text(line) + "\n";
  return result;
}

}  // namespace sheave::command
