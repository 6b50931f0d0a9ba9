#include "command/tune/task.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/content_hash.h"
#include "command/sweep/row_run.h"
#include "engine/number_text.h"

namespace sheave::command {
namespace {

double value_at(const SweepAxis& axis, double share) {
  if (share <= 0.0) return axis.low;
  if (share >= 1.0) return axis.high;
  if (axis.logarithmic) return axis.low * std::pow(axis.high / axis.low, share);
  return axis.low + share * (axis.high - axis.low);
}

double share_of(const SweepAxis& axis, double value) {
  if (axis.logarithmic) return std::log(value / axis.low) / std::log(axis.high / axis.low);
  return (value - axis.low) / (axis.high - axis.low);
}

}  // namespace

std::vector<std::string> values_at(const TuneOptions& options, std::span<const double> place) {
  std::vector<std::string> values;
  for (std::size_t a = 0; a < place.size(); ++a) {
    values.push_back(number_text(value_at(options.rows.plan.axes[a], place[a])));
  }
  return values;
}

void check_axes(const TuneOptions& options) {
  const auto& axes = options.rows.plan.axes;
  if (axes.empty()) {
    throw Failure(ExitCode::usage, "nothing is varied; give --vary NAME=LOW:HIGH");
  }
  if (axes.size() > most_tuned_settings) {
    throw Failure(ExitCode::usage,
                  fmt::format("--vary: at most {} settings can be tuned", most_tuned_settings));
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const SweepAxis& axis = axes[i];
    if (!axis.values.empty()) {
      throw Failure(ExitCode::usage,
                    fmt::format("--vary {0}: a tune needs a range, {0}=LOW:HIGH or "
                                "{0}=LOW:HIGH:log; a sweep takes values",
                                axis.name));
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (axes[k].name != axis.name) continue;
      throw Failure(ExitCode::usage, "--vary " + axis.name + ": is varied twice");
    }
  }
}

Place start_of(const TuneOptions& options) {
  const auto& axes = options.rows.plan.axes;
  Place start(axes.size(), 0.5);
  for (const std::string& text : options.starts) {
    const std::size_t equals = text.rfind('=');
    const std::string name = text.substr(0, equals);
    const auto axis = std::find_if(axes.begin(), axes.end(),
                                   [&](const SweepAxis& one) { return one.name == name; });
    if (equals == std::string::npos || axis == axes.end()) {
      throw Failure(
          ExitCode::usage,
          fmt::format("--start {}: must be NAME=VALUE of a setting that --vary names", text));
    }
    double value = 0.0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + equals + 1, last, value);
    const auto [low, high] = std::minmax(axis->low, axis->high);
    if (error != std::errc{} || end != last || !(value >= low && value <= high)) {
      throw Failure(ExitCode::usage, fmt::format("--start {}: must be a number from {} to {}", text,
                                                 number_text(low), number_text(high)));
    }
    start[static_cast<std::size_t>(axis - axes.begin())] = share_of(*axis, value);
  }
  return start;
}

TuneMethod method_of(const TuneOptions& options) {
  const std::size_t settings = options.rows.plan.axes.size();
  const bool smooth = settings > 1 && options.bounds.empty();
  if (!options.method) return smooth ? TuneMethod::bobyqa : TuneMethod::cobyla;
  if (*options.method == TuneMethod::bobyqa && !smooth) {
    throw Failure(ExitCode::usage,
                  "--method bobyqa: needs two or more settings and no --keep; cobyla does both");
  }
  return *options.method;
}

std::string key_of_tune(const TuneOptions& options, TuneMethod method, const Place& start,
                        const std::vector<std::string>& scenes) {
  ContentHash hash;
  hash.add(key_of(options.rows, {}, scenes));
  for (const SweepAxis& axis : options.rows.plan.axes) {
    hash.add(fmt::format("{} {} {}", axis.low, axis.high, axis.logarithmic));
  }
  for (const double share : start) hash.add(number_text(share));
  hash.add(fmt::format("{} {}", static_cast<int>(options.goal.sense), options.goal.target));
  for (const TuneBound& bound : options.bounds) {
    hash.add(fmt::format("{} {}", bound.above, bound.limit));
  }
  hash.add(fmt::format("{} {}", name_of(method), options.tolerance));
  // A global search is given half of the runs, so their number decides its course.
  if (method == TuneMethod::direct) hash.add(fmt::format("{}", options.most_runs));
  return hash.text();
}

}  // namespace sheave::command
