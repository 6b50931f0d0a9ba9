#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sheave::command {

/// A small table for people: columns as wide as their widest cell, text on the left, numbers on the
/// right.
class TextTable {
 public:
  /// The first `text_columns` columns hold text.
  TextTable(std::vector<std::string> head, std::size_t text_columns);
  /// A row of as many cells as the head has.
  void add(std::vector<std::string> cells);
  /// Lines with line breaks; each begins with two blanks.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::size_t text_columns_;
};

/// Six digits: enough for people.
[[nodiscard]] std::string short_number(double value);

}  // namespace sheave::command
