#pragma once
// The outcome of a sweep: one row per run.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "command/sweep/plan.h"
#include "scenes/scene.h"

namespace sheave::command {

/// The task of each row of a sweep: the word of --of.
enum class SweepKind {
  run,      ///< a run over the duration of the scene
  statics,  ///< the equilibrium near the pose of the scene
  modes,    ///< that equilibrium and the vibrations about it
};
inline constexpr std::array<std::string_view, 3> sweep_kind_names{"run", "statics", "modes"};
[[nodiscard]] constexpr std::string_view name_of(SweepKind kind) {
  return sweep_kind_names[static_cast<std::size_t>(kind)];
}

/// The kind of a measure of a machine at rest; runs have quantities alone.
enum class RestFigure {
  quantity,         ///< the value of CheckDef::quantity
  largest_tension,  ///< of all spans of the cable with the name CheckDef::quantity
  eigenvalue,       ///< square of an angular frequency of Equilibrium, ascending
  unstable_motions,
  neutral_motions,
  frequency,  ///< of a mode
  damping,    ///< damping ratio of a mode
};

inline constexpr std::size_t most_measured_mode = 100'000;

/// A number measured in every run.
struct SweepMeasure {
  std::string name;   ///< as the user wrote it, e.g. "max:rope.0.tension"
  std::string unit;   ///< empty: a pure number
  CheckDef course{};  ///< quantity, statistic and window; without a bound to check
  RestFigure figure = RestFigure::quantity;
  std::size_t number = 0;            ///< of the eigenvalue or mode, from 1
  std::string option = "--measure";  ///< that named it, for messages
};

/// Parses a measure. Of runs: "STATISTIC:QUANTITY", or "QUANTITY" for the value at the end. "@TIME"
/// or "@FROM:TO" behind it restricts the time. The statistics are those of checks, and min and max.
/// Of a machine at rest: "QUANTITY", "max:CABLE.tension", "eigenvalue:N", "unstable_motions" or
/// "neutral_motions"; of modes also "frequency:N" and "damping:N". A Failure (2) names `option` and
/// the fault.
[[nodiscard]] SweepMeasure parse_measure(const std::string& text, SweepKind kind = SweepKind::run,
                                         const std::string& option = "--measure");

/// The outcome of a run of a sweep.
enum class SweepStatus {
  done,
  doubtful,    ///< the certificate is not clean (docs/explanation/certificate.md)
  diverged,    ///< the simulation stopped at a meaningless state
  invalid,     ///< the values make no valid scene
  time_limit,  ///< took longer than --time-limit
  no_rest,     ///< no equilibrium was found
  unstable,    ///< the equilibrium is unstable
};
inline constexpr std::array<std::string_view, 7> sweep_status_names{
    "done", "doubtful", "diverged", "invalid", "time-limit", "no-rest", "unstable"};

struct SweepRow {
  std::size_t run = 0;              ///< number of the run, from 0
  std::vector<std::string> values;  ///< one per axis
  SweepStatus status = SweepStatus::done;
  /// One per measure; NaN for a missing value, and always for a run that did not reach its end.
  std::vector<double> measured;
  double end = 0.0;  ///< time reached [s]; at rest the time of the start
  /// The certificate's worst figure relative to its scale; NaN: no certificate.
  double doubt = 0.0;
  std::string doubt_of;   ///< kind of that figure; empty: none
  std::string message{};  ///< why the run is not done, in one line; or the measures that failed

  [[nodiscard]] bool usable() const {
    return status == SweepStatus::done || status == SweepStatus::doubtful ||
           status == SweepStatus::unstable;
  }
};

/// Common data of all runs of a sweep.
struct SweepHead {
  std::string key;    ///< hash of the scene, the plan, the measures and the program
  std::string scene;  ///< path of the scene, for people
  std::vector<std::string> axes;
  std::vector<std::string> axis_units;  ///< of the first axes; empty: a pure number, or unknown
  std::vector<SweepMeasure> measures;
  std::size_t runs = 0;  ///< runs of all shards together
  SweepShard shard;
  SweepKind kind = SweepKind::run;
  bool tune = false;  ///< the rows are steps of `sheave tune`
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
/// Measures over the varied axes: a line over one axis of numbers, bars over one of words, a heat
/// map over two axes, scatter plots over more.
[[nodiscard]] GnuplotScript sweep_chart_script(const SweepTable& table, ChartFormat format);

}  // namespace sheave::command
