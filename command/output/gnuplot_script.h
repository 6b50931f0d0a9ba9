#pragma once
// Scripts for gnuplot, whose language can run programs and write files. No text from outside is
// ever a part of one: texts that a chart shows stand in a data block, which gnuplot does not
// interpret, and the script names their places in it. The types leave no other way: code is made of
// constants of this program and of numbers.

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

namespace sheave::command {

enum class ChartFormat { png, svg, pdf };

/// By the ending of a chart's name. A Failure (2) if that is none of .png, .svg, .pdf.
[[nodiscard]] ChartFormat chart_format(const std::string& path);

class GnuplotCode;

/// A constant of this program, a number, or code that was made of such. Views of code must not
/// outlive it: pieces are for the argument lists of GnuplotCode.
class GnuplotPiece {
 public:
  // Evaluated by the compiler, so that nothing but a constant can be given.
  // NOLINTBEGIN(google-explicit-constructor): lists of pieces are to read like text.
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
  std::size_t length_ = 0;  ///< of the digits; 0: it is no number
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
  /// Breaks a line that is drawn through the points.
  void add_gap() { lines_.add({"\n"}); }
  [[nodiscard]] bool empty() const { return lines_.empty(); }
  [[nodiscard]] const GnuplotCode& lines() const { return lines_; }

 private:
  GnuplotCode lines_;
};

/// A whole script, which writes one picture of 1000 x `height` pixels to standard output.
class GnuplotScript {
 public:
  GnuplotScript(ChartFormat format, int height) : format_(format), height_(height) {}

  /// A text to be shown, as one_line() has it: code for it as a string.
  [[nodiscard]] GnuplotCode shown(std::string_view text);
  /// The same as the name of a place on an axis, for the list of `set xtics (...)`. There, and only
  /// there, gnuplot takes a text for a format of numbers, in which a percent sign is written twice.
  [[nodiscard]] GnuplotCode tic(std::string_view text, double place);
  /// A text that belongs to a point: a number for its row, ...
  [[nodiscard]] double shown_number(std::string_view text);
  /// ... and code for the texts whose numbers are in a column, as `using` takes it.
  [[nodiscard]] static GnuplotCode shown_of_column(int column);
  /// The name of a new data block with these rows. Never without a row: gnuplot refuses to plot
  /// nothing.
  [[nodiscard]] GnuplotCode block(const ChartRows& rows);
  /// Appends code, which comes behind all blocks.
  void add(std::initializer_list<GnuplotPiece> pieces) { body_.add(pieces); }

  [[nodiscard]] ChartFormat format() const { return format_; }
  [[nodiscard]] std::string text() const;

 private:
  /// Code for a line of the data block of texts as a string.
  [[nodiscard]] static GnuplotCode string_of(double number);
  /// The number of a new line there.
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
