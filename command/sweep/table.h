#pragma once
// The outcome of a sweep: one row per run.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "command/sweep/plan.h"
#include "scenes/scene.h"

namespace sheave::command {

/// A number that is taken from every run.
struct SweepMeasure {
  std::string name;  ///< as the user wrote it, e.g. "max:rope.0.tension"
  std::string unit;  ///< empty: a pure number
  CheckDef course;   ///< quantity, statistic and window; checks nothing
};

/// "STATISTIC:QUANTITY" or, for the value at the end, "QUANTITY"; "@TIME" or "@FROM:TO" behind it
/// tell when. Statistics are those of checks, and min and max. A Failure (2) says what is wrong.
[[nodiscard]] SweepMeasure parse_measure(const std::string& text);

/// How a run of a sweep ended.
enum class SweepStatus {
  done,
  doubtful,    ///< its own numbers contradict each other (docs/explanation/certificate.md)
  diverged,    ///< the simulation stopped at a state that means nothing
  invalid,     ///< the values make no valid scene
  time_limit,  ///< took longer than --time-limit
};
inline constexpr std::array<std::string_view, 5> sweep_status_names{"done", "doubtful", "diverged",
                                                                    "invalid", "time-limit"};

struct SweepRow {
  std::size_t run = 0;              ///< its number, from 0
  std::vector<std::string> values;  ///< one per axis
  SweepStatus status = SweepStatus::done;
  /// One per measure; NaN where there is none: always of a run that did not reach its end.
  std::vector<double> measured;
  double end = 0.0;       ///< time that was reached [s]
  double doubt = 0.0;     ///< the certificate's worst figure, relative to its scale; NaN: none
  std::string doubt_of;   ///< which kind of figure that is; empty: none
  std::string message{};  ///< why it is not done, in one line; or what could not be measured

  [[nodiscard]] bool usable() const {
    return status == SweepStatus::done || status == SweepStatus::doubtful;
  }
};

/// What all runs of a sweep have in common.
struct SweepHead {
  std::string key;    ///< a hash of the scene, the plan, the measures and the program
  std::string scene;  ///< path, for people
  std::vector<std::string> axes;
  std::vector<SweepMeasure> measures;
  std::size_t runs = 0;  ///< of all shards
  SweepShard shard;
};

struct SweepTable {
  SweepHead head;
  std::vector<SweepRow> rows;  ///< in the order of their numbers; not all of them in a shard
};

/// The answer in words and, if they are few, the rows.
[[nodiscard]] std::string sweep_text(const SweepTable& table);
[[nodiscard]] std::string sweep_json(const SweepTable& table);
/// One line per run. Nothing in it depends on the machine, its cores or shards.
[[nodiscard]] std::string sweep_csv(const SweepTable& table);
/// Measures over what is varied: lines over one axis, heat maps over two, clouds of points over
/// more.
[[nodiscard]] GnuplotScript sweep_chart_script(const SweepTable& table, ChartFormat format);

}  // namespace sheave::command
