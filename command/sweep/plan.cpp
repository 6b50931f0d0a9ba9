#include "command/sweep/plan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <set>

#include <fmt/format.h>

#include "command/failure.h"
#include "engine/field_check.h"

namespace sheave::command {
namespace {

/// Uses the generator's bits directly, because the distributions of standard libraries differ.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seed) {}
  /// In [0, 1).
  double share() { return std::ldexp(static_cast<double>(generator_() >> 11U), -53); }
  /// In [0, count).
  std::size_t index(std::size_t count) {
    const auto drawn = static_cast<std::size_t>(share() * static_cast<double>(count));
    return std::min(drawn, count - 1);
  }

 private:
  std::mt19937_64 generator_;
};

[[noreturn]] void bad_axis(const std::string& text, const std::string& what) {
  throw Failure(ExitCode::usage,
                fmt::format("--vary {}: {}; for example --vary load=50:500:10 (10 values), "
                            "--vary /step/substeps=1,2,4, --vary load=50:500 (to draw from)",
                            text, what));
}

std::vector<std::string> parts_at(const std::string& text, char separator) {
  std::vector<std::string> list;
  std::size_t begin = 0;
  // A comma within brackets, braces or quotes is part of a JSON value.
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
      continue;
    }
    if (c == '"') quoted = true;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (c != separator || depth > 0) continue;
    list.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  list.push_back(text.substr(begin));
  return list;
}

std::optional<double> finite_number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// The value at the fraction `share` between low and high.
double value_between(const SweepAxis& axis, double share) {
  if (share <= 0.0) return axis.low;
  if (share >= 1.0) return axis.high;
  if (axis.logarithmic) return axis.low * std::pow(axis.high / axis.low, share);
  return axis.low + share * (axis.high - axis.low);
}

/// Fills in low, high and logarithmic, and the values if their number is given.
void read_range(const std::string& text, std::vector<std::string> parts, SweepAxis& axis) {
  if (parts.back() == "log") {
    axis.logarithmic = true;
    parts.pop_back();
  }
  if (parts.size() < 2 || parts.size() > 3) bad_axis(text, "a range is LOW:HIGH or LOW:HIGH:COUNT");
  const std::optional<double> low = finite_number_of(parts[0]);
  const std::optional<double> high = finite_number_of(parts[1]);
  if (!low || !high) bad_axis(text, "both ends of a range must be numbers");
  axis.low = *low;
  axis.high = *high;
  if (!std::isfinite(*high - *low)) bad_axis(text, "the range is too wide");
  if (axis.logarithmic && !(*low > 0.0 && *high > 0.0)) {
    bad_axis(text, "a range that is even in the logarithm must be above 0");
  }
  if (parts.size() == 2) {
    if (*low == *high) bad_axis(text, "the range is empty");
    return;
  }
  std::size_t count = 0;
  const std::string& digits = parts[2];
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error != std::errc{} || end != digits.data() + digits.size() || count < 1 ||
      count > most_sweep_runs) {
    bad_axis(text, fmt::format("COUNT must be a whole number from 1 to {}", most_sweep_runs));
  }
  if (count == 1 && *low != *high) bad_axis(text, "one value cannot be both ends of the range");
  for (std::size_t i = 0; i < count; ++i) {
    const double last = count > 1 ? static_cast<double>(count - 1) : 1.0;
    axis.values.push_back(number_text(value_between(axis, static_cast<double>(i) / last)));
  }
}

/// The value of an axis that belongs to a share in [0, 1) of its range or list.
std::string drawn_value(const SweepAxis& axis, double share) {
  if (axis.values.empty()) return number_text(value_between(axis, share));
  const auto count = static_cast<double>(axis.values.size());
  const auto index = static_cast<std::size_t>(share * count);
  return axis.values[std::min(index, axis.values.size() - 1)];
}

using Points = std::vector<std::vector<std::string>>;

Points grid_points(const SweepPlan& plan, std::size_t count) {
  Points points;
  points.reserve(count);
  for (std::size_t run = 0; run < count; ++run) {
    std::vector<std::string>& point = points.emplace_back(plan.axes.size());
    std::size_t rest = run;
    for (std::size_t a = plan.axes.size(); a-- > 0;) {
      const std::vector<std::string>& values = plan.axes[a].values;
      point[a] = values[rest % values.size()];
      rest /= values.size();
    }
  }
  return points;
}

/// Draws axis by axis, so that an additional axis does not change the values of earlier ones.
Points drawn_points(const SweepPlan& plan, std::size_t count) {
  Points points(count);
  Draw draw(plan.seed);
  for (const SweepAxis& axis : plan.axes) {
    std::vector<std::size_t> part(count);
    std::iota(part.begin(), part.end(), std::size_t{0});
    if (plan.design == SweepDesign::latin_hypercube) {
      for (std::size_t i = count; i-- > 1;) std::swap(part[i], part[draw.index(i + 1)]);
    }
    for (std::size_t run = 0; run < count; ++run) {
      double share = draw.share();
      if (plan.design == SweepDesign::latin_hypercube) {
        share = (static_cast<double>(part[run]) + share) / static_cast<double>(count);
      }
      points[run].push_back(drawn_value(axis, share));
    }
  }
  return points;
}

