#pragma once
// sheave tune: the search for the best settings of a scene.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command/output/gnuplot_script.h"
#include "command/sweep/run.h"
#include "command/tune/optimiser.h"

namespace sheave::command {

/// The aim of a tune; its measure is the first one.
struct TuneGoal {
  enum class Sense { minimise, maximise, target };
  Sense sense = Sense::minimise;
  double target = 0.0;  ///< wanted value of the measure; of Sense::target

  /// The number that is to be small: the value, its negative, or its distance from the target.
  [[nodiscard]] double cost(double value) const;
};

/// A bound of a measure, of --keep; the measures of bounds follow that of the goal.
struct TuneBound {
  bool above = false;  ///< the measure must be above the limit, or equal; else below, or equal
  double limit = 0.0;

  /// Violation in the unit of the measure; at most 0 if the bound is kept.
  [[nodiscard]] double excess(double value) const { return above ? limit - value : value - limit; }
};

/// Parses "MEASURE < VALUE" or "MEASURE > VALUE" (also <= and >=, which mean the same). A Failure
/// (2).
[[nodiscard]] TuneBound parse_bound(const std::string& text, SweepKind kind, SweepMeasure& measure);
/// Parses "MEASURE = VALUE" of --target. A Failure (2).
[[nodiscard]] TuneGoal parse_target(const std::string& text, SweepKind kind, SweepMeasure& measure);

inline constexpr std::size_t most_tune_runs = 100'000;
inline constexpr std::size_t most_tuned_settings = 30;
inline constexpr double least_tune_tolerance = 1e-8;

struct TuneOptions {
  SweepOptions rows;  ///< scene, ranges, measures, journal
  TuneGoal goal;
  std::vector<TuneBound> bounds;
  std::vector<std::string> starts;     ///< of --start: "NAME=VALUE"
  std::optional<TuneMethod> method{};  ///< empty: chosen by the task
  std::size_t most_runs = 200;
  double tolerance = 1e-4;  ///< of each setting, as a part of its range
};

/// How a tune ended.
enum class TuneEnd {
  converged,
  limit,      ///< --runs were done before
  violated,   ///< no run keeps all bounds
  flat,       ///< the goal has the same value in all runs
  no_result,  ///< no run is done
};
inline constexpr std::array<std::string_view, 5> tune_end_names{"converged", "limit", "violated",
                                                                "flat", "no-result"};

struct TuneResult {
  TuneEnd end = TuneEnd::no_result;
  TuneMethod method = TuneMethod::cobyla;
  SweepTable table;                   ///< all runs, in their order
  std::vector<std::size_t> improved;  ///< rows that were the best up to then
  /// The best row; if no run keeps all bounds, the one that violates them least. Empty without a
  /// run that is done.
  std::optional<std::size_t> best;
  std::vector<std::size_t> active;  ///< bounds at which the best row lies
  std::vector<std::size_t> at_end;  ///< settings that are at the end of their range there
};

/// Whether a row may be the best one: numbers that contradict each other and an unstable rest are no
/// result.
[[nodiscard]] bool is_result(const SweepRow& row);

/// The largest relative violation of the bounds; at most 0 if all are kept.
[[nodiscard]] double violation_of(const TuneOptions& options, const SweepRow& row);

/// Searches. `options.rows` gets the units of the measures. A Failure: 2 or 65 if the task is not
/// possible, 75 if the run at the start is not done and the method needs it, 130 on a signal; runs
/// completed by then are in the journal.
[[nodiscard]] TuneResult run_tune(TuneOptions& options);

/// The result as text, with the runs that were the best up to then.
[[nodiscard]] std::string tune_text(const TuneOptions& options, const TuneResult& result);
[[nodiscard]] std::string tune_json(const TuneOptions& options, const TuneResult& result);
/// How the goal and the settings changed over the runs.
[[nodiscard]] GnuplotScript tune_chart_script(const TuneOptions& options, const TuneResult& result,
                                              ChartFormat format);

}  // namespace sheave::command
