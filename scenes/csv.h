#pragma once
// Tables of comma-separated values: load cases, loads over time, tables to plot.
//
// Cells are separated by commas, and numbers have decimal points. Quotes surround a cell with
// commas; a quote in it is doubled. A byte order mark, empty lines and line ends of Windows are
// allowed. Everything else is a fault with its row and column.

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sheave {

/// A fault in a table.
struct CsvFault {
  std::size_t line = 1;    ///< from 1
  std::size_t column = 1;  ///< from 1, in characters
  std::string message;     ///< the fault and the remedy

  /// "file:3:5: message"
  [[nodiscard]] std::string text(std::string_view file) const;
};

struct CsvCell {
  std::string text;
  std::size_t column = 1;  ///< of its first character in the line
  bool quoted = false;     ///< has quotes
};

/// Reads a table line by line.
class CsvReader {
 public:
  /// `text` must outlive the reader.
  explicit CsvReader(std::string_view text);

  /// The names in the first line; each column has one, which may be empty in quotes. Their cells are
  /// those of cells().
  [[nodiscard]] std::variant<std::vector<std::string>, CsvFault> names();
  /// The next row that is not empty, with as many cells as there are names, or a fault; false at
  /// the end.
  [[nodiscard]] std::variant<bool, CsvFault> next();

  [[nodiscard]] const std::vector<CsvCell>& cells() const { return cells_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  /// A fault of cell `index` of the present line.
  [[nodiscard]] CsvFault fault(std::size_t index, std::string message) const;
  /// The number in cell `index` of the present line; an empty cell is a fault, too.
  [[nodiscard]] std::variant<double, CsvFault> number(std::size_t index) const;

 private:
  [[nodiscard]] bool take_line();
  [[nodiscard]] bool has_open_quote() const;

  std::string_view rest_;
  std::string_view row_;
  std::size_t line_ = 0;
  std::vector<std::string> names_;
  std::vector<CsvCell> cells_;
};

/// Whether a text is a number with a decimal comma, "1,5".
[[nodiscard]] bool has_decimal_comma(std::string_view text);

}  // namespace sheave
