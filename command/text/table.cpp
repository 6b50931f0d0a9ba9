#include "command/text/table.h"

#include <algorithm>

#include <fmt/format.h>

#include "command/terminal.h"

namespace sheave::command {

TextTable::TextTable(std::vector<std::string> head, std::size_t text_columns)
    : text_columns_(text_columns) {
  add(std::move(head));
}

void TextTable::add(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = printable_line(cell);
  rows_.push_back(std::move(cells));
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool left = i < text_columns_;
      line += left ? fmt::format("  {:<{}}", row[i], widths[i])
                   : fmt::format("  {:>{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string short_number(double value) {
  // Prints -0 as 0.
  return fmt::format("{:.6g}", value == 0.0 ? 0.0 : value);
}

}  // namespace sheave::command
