// sheave trade: measuring. The stages: predicted costs, the reference, the error of every setting,
// the times of all settings (interleaved), and the rungs of the model. (Reference:
// command/trade/reference.cpp; ladder: command/trade/ladder.cpp.)

#include "command/trade/measure.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include <sheave_version.h>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/interrupt.h"
#include "command/parallel.h"
#include "command/progress.h"
#include "measure/scene_contender.h"
#include "measure/timing.h"

namespace sheave::command {
namespace {

/// If the relative error of the reference's energy exceeds this bound, nothing moves, and energies
/// are not compared.
constexpr double known_energy = 0.1;
/// A setting that costs this factor more than another one of at least its accuracy gets no second
/// sample: its time would have to be wrong by this factor to bring it to the front.
constexpr double out_of_reach = 2.0;
/// For such a setting with a CPU time [s] above this bound the time of the run that gave the error
/// is used.
constexpr double long_run = 0.1;
/// Shares of the remaining time for the errors, and then for the times; the rest is for the ladder.
constexpr double errors_share = 0.55;
constexpr double times_share = 0.7;

/// Stores the outcome of a run in its row.
void judge_run(const TradeRun& run, const measure::Trajectory& own, TradeRow& row) {
  const TradeTable& table = run.table;
  row.error = measure::error_of(own, run.truth);
  if (run.frames > 0) {
    const double energy = row.error.energy;
    row.error = measure::error_of(measure::first_frames(own, run.frames),
                                  measure::first_frames(run.truth, run.frames));
    row.error.energy = energy;
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (table.doubt.energy > known_energy) row.error.energy = none;
  if (run.scene.cables.empty()) row.error.tension = none;
  row.stretch = own.stretch;
  row.length_error = own.length_error;
  row.row_solves = static_cast<double>(own.row_solves) / table.simulated_seconds;
  row.fallbacks = own.fallbacks;
}

/// Runs settings in parallel. For each pair of solver and integrator the cheapest setting comes
/// first.
class ErrorStage {
  struct Family {
    std::vector<TradeRow*> rows;
    std::size_t next = 0;
    double spent = 0.0;  // approximate time spent on the earlier settings of this pair
  };

 public:
  explicit ErrorStage(TradeRun& run) : run_(run), limit_(run.limit.part(errors_share)) {
    // Each pair of solver and integrator, and the tolerances, get their share. Otherwise the cheap pairs would use all
    // the time.
    std::map<std::tuple<SolverKind, IntegratorKind, bool>, Family> families;
    for (TradeRow& row : run.table.rows) {
      if (!row.measured() || run.journal.restore(row)) continue;
      const StepSettings& step = row.setting.step;
      families[{step.solver, step.integrator, step.tolerance > 0.0}].rows.push_back(&row);
      total_ += row.expected_seconds;
    }
    for (auto& [key, family] : families) {
      std::stable_sort(family.rows.begin(), family.rows.end(),
                       [](const TradeRow* a, const TradeRow* b) {
                         return a->expected_seconds < b->expected_seconds;
                       });
    }
    const auto spent = [](const auto& entry) {
      const Family& family = entry.second;
      return family.next < family.rows.size() ? family.spent
                                              : std::numeric_limits<double>::infinity();
    };
    while (!families.empty()) {
      const auto least =
          std::min_element(families.begin(), families.end(),
                           [&](const auto& a, const auto& b) { return spent(a) < spent(b); });
      Family& family = least->second;
      if (family.next == family.rows.size()) break;
      TradeRow* const row = family.rows[family.next++];
      family.spent += row->expected_seconds;
      rows_.push_back(row);
    }
  }

  [[nodiscard]] bool empty() const { return rows_.empty(); }

  void measure() {
    Progress progress("errors", 0.0, total_, run_.options.quiet);
    run_parallel(
        rows_.size(), run_.threads(), [&](std::size_t i) { measure_row(*rows_[i]); },
        [&] {
          progress.update(done_, fmt::format("{} of {} settings", ended_.load(), rows_.size()));
          keep_ended();
        });
    keep_ended();
    run_.journal.save();
    if (interrupted()) stop_interrupted();
  }

 private:
  void measure_row(TradeRow& row) {
    if (interrupted()) return;
    const double left = limit_.left();
    if (row.expected_seconds > left) {
      row.skipped = no_time_text(row.expected_seconds, left);
      ++ended_;
      return;
    }
    const auto frames = static_cast<double>(measure::frame_count(run_.scene));
    bool late = false;
    const double start = run_.options.clock.cpu();
    const StopRequest stop = [&] {
      late = late || limit_.left() < 0.0;
      return late || interrupted();
    };
    const auto observe = [&](std::int64_t, std::int64_t) {
      done_ += row.expected_seconds / frames;
      return !stop();
    };
    const Result<measure::Trajectory> own =
        measure::record(row.setting.applied(run_.scene), observe, stop);
    row.run_seconds = run_.options.clock.cpu() - start;
    if (interrupted()) return;
    if (late) {
      row.skipped = fmt::format("not done after {}, when the time was used up",
                                duration_text(row.run_seconds));
    } else if (!own) {
      row.fault = to_text(own.errors());
    } else if (!own->complete()) {
      row.fault = "diverged: " + own->divergence->message;
    } else {
      judge_run(run_, *own, row);
    }
    const std::lock_guard lock(mutex_);
    fresh_.push_back(&row);
    ++ended_;
  }

  void keep_ended() {
    std::vector<TradeRow*> rows;
    {
      const std::lock_guard lock(mutex_);
      rows.swap(fresh_);
    }
    for (const TradeRow* row : rows) {
      if (row->skipped.empty()) run_.journal.keep(*row);
    }
    run_.journal.save_sometimes();
  }

  TradeRun& run_;
  TimeLimit limit_;
  std::vector<TradeRow*> rows_;
  double total_ = 0.0;
  std::atomic<double> done_ = 0.0;
  std::atomic<std::size_t> ended_ = 0;
  std::mutex mutex_;
  std::vector<TradeRow*> fresh_;  // measured, but not yet in the journal
};

/// Takes samples of times in rounds; each round samples every contender once.
class TimeStage {
 public:
  explicit TimeStage(TradeRun& run) : run_(run), limit_(run.limit.part(times_share)) {}

  /// Returns whether all settings were timed as often as requested.
  bool measure() {
    choose_rows();
    create_contenders();
    Progress progress("times", 0.0, expected_total(), run_.options.quiet);
    for (int round = 0; round < run_.options.repetitions && !sampled_.empty(); ++round) {
      const double expected = expected_round(round);
      if (round > 0 && expected > limit_.left()) {
        run_.table.limits.push_back(
            fmt::format("times: {} of {} repetitions; another takes about {}", round,
                        run_.options.repetitions, duration_text(expected)));
        break;
      }
      sample(round, progress);
    }
    finish();
    return run_.table.limits.empty();
  }

 private:
  struct Sampled {
    TradeRow* row = nullptr;
    int wanted = 1;
    measure::Contender contender{};
    std::vector<double> seconds{};  // per frame
  };

  [[nodiscard]] static double cost(const TradeRow& row) {
    constexpr double least_sample = 0.02;
    return std::max(row.run_seconds, least_sample);
  }

  [[nodiscard]] bool is_out_of_reach(const TradeRow& row) const {
    const double bound = run_.table.bound(row);
    return std::any_of(run_.table.rows.begin(), run_.table.rows.end(), [&](const TradeRow& other) {
      return other.measured() && run_.table.bound(other) <= bound &&
             out_of_reach * other.run_seconds < row.run_seconds;
    });
  }

  void choose_rows() {
    double once = 0.0;
    for (TradeRow& row : run_.table.rows) {
      if (!row.measured()) continue;
      const bool far = is_out_of_reach(row);
      // Keeps the time of the run that gave the error.
      if (far && row.run_seconds > long_run) continue;
      sampled_.push_back({&row, far ? 1 : run_.options.repetitions});
      once += cost(row);
    }
    const double left = limit_.left();
    if (once <= left) return;
    // There is no time for one sample of each. The long runs have a time from their error run.
    run_.table.limits.push_back(
        fmt::format("times: one sample of each takes about {}; those of more than {} s of CPU time "
                    "are the runs "
                    "that the errors are from",
                    duration_text(once), long_run));
    std::erase_if(sampled_, [](const Sampled& own) { return own.row->run_seconds > long_run; });
  }

  void create_contenders() {
    for (Sampled& own : sampled_) {
      Result<measure::Contender> contender = measure::scene_contender(
          own.row->setting.name(), own.row->setting.applied(run_.scene), interrupted);
      if (contender) {
        own.contender = std::move(contender).value();
      } else {
        own.row->fault = to_text(contender.errors());
      }
    }
    std::erase_if(sampled_, [](const Sampled& own) { return !own.row->measured(); });
  }

  [[nodiscard]] double expected_round(int round) const {
    double sum = 0.0;
    for (const Sampled& own : sampled_) sum += own.wanted > round ? cost(*own.row) : 0.0;
    return sum;
  }
  [[nodiscard]] double expected_total() const {
    double sum = 0.0;
    for (int round = 0; round < run_.options.repetitions; ++round) sum += expected_round(round);
    return sum;
  }

  void sample(int round, Progress& progress) {
    measure::TimingOptions timing;
    timing.repetitions = 1;
    timing.warm_up = round == 0;
    timing.clock = run_.options.clock;
    timing.observe = [](std::int64_t, std::int64_t, const std::string&) { return !interrupted(); };
    for (Sampled& own : sampled_) {
      if (own.wanted <= round) continue;
      progress.update(done_, own.row->setting.name());
      const auto timings = measure::time_interleaved({own.contender}, timing);
      if (timings.empty() || interrupted()) stop_interrupted();
      if (timings.front().failed) own.row->fault = "diverged while it was timed";
      own.seconds.push_back(timings.front().seconds.median);
      done_ += cost(*own.row);
    }
  }

  void finish() {
    const double dt = run_.table.dt;
    const double duration = run_.table.simulated_seconds;
    for (Sampled& own : sampled_) {
      for (double& seconds : own.seconds) seconds /= dt;
      own.row->seconds = measure::spread_of(own.seconds);
      own.row->timed_alone = true;
    }
    for (TradeRow& row : run_.table.rows) {
      if (!row.measured() || row.timed_alone) continue;
      row.seconds = measure::spread_of({row.run_seconds / duration});
    }
  }

  TradeRun& run_;
  TimeLimit limit_;
  std::vector<Sampled> sampled_;
  double done_ = 0.0;
};

}  // namespace

int TradeRun::threads() const { return options.threads > 0 ? options.threads : core_count(); }

void stop_interrupted() { throw Failure(ExitCode::interrupted, "interrupted"); }

std::string no_time_text(double expected, double left) {
  return fmt::format("takes about {}, and {} are left", duration_text(expected),
                     duration_text(left));
}

void measure_errors(TradeRun& run) {
  ErrorStage stage(run);
  if (!stage.empty()) stage.measure();
}

void measure_times(TradeRun& run) {
  if (run.journal.restore_times(run.table.rows)) return;
  if (TimeStage(run).measure()) run.journal.keep_times(run.table.rows);
}

TradeTable measure_trade(const Scene& scene, const TradeOptions& options) {
  TradeTable table;
  table.scene = scene.name;
  table.dt = scene.model.step.dt;
  table.simulated_seconds = table.dt * static_cast<double>(measure::frame_count(scene));
  table.machine = machine_info();
  table.version = version_string;
  table.repetitions = options.repetitions;
  table.most_minutes = options.minutes;
  for (TradeSetting& setting : trade_settings(options.grid, scene)) {
    table.rows.emplace_back().setting = std::move(setting);
  }
  TradeRun run(scene, options, table);
  plan_trade(run);
  make_reference(run);
  measure_errors(run);
  measure_times(run);
  judge(table);
  if (options.ladder) climb_ladder(run);
  return table;
}

}  // namespace sheave::command
