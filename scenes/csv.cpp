#include "scenes/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace sheave {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";  // of spreadsheet programs

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view spaces = " \t\r";
  const std::size_t begin = text.find_first_not_of(spaces);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(spaces) + 1 - begin);
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

std::vector<CsvCell> cells_of(std::string_view line) {
  std::vector<CsvCell> cells(1);
  bool quoted = false;
  std::size_t column = 1;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back().text += '"';
      ++i;
      ++column;
    } else if (c == '"') {
      quoted = !quoted;
      cells.back().quoted = true;
    } else if (c == ',' && !quoted) {
      cells.push_back({{}, column + 1, false});
    } else if (c != '\r') {
      cells.back().text += c;
    }
    if ((static_cast<unsigned char>(c) & 0xc0U) != 0x80U) ++column;
  }
  return cells;
}

}  // namespace

std::string CsvFault::text(std::string_view file) const {
  return fmt::format("{}:{}:{}: {}", file, line, column, message);
}

bool has_decimal_comma(std::string_view text) {
  text = trimmed(text);
  if (std::count(text.begin(), text.end(), ',') != 1) return false;
  std::string point(text);
  point[point.find(',')] = '.';
  return number_of(point).has_value();
}

CsvReader::CsvReader(std::string_view text) : rest_(text) {
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool CsvReader::take_line() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    row_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (trimmed(row_).empty()) continue;
    cells_ = cells_of(row_);
    return true;
  }
  return false;
}

bool CsvReader::has_open_quote() const {
  return std::count(row_.begin(), row_.end(), '"') % 2 != 0;
}

CsvFault CsvReader::fault(std::size_t index, std::string message) const {
  return {std::max<std::size_t>(line_, 1), cells_.empty() ? 1 : cells_[index].column,
          std::move(message)};
}

std::variant<std::vector<std::string>, CsvFault> CsvReader::names() {
  if (!take_line()) return CsvFault{1, 1, "there is no line of names"};
  if (has_open_quote()) {
    return fault(0, "a quote has no end; a cell must not contain a line break");
  }
  const bool alone = cells_.size() == 1;
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}}) {
    if (!alone || row_.find(separator) == std::string_view::npos) continue;
    return fault(0, fmt::format("the cells must be separated by commas, not by {}, and numbers "
                                "need decimal points; export the table so, or replace both in an "
                                "editor",
                                name));
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].text = trimmed(cells_[i].text);
    const bool has_name = !cells_[i].text.empty() || cells_[i].quoted;
    if (!has_name) return fault(i, fmt::format("column {} has no name", i + 1));
    names_.push_back(cells_[i].text);
  }
  return names_;
}

std::variant<bool, CsvFault> CsvReader::next() {
  if (!take_line()) return false;
  if (has_open_quote()) {
    return fault(0, "a quote has no end; a cell must not contain a line break");
  }
  if (cells_.size() == names_.size()) return true;
  const bool more = cells_.size() > names_.size();
  std::string message =
      fmt::format("{} cells where the first line has {} names", cells_.size(), names_.size());
  if (more) message += "; a comma separates cells, so decimals need a point, as in 1.5";
  return fault(more ? names_.size() : 0, std::move(message));
}

std::variant<double, CsvFault> CsvReader::number(std::size_t index) const {
  const std::string_view text = trimmed(cells_[index].text);
  const std::optional<double> value = number_of(text);
  if (value && std::isfinite(*value)) return *value;
  const std::string column = fmt::format("column \"{}\": ", names_[index]);
  if (text.empty()) return fault(index, column + "the number is missing");
  if (has_decimal_comma(text)) {
    std::string point(text);
    point[point.find(',')] = '.';
    return fault(index, fmt::format("{}\"{}\" is no number; decimals need a point: {}", column,
                                    text, point));
  }
  return fault(index, fmt::format("{}\"{}\" is no {}number", column, text, value ? "finite " : ""));
}

}  // namespace sheave
