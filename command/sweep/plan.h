#pragma once
// Which runs a sweep consists of: what is varied, and the values of every run.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sheave::command {

/// How the values of several axes make runs.
enum class SweepDesign {
  grid,    ///< every value with every other; the last axis changes fastest
  list,    ///< the first values of all axes, then the second ones, ...
  random,  ///< each value drawn on its own, evenly from its range or list
  /// Latin hypercube (McKay, Beckman, Conover 1979): each range is cut into as many equal parts as
  /// there are runs, and each part has one run
  latin_hypercube,
};

/// What --vary says: one setting or parameter, and where its values come from.
struct SweepAxis {
  std::string name;  ///< "/json/pointer" of a setting, or the name of a parameter of the scene
  std::vector<std::string> values{};  ///< each JSON or a bare word; empty: a range to draw from
  double low = 0.0;                   ///< the range
  double high = 0.0;
  bool logarithmic = false;  ///< the range is even in the logarithm

  [[nodiscard]] bool is_setting() const { return name.starts_with('/'); }
};

/// "NAME=VALUES" with VALUES one of "1,2,4" (a list), "50:500:10" (10 values from 50 to 500, both
/// included), "50:500" (a range to draw from); ":log" behind either of the latter makes it even in
/// the logarithm. A Failure (2) says what is wrong.
[[nodiscard]] SweepAxis parse_axis(const std::string& text);

struct SweepPlan {
  std::vector<SweepAxis> axes;
  SweepDesign design = SweepDesign::grid;
  std::size_t samples = 0;  ///< runs of random and latin_hypercube
  std::uint64_t seed = 1;   ///< of both; the same seed gives the same runs everywhere
};

/// More runs than this are a slip of the pen.
inline constexpr std::size_t most_sweep_runs = 1'000'000;

/// How many runs the plan has. A Failure (2) if it has none, or too many, or if axes do not fit the
/// design.
[[nodiscard]] std::size_t count_runs(const SweepPlan& plan);

/// The values of every run, one per axis.
[[nodiscard]] std::vector<std::vector<std::string>> sweep_points(const SweepPlan& plan);

/// Which part of a sweep is done here: the runs with number % count == index - 1.
struct SweepShard {
  std::size_t index = 1;  ///< from 1
  std::size_t count = 1;

  [[nodiscard]] bool has(std::size_t run) const { return run % count == index - 1; }
};
/// "2/8". A Failure (2) if it is no such thing.
[[nodiscard]] SweepShard parse_shard(const std::string& text);

}  // namespace sheave::command
