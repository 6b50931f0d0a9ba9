// sheave sweep: the measures of a run.

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/sweep/table.h"

namespace sheave::command {
namespace {

[[noreturn]] void bad_measure(const std::string& text, const std::string& what) {
  throw Failure(ExitCode::usage,
                fmt::format("--measure {}: {}; for example --measure max:rope.0.tension, "
                            "--measure mean:load.vy@2:5, --measure load.y",
                            text, what));
}

Statistic statistic_of(const std::string& text, std::string_view word) {
  if (word == "min") return Statistic::minimum;
  if (word == "max") return Statistic::maximum;
  std::string names = "min, max";
  for (std::size_t i = 0; i < statistic_names.size(); ++i) {
    if (word == statistic_names[i]) return static_cast<Statistic>(i);
    names += ", " + std::string(statistic_names[i]);
  }
  bad_measure(text, fmt::format("\"{}\" is no statistic; allowed: {}", word, names));
}

double time_of(const std::string& text, std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !(value >= 0.0) ||
      !std::isfinite(value)) {
    bad_measure(text, fmt::format("\"{}\" is no time in s, from 0 on", word));
  }
  return value;
}

}  // namespace

SweepMeasure parse_measure(const std::string& text) {
  SweepMeasure measure{text, {}, {}};
  CheckDef& course = measure.course;
  course.tolerance = std::numeric_limits<double>::max();
  std::string_view rest = text;
  std::string_view when;
  if (const std::size_t at = rest.find('@'); at != std::string_view::npos) {
    when = rest.substr(at + 1);
    rest = rest.substr(0, at);
    if (when.empty()) bad_measure(text, "the time after @ is missing");
  }
  if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
    course.statistic = statistic_of(text, rest.substr(0, colon));
    rest = rest.substr(colon + 1);
  }
  if (rest.empty()) bad_measure(text, "the quantity is missing");
  course.quantity = rest;
  if (when.empty()) return measure;
  const std::size_t colon = when.find(':');
  const bool moment = course.statistic == Statistic::at;
  if (moment != (colon == std::string_view::npos)) {
    bad_measure(text, moment ? "the value at a moment is taken @TIME"
                             : "this statistic is taken in a window, @FROM:TO");
  }
  if (moment) {
    course.at = time_of(text, when);
    return measure;
  }
  course.from = time_of(text, when.substr(0, colon));
  course.to = time_of(text, when.substr(colon + 1));
  if (!(*course.from < *course.to)) bad_measure(text, "the window must end after it begins");
  return measure;
}

}  // namespace sheave::command
