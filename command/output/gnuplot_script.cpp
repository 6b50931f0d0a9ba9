#include "command/output/gnuplot_script.h"

#include <cmath>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/text/one_line.h"

namespace sheave::command {
ChartFormat chart_format(const std::string& path) {
  if (path.ends_with(".png")) return ChartFormat::png;
  if (path.ends_with(".svg")) return ChartFormat::svg;
  if (path.ends_with(".pdf")) return ChartFormat::pdf;
  throw Failure(ExitCode::usage, path + ": the name of a chart must end in .png, .svg or .pdf");
}

GnuplotPiece::GnuplotPiece(double number) {
  const std::string_view name = std::isfinite(number) ? "" : "NaN";
  const auto end = name.empty()
                       ? fmt::format_to_n(digits_.data(), digits_.size(), "{:.12g}", number)
                       : fmt::format_to_n(digits_.data(), digits_.size(), "{}", name);
  length_ = end.size;  // at most 19
}

GnuplotPiece::GnuplotPiece(const GnuplotCode& code) : constant_(code.text()) {}

void ChartRows::add(std::initializer_list<double> numbers) {
  for (const double number : numbers) lines_.add({number, " "});
  lines_.add({"\n"});
}

GnuplotCode GnuplotScript::string_of(double number) {
  return {"substr($texts[", number, "],2,9999)"};
}

double GnuplotScript::add_text(std::string_view line) {
  texts_ += '|';
  texts_ += line;
  texts_ += '\n';
  return ++text_count_;
}

GnuplotCode GnuplotScript::shown(std::string_view text) { return string_of(shown_number(text)); }

double GnuplotScript::shown_number(std::string_view text) { return add_text(one_line(text)); }

GnuplotCode GnuplotScript::tic(std::string_view text, double place) {
  std::string format;
  for (const char c : one_line(text)) format += c == '%' ? "%%" : std::string(1, c);
  return {string_of(add_text(format)), " ", place};
}

GnuplotCode GnuplotScript::shown_of_column(int column) {
  return {"(substr($texts[int($", column, ")],2,9999))"};
}

GnuplotCode GnuplotScript::block(const ChartRows& rows) {
  GnuplotCode name{"$data", ++block_count_};
  // A line of numbers begins with a digit, a sign or NaN, a line of texts with a bar, so no line
  // can end a block.
  blocks_.add({name, " << end\n", rows.lines()});
  if (rows.empty()) blocks_.add({"NaN NaN NaN NaN\n"});
  blocks_.add({"end\n"});
  return name;
}

std::string GnuplotScript::text() const {
  constexpr double pixels_per_inch = 100.0;
  GnuplotCode head{"set encoding utf8\nset terminal "};
  switch (format_) {
    case ChartFormat::png:
      head.add({"pngcairo noenhanced size 1000,", height_, " font 'DejaVu Sans,11'\n"});
      break;
    case ChartFormat::svg:
      head.add(
          {"svg noenhanced size 1000,", height_, " font 'DejaVu Sans,13' background 'white'\n"});
      break;
    case ChartFormat::pdf:
      head.add({"pdfcairo noenhanced size 10in,", height_ / pixels_per_inch,
                "in font 'DejaVu Sans,11'\n"});
      break;
  }
  const std::string texts = text_count_ > 0 ? "$texts << end\n" + texts_ + "end\n" : "";
  return head.text() + texts + blocks_.text() + body_.text();
}

}  // namespace sheave::command
