// sheave sweep: the measures of a row.

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/sweep/table.h"

namespace sheave::command {
namespace {

/// A measure as the user wrote it, and its option, for messages.
struct MeasureText {
  const std::string& text;
  const std::string& option;

  [[noreturn]] void refuse(const std::string& what,
                           std::initializer_list<std::string_view> examples) const {
    std::string all;
    for (const std::string_view example : examples) {
      all += fmt::format("{}{} {}", all.empty() ? "" : ", ", option, example);
    }
    throw Failure(ExitCode::usage,
                  fmt::format("{} {}: {}; for example {}", option, text, what, all));
  }
  [[noreturn]] void refuse(const std::string& what) const {
    refuse(what, {"max:rope.0.tension", "mean:load.vy@2:5", "load.y"});
  }
};

bool is_of_modes(std::string_view word) { return word == "frequency" || word == "damping"; }

Statistic statistic_of(const MeasureText& from, std::string_view word) {
  if (word == "min") return Statistic::minimum;
  if (word == "max") return Statistic::maximum;
  std::string names = "min, max";
  for (std::size_t i = 0; i < statistic_names.size(); ++i) {
    if (word == statistic_names[i]) return static_cast<Statistic>(i);
    names += ", " + std::string(statistic_names[i]);
  }
  if (is_of_modes(word) || word == "eigenvalue") {
    from.refuse(fmt::format("\"{}\" is a measure of {}, not of a run", word,
                            word == "eigenvalue" ? "--of statics and --of modes" : "--of modes"));
  }
  from.refuse(fmt::format("\"{}\" is no statistic; allowed: {}", word, names));
}

double time_of(const MeasureText& from, std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !(value >= 0.0) ||
      !std::isfinite(value)) {
    from.refuse(fmt::format("\"{}\" is no time in s, from 0 on", word));
  }
  return value;
}

/// Reads "N" of "frequency:N".
std::size_t mode_number(const MeasureText& from, std::string_view word) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size() || number < 1 ||
      number > most_measured_mode) {
    from.refuse(
        fmt::format("\"{}\" is no number of a mode, from 1 to {}", word, most_measured_mode),
        {"frequency:1"});
  }
  return number;
}

[[noreturn]] void refuse_at_rest(const MeasureText& from, SweepKind kind, const std::string& what) {
  const bool modes = kind == SweepKind::modes;
  const std::string all = fmt::format(
      "{}; allowed with --of {}: QUANTITY, max:CABLE.tension, eigenvalue:N, "
      "unstable_motions, neutral_motions{}",
      what, name_of(kind), modes ? ", frequency:N, damping:N" : "");
  from.refuse(all, {"rope.0.tension", modes ? "frequency:1" : "eigenvalue:1"});
}

/// Reads a measure of a machine at rest.
void read_rest_measure(const MeasureText& from, SweepKind kind, SweepMeasure& measure) {
  const std::string_view text = from.text;
  if (text.find('@') != std::string_view::npos) {
    refuse_at_rest(from, kind, "a machine at rest has no times");
  }
  if (text == "unstable_motions" || text == "neutral_motions") {
    measure.figure =
        text == "unstable_motions" ? RestFigure::unstable_motions : RestFigure::neutral_motions;
    return;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    if (text.empty()) refuse_at_rest(from, kind, "the quantity is missing");
    measure.course.quantity = text;
    return;
  }
  const std::string_view word = text.substr(0, colon);
  const std::string_view rest = text.substr(colon + 1);
  constexpr std::string_view ending = ".tension";
  if (word == "max" && rest.ends_with(ending) && rest.size() > ending.size()) {
    measure.figure = RestFigure::largest_tension;
    measure.unit = "N";
    measure.course.quantity = rest.substr(0, rest.size() - ending.size());
  } else if (word == "eigenvalue") {
    measure.figure = RestFigure::eigenvalue;
    measure.unit = "1/s2";
    measure.number = mode_number(from, rest);
  } else if (is_of_modes(word) && kind == SweepKind::modes) {
    measure.figure = word == "frequency" ? RestFigure::frequency : RestFigure::damping;
    measure.unit = word == "frequency" ? "Hz" : "";
    measure.number = mode_number(from, rest);
  } else if (is_of_modes(word)) {
    refuse_at_rest(from, kind, fmt::format("\"{}\" is a measure of --of modes", word));
  } else {
    refuse_at_rest(
        from, kind,
        fmt::format("\"{}\" is a statistic over time, or unknown; at rest a quantity has "
                    "one value",
                    word));
  }
}

}  // namespace

SweepMeasure parse_measure(const std::string& text, SweepKind kind, const std::string& option) {
  SweepMeasure measure{text, {}, {}, RestFigure::quantity, 0, option};
  const MeasureText from{text, option};
  CheckDef& course = measure.course;
  course.tolerance = std::numeric_limits<double>::max();
  if (kind != SweepKind::run) {
    read_rest_measure(from, kind, measure);
    return measure;
  }
  // A statistic of the whole is one word; within the expression it is part of it.
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_-";
  std::string_view rest = text;
  std::string_view when;
  if (const std::size_t at = rest.find('@'); at != std::string_view::npos) {
    when = rest.substr(at + 1);
    rest = rest.substr(0, at);
    if (when.empty()) from.refuse("the time after @ is missing");
  }
  if (const std::size_t colon = rest.find_first_not_of(letters);
      colon != std::string_view::npos && rest[colon] == ':') {
    course.statistic = statistic_of(from, rest.substr(0, colon));
    rest = rest.substr(colon + 1);
  }
  if (rest.empty()) from.refuse("the quantity is missing");
  course.quantity = rest;
  if (when.empty()) return measure;
  const std::size_t colon = when.find(':');
  const bool moment = course.statistic == Statistic::at;
  if (moment != (colon == std::string_view::npos)) {
    from.refuse(moment ? "the value at a moment is taken @TIME"
                       : "this statistic is taken in a window, @FROM:TO");
  }
  if (moment) {
    course.at = time_of(from, when);
    return measure;
  }
  course.from = time_of(from, when.substr(0, colon));
  course.to = time_of(from, when.substr(colon + 1));
  if (!(*course.from < *course.to)) from.refuse("the window must end after it begins");
  return measure;
}

}  // namespace sheave::command
