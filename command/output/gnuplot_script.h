#pragma once
// Scripts for gnuplot. Its language can run programs and write files, so no text from outside may
// become part of a script. Texts that a chart shows stand in a data block, which gnuplot does not
// interpret; the script refers to their lines. The types enforce this: code can be built only from
// constants of this program and from numbers.

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

namespace sheave::command {

enum class ChartFormat { png, svg, pdf };

/// The format that belongs to the ending of a chart's name. A Failure (2) if the ending is not
/// .png, .svg or .pdf.
[[nodiscard]] ChartFormat chart_format(const std::string& path);

class GnuplotCode;

/// A constant of this program, a number, or code built from such pieces. A piece only views its
/// code and must not outlive it: pieces are for the argument lists of GnuplotCode.
class GnuplotPiece {
 public:
  // consteval admits only constants.
  // NOLINTBEGIN(google-explicit-constructor): lists of pieces shall read like text.
  consteval GnuplotPiece(const char* constant) : constant_(constant) {}
  GnuplotPiece(double number);
  template <std::integral Number>
  GnuplotPiece(Number number) : GnuplotPiece(static_cast<double>(number)) {}
  GnuplotPiece(const GnuplotCode& code);
  // NOLINTEND(google-explicit-constructor)

  [[nodiscard]] std::string_view text() const {
    return length_ > 0 ? std::string_view(digits_.data(), length_) : constant_;
  }

 private:
  std::string_view constant_;
  std::array<char, 32> digits_{};
  std::size_t length_ = 0;  ///< number of digits; 0: this piece is no number
};

/// A part of a script.
class GnuplotCode {
 public:
  GnuplotCode() = default;
  GnuplotCode(std::initializer_list<GnuplotPiece> pieces) { add(pieces); }
  void add(std::initializer_list<GnuplotPiece> pieces) {
    for (const GnuplotPiece& part : pieces) text_ += part.text();
  }
  [[nodiscard]] bool empty() const { return text_.empty(); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Lines of numbers.
class ChartRows {
 public:
  void add(std::initializer_list<double> numbers);
  /// Adds a gap: gnuplot interrupts a line through the points there.
  void add_gap() { lines_.add({"\n"}); }
  [[nodiscard]] bool empty() const { return lines_.empty(); }
  [[nodiscard]] const GnuplotCode& lines() const { return lines_; }

 private:
  GnuplotCode lines_;
};

/// A complete script that writes one picture of 1000 x `height` pixels to standard output.
class GnuplotScript {
 public:
  GnuplotScript(ChartFormat format, int height) : format_(format), height_(height) {}

  /// Stores a text in the form of one_line() and returns code for it as a string.
  [[nodiscard]] GnuplotCode shown(std::string_view text);
  /// The same for the name of a tic, for the list of `set xtics (...)`. Only there gnuplot treats a
  /// text as a number format, so a percent sign must be doubled.
  [[nodiscard]] GnuplotCode tic(std::string_view text, double place);
  /// Stores a text that belongs to a point and returns its line number for the point's row.
  [[nodiscard]] double shown_number(std::string_view text);
  /// Code for the texts whose line numbers are in a column, for `using`.
  [[nodiscard]] static GnuplotCode shown_of_column(int column);
  /// Stores the rows as a data block and returns its name. `rows` must not be empty: gnuplot
  /// refuses to plot an empty block.
  [[nodiscard]] GnuplotCode block(const ChartRows& rows);
  /// Appends code. All code follows the data blocks.
  void add(std::initializer_list<GnuplotPiece> pieces) { body_.add(pieces); }

  [[nodiscard]] ChartFormat format() const { return format_; }
  [[nodiscard]] std::string text() const;

 private:
  /// Code for one line of the data block of texts, as a string.
  [[nodiscard]] static GnuplotCode string_of(double number);
  /// Appends a line to the data block of texts and returns its number.
  double add_text(std::string_view line);

  ChartFormat format_;
  int height_;
  std::string texts_;  ///< lines of the data block of texts
  int text_count_ = 0;
  GnuplotCode blocks_;
  int block_count_ = 0;
  GnuplotCode body_;
};

}  // namespace sheave::command
