#pragma once
// The runs of a sweep: the varied settings and the values of every run.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "command/input/case_table.h"

namespace sheave::command {

/// How the values of several axes are combined to runs.
enum class SweepDesign {
  grid,    ///< all combinations; the last axis changes fastest
  list,    ///< run k takes value k of every axis
  random,  ///< independent uniform draws from each range or list
  /// Latin hypercube (McKay, Beckman, Conover 1979): each range is divided into as many equal parts
  /// as there are runs, and each part is used by exactly one run
  latin_hypercube,
};

/// A setting or a parameter of the scene with its value.
struct SweepSetting {
  std::string name;   ///< "/json/pointer" of a setting, or the name of a parameter
  std::string value;  ///< JSON, or a bare word

  [[nodiscard]] bool is_parameter() const { return !name.starts_with('/'); }
};

/// One --vary option: a setting or parameter, and the source of its values. Or the load cases of
/// --case and --cases, whose values are their names.
struct SweepAxis {
  std::string name;  ///< "/json/pointer" of a setting, or the name of a parameter of the scene
  std::vector<std::string> values{};  ///< JSON values or bare words; empty: a range to draw from
  double low = 0.0;                   ///< lower end of the range
  double high = 0.0;
  bool logarithmic = false;  ///< even spacing in the logarithm
  /// Of load cases: the settings of each, one list per value; empty for --vary.
  std::vector<std::vector<SweepSetting>> cases{};
  std::string unit{};  ///< of a setting of the scene; empty: a pure number, a parameter or words

  /// The settings that a value of this axis stands for.
  [[nodiscard]] std::vector<SweepSetting> settings_of(const std::string& value) const;
};

/// Parses "NAME=VALUES". VALUES is "1,2,4" (a list), "50:500:10" (10 values from 50 to 500, both
/// included) or "50:500" (a range to draw from). ":log" behind one of the last two gives even
/// spacing in the logarithm. A Failure (2) names the fault.
[[nodiscard]] SweepAxis parse_axis(const std::string& text);

/// The axis of load cases.
[[nodiscard]] SweepAxis case_axis(std::vector<LoadCase> cases);

struct SweepPlan {
  std::vector<SweepAxis> axes;
  SweepDesign design = SweepDesign::grid;
  std::size_t samples = 0;  ///< number of runs of random and latin_hypercube
  std::uint64_t seed = 1;   ///< for both; equal seeds give equal runs on every machine
};

/// A larger number of runs is taken for a typing error.
inline constexpr std::size_t most_sweep_runs = 1'000'000;

/// The number of runs of the plan. A Failure (2) if there is no run, if there are too many, or if
/// the axes do not fit the design.
[[nodiscard]] std::size_t count_runs(const SweepPlan& plan);

/// The values of every run, one per axis.
[[nodiscard]] std::vector<std::vector<std::string>> sweep_points(const SweepPlan& plan);

/// The part of a sweep that this process does: the runs with number % count == index - 1.
struct SweepShard {
  std::size_t index = 1;  ///< from 1
  std::size_t count = 1;

  [[nodiscard]] bool has(std::size_t run) const { return run % count == index - 1; }
};
/// Parses "2/8". A Failure (2) for another form.
[[nodiscard]] SweepShard parse_shard(const std::string& text);

}  // namespace sheave::command
