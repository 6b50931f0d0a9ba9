#pragma once
// The stages of sheave trade in their order, and their common data. Each stage fills in a part of
// the table.

#include <algorithm>
#include <cstddef>
#include <string>

#include "command/trade/journal.h"
#include "command/trade/table.h"

namespace sheave::command {

/// A budget of wall time that begins with the construction. The clock must outlive it.
class TimeLimit {
 public:
  TimeLimit(double seconds, const measure::Clock& clock)
      : clock_(&clock), start_(clock.wall()), seconds_(seconds) {}

  [[nodiscard]] double seconds() const { return seconds_; }
  /// Remaining time [s]; negative after the end.
  [[nodiscard]] double left() const { return seconds_ - (clock_->wall() - start_); }
  /// A share of the remaining time, beginning now.
  [[nodiscard]] TimeLimit part(double share) const {
    return {std::max(0.0, share * left()), *clock_};
  }

 private:
  const measure::Clock* clock_;
  double start_;
  double seconds_;
};

struct TradeRun {
  const Scene& scene;
  const TradeOptions& options;
  TradeTable& table;
  TimeLimit limit;  ///< for all stages
  TradeJournal journal;
  measure::Trajectory truth;  ///< trajectory of the reference; empty until it is needed
  std::size_t frames = 0;     ///< number of compared frames; 0: all
  int first_substeps = 1;     ///< substeps of the reference's coarsest run

  TradeRun(const Scene& of, const TradeOptions& how, TradeTable& into)
      : scene(of),
        options(how),
        table(into),
        limit(60.0 * how.minutes, how.clock),
        journal(how.resume, how.resume.empty() ? "" : trade_key(of, how)) {}
  [[nodiscard]] int threads() const;
};

/// Predicts the cost of all settings, and the finest possible reference, from a few frames with
/// each solver and integrator.
void plan_trade(TradeRun& run);
/// Computes the reference and the time up to which it is valid. Settings finer than the reference
/// are skipped.
void make_reference(TradeRun& run);
/// The error of every setting, on all cores, as long as there is time. All pairs of solver and
/// integrator share the time; within a pair the cheapest setting comes first.
void measure_errors(TradeRun& run);
/// The CPU time of every setting that has an error, on this thread alone.
void measure_times(TradeRun& run);
/// Measures the rungs of the model with the cheapest setting that has an error of 0.1 %, or with
/// the most accurate one.
void climb_ladder(TradeRun& run);

/// Throws the Failure for a command ended by a signal.
[[noreturn]] void stop_interrupted();
/// "takes about 3 min 10 s, and 20 s are left".
[[nodiscard]] std::string no_time_text(double expected, double left);

}  // namespace sheave::command
