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

/// A number measured in every run.
struct SweepMeasure {
  std::string name;  ///< as the user wrote it, e.g. "max:rope.0.tension"
  std::string unit;  ///< empty: a pure number
  CheckDef course;   ///< quantity, statistic and window; without a bound to check
};

/// Parses "STATISTIC:QUANTITY", or "QUANTITY" for the value at the end. "@TIME" or "@FROM:TO"
/// behind it restricts the time. The statistics are those of checks, and min and max. A Failure (2)
/// names the fault.
[[nodiscard]] SweepMeasure parse_measure(const std::string& text);

/// The outcome of a run of a sweep.
enum class SweepStatus {
  done,
  doubtful,    ///< the certificate is not clean (docs/explanation/certificate.md)
  diverged,    ///< the simulation stopped at a meaningless state
  invalid,     ///< the values make no valid scene
  time_limit,  ///< took longer than --time-limit
};
inline constexpr std::array<std::string_view, 5> sweep_status_names{"done", "doubtful", "diverged",
                                                                    "invalid", "time-limit"};

struct SweepRow {
  std::size_t run = 0;              ///< number of the run, from 0
  std::vector<std::string> values;  ///< one per axis
  SweepStatus status = SweepStatus::done;
  /// One per measure; NaN for a missing value, and always for a run that did not reach its end.
  std::vector<double> measured;
  double end = 0.0;  ///< time reached [s]
  /// The certificate's worst figure relative to its scale; NaN: no certificate.
  double doubt = 0.0;
  std::string doubt_of;   ///< kind of that figure; empty: none
  std::string message{};  ///< why the run is not done, in one line; or the measures that failed

  [[nodiscard]] bool usable() const {
    return status == SweepStatus::done || status == SweepStatus::doubtful;
  }
};

/// Common data of all runs of a sweep.
struct SweepHead {
  std::string key;    ///< hash of the scene, the plan, the measures and the program
  std::string scene;  ///< path of the scene, for people
  std::vector<std::string> axes;
  std::vector<SweepMeasure> measures;
  std::size_t runs = 0;  ///< runs of all shards together
  SweepShard shard;
};

struct SweepTable {
  SweepHead head;
  std::vector<SweepRow> rows;  ///< in the order of their numbers; a shard has only its own
};

/// The results as text, with all rows if they are few.
[[nodiscard]] std::string sweep_text(const SweepTable& table);
[[nodiscard]] std::string sweep_json(const SweepTable& table);
/// One line per run. The text is independent of the machine, its cores and shards.
[[nodiscard]] std::string sweep_csv(const SweepTable& table);
/// Measures over the varied axes: lines over one axis, heat maps over two, scatter plots over more.
[[nodiscard]] GnuplotScript sweep_chart_script(const SweepTable& table, ChartFormat format);

}  // namespace sheave::command
