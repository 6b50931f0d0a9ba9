#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sheave::command {

/// A small text table: each column is as wide as its widest cell. Text is aligned left, numbers
/// right.
class TextTable {
 public:
  /// The first `text_columns` columns hold text.
  TextTable(std::vector<std::string> head, std::size_t text_columns);
  /// Adds a row, which must have as many cells as the head.
  void add(std::vector<std::string> cells);
  /// The lines with line breaks; each begins with two blanks.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::size_t text_columns_;
};

/// Six significant digits.
[[nodiscard]] std::string short_number(double value);

}  // namespace sheave::command
