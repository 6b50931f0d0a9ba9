// sheave tune: goals and bounds.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/tune/tune.h"

namespace sheave::command {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// Splits "MEASURE SIGN VALUE" at the last sign of `signs`; returns the sign.
char split_relation(const std::string& text, const std::string& option, const char* signs,
                    const std::string& form, std::string& measure, double& value) {
  const auto fail = [&](const std::string& what) {
    throw Failure(ExitCode::usage,
                  fmt::format("{} '{}': {}; must be {}", option, text, what, form));
  };
  const std::size_t at = text.find_last_of(signs);
  if (at == std::string::npos) fail("a measure and a number must be compared");
  std::string_view right = std::string_view(text).substr(at + 1);
  if (right.starts_with('=')) right.remove_prefix(1);
  right = trimmed(right);
  if (right.starts_with('+')) right.remove_prefix(1);
  const auto [end, error] = std::from_chars(right.data(), right.data() + right.size(), value);
  if (error != std::errc{} || end != right.data() + right.size() || !std::isfinite(value)) {
    fail(fmt::format("\"{}\" is no number", right));
  }
  measure = trimmed(std::string_view(text).substr(0, at));
  if (measure.empty()) fail("the measure is missing");
  return text[at];
}

}  // namespace

double TuneGoal::cost(double value) const {
  switch (sense) {
    case Sense::minimise:
      return value;
    case Sense::maximise:
      return -value;
    case Sense::target:
      break;
  }
  return std::abs(value - target);
}

TuneBound parse_bound(const std::string& text, SweepKind kind, SweepMeasure& measure) {
  TuneBound bound;
  std::string name;
  bound.above = split_relation(text, "--keep", "<>",
                               "'MEASURE < VALUE' or 'MEASURE > VALUE', for example --keep "
                               "'max:rope.0.tension < 5e3'",
                               name, bound.limit) == '>';
  measure = parse_measure(name, kind, "--keep");
  return bound;
}

TuneGoal parse_target(const std::string& text, SweepKind kind, SweepMeasure& measure) {
  TuneGoal goal{TuneGoal::Sense::target, 0.0};
  std::string name;
  split_relation(text, "--target", "=",
                 "'MEASURE = VALUE', for example --target 'frequency:1 = 2.5'", name, goal.target);
  measure = parse_measure(name, kind, "--target");
  return goal;
}

bool is_result(const SweepRow& row) {
  return row.status == SweepStatus::done &&
         std::all_of(row.measured.begin(), row.measured.end(),
                     [](double value) { return std::isfinite(value); });
}

double violation_of(const TuneOptions& options, const SweepRow& row) {
  double worst = -std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < options.bounds.size(); ++b) {
    const TuneBound& bound = options.bounds[b];
    const double size = bound.limit == 0.0 ? 1.0 : std::abs(bound.limit);
    worst = std::max(worst, bound.excess(row.measured[b + 1]) / size);
  }
  return worst;
}

}  // namespace sheave::command