/// A Failure (2) if two axes, or an axis and the table of cases, vary the same setting.
void check_names(const SweepPlan& plan) {
  std::set<std::string> names;
  for (const SweepAxis& axis : plan.axes) {
    std::set<std::string> own{axis.name};
    for (const auto& settings : axis.cases) {
      for (const SweepSetting& setting : settings) own.insert(setting.name);
    }
    for (const std::string& name : own) {
      if (names.insert(name).second) continue;
      throw Failure(ExitCode::usage, "--vary " + name +
                                         ": is varied twice; a setting may be in one --vary, or in "
                                         "a load case");
    }
  }
}

bool is_drawn(SweepDesign design) {
  return design == SweepDesign::random || design == SweepDesign::latin_hypercube;
}

}  // namespace

SweepAxis parse_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    bad_axis(text, "must be NAME=VALUES");
  }
  SweepAxis axis{text.substr(0, equals)};
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> list = parts_at(values, ',');
  const std::vector<std::string> range = parts_at(values, ':');
  if (list.size() == 1 && range.size() > 1) {
    read_range(text, range, axis);
    return axis;
  }
  for (const std::string& value : list) {
    if (value.empty()) bad_axis(text, "a value is empty");
    const std::optional<double> number = finite_number_of(value);
    // JSON does not allow ".5" and "+5", so the number is written anew.
    axis.values.push_back(number ? number_text(*number) : value);
  }
  return axis;
}

std::vector<SweepSetting> SweepAxis::settings_of(const std::string& value) const {
  if (cases.empty()) return {{name, value}};
  const auto found = std::find(values.begin(), values.end(), value);
  return cases[static_cast<std::size_t>(found - values.begin())];
}

SweepAxis case_axis(std::vector<LoadCase> cases) {
  SweepAxis axis{"case"};
  for (LoadCase& one : cases) {
    axis.values.push_back(std::move(one.name));
    std::vector<SweepSetting>& settings = axis.cases.emplace_back();
    for (auto& [name, value] : one.values) settings.push_back({std::move(name), std::move(value)});
  }
  return axis;
}

std::size_t count_runs(const SweepPlan& plan) {
  if (plan.axes.empty()) {
    throw Failure(
        ExitCode::usage,
        "nothing is varied; give --vary NAME=VALUES, --case CASE or a table, --cases FILE");
  }
  check_names(plan);
  if (is_drawn(plan.design)) {
    if (plan.samples == 0) {
      throw Failure(ExitCode::usage, "runs that are drawn need --samples, their number");
    }
    return plan.samples;
  }
  std::size_t count = plan.design == SweepDesign::grid ? 1 : plan.axes.front().values.size();
  for (const SweepAxis& axis : plan.axes) {
    if (axis.values.empty()) {
      throw Failure(ExitCode::usage,
                    fmt::format("--vary {0}: a range without a number of values is for --design "
                                "random and latin-hypercube; allowed here: {0}={1}:{2}:COUNT",
                                axis.name, number_text(axis.low), number_text(axis.high)));
    }
    if (plan.design == SweepDesign::list && axis.values.size() != count) {
      throw Failure(ExitCode::usage,
                    fmt::format("--vary {}: {} values, and {} has {}; in a list all have as many",
                                axis.name, axis.values.size(), plan.axes.front().name, count));
    }
    if (plan.design == SweepDesign::grid) {
      count *= axis.values.size();
      if (count > most_sweep_runs) {
        throw Failure(ExitCode::usage, fmt::format("more than {} runs", most_sweep_runs));
      }
    }
  }
  return count;
}

std::vector<std::vector<std::string>> sweep_points(const SweepPlan& plan) {
  const std::size_t count = count_runs(plan);
  if (is_drawn(plan.design)) return drawn_points(plan, count);
  if (plan.design == SweepDesign::grid) return grid_points(plan, count);
  Points points(count);
  for (std::size_t run = 0; run < count; ++run) {
    for (const SweepAxis& axis : plan.axes) points[run].push_back(axis.values[run]);
  }
  return points;
}

SweepShard parse_shard(const std::string& text) {
  SweepShard shard;
  const char* const end = text.data() + text.size();
  auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  bool good = error == std::errc{} && slash != end && *slash == '/';
  if (good) {
    const auto [rest, second] = std::from_chars(slash + 1, end, shard.count);
    good = second == std::errc{} && rest == end && shard.count <= most_sweep_runs &&
           shard.index >= 1 && shard.index <= shard.count;
  }
  if (!good) {
    throw Failure(ExitCode::usage,
                  "--shard " + text + ": must be I/N, part I from 1 to N, for example 2/8");
  }
  return shard;
}

}  // namespace sheave::command
