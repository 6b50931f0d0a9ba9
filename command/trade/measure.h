#pragma once
// The stages of sheave trade, in their order, and what they share. Each fills in a part of the
// table.

#include <algorithm>
#include <cstddef>
#include <string>

#include "command/trade/journal.h"
#include "command/trade/table.h"

namespace sheave::command {

/// Wall time that may be used up, from when it is made. The clock must outlive it.
class TimeLimit {
 public:
  TimeLimit(double seconds, const measure::Clock& clock)
      : clock_(&clock), start_(clock.wall()), seconds_(seconds) {}

  [[nodiscard]] double seconds() const { return seconds_; }
  /// [s]; negative when it is over.
  [[nodiscard]] double left() const { return seconds_ - (clock_->wall() - start_); }
  /// A share of what is left, from now on.
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
  TimeLimit limit;  ///< of everything
  TradeJournal journal;
  measure::Trajectory truth;  ///< of the reference; empty until it is needed
  std::size_t frames = 0;     ///< of both runs that are compared; 0: all
  int first_substeps = 1;     ///< of the reference's coarsest run

  TradeRun(const Scene& of, const TradeOptions& how, TradeTable& into)
      : scene(of),
        options(how),
        table(into),
        limit(60.0 * how.minutes, how.clock),
        journal(how.resume, how.resume.empty() ? "" : trade_key(of, how)) {}
  [[nodiscard]] int threads() const;
};

/// Guesses from a few frames of each solver and integrator what the runs of all settings cost, and
/// how fine a reference can be.
void plan_trade(TradeRun& run);
/// The reference, and until when it can judge. Settings that are finer than it are skipped.
void make_reference(TradeRun& run);
/// The error of every setting, over the cores, as long as there is time: of each solver with each
/// integrator, which share it, the cheapest first.
void measure_errors(TradeRun& run);
/// The time of every setting that has an error, on this thread alone.
void measure_times(TradeRun& run);
/// The rungs of the model, with the cheapest setting that has an error of 0.1 %, or the most
/// accurate one.
void climb_ladder(TradeRun& run);

/// Throws the Failure of a command that a signal has ended.
[[noreturn]] void stop_interrupted();
/// "takes about 3 min 10 s, and 20 s are left".
[[nodiscard]] std::string no_time_text(double expected, double left);

}  // namespace sheave::command
