// sheave trade: the model ladder. The scene and its rungs are run with one setting, so that only
// the model differs. The errors due to the step and the tolerance are about equal in both runs and
// cancel in the difference.

#include <algorithm>
#include <atomic>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/interrupt.h"
#include "command/parallel.h"
#include "command/progress.h"
#include "command/trade/measure.h"
#include "measure/scene_contender.h"
#include "measure/timing.h"

namespace sheave::command {
namespace {

/// If the error of the scene as written exceeds this bound, the effect of a rung cannot be
/// distinguished from the errors of the setting.
constexpr double useless_setting = 0.1;

/// The cheapest setting with an error of 0.1 %, or the most accurate setting.
std::optional<std::size_t> ladder_setting(const TradeTable& table) {
  constexpr double wanted = 1e-3;
  if (const auto cheapest = answer(table, {.error = wanted})) return cheapest;
  const std::vector<measure::WorkPoint> points = table.points();
  const std::vector<std::size_t> front = measure::pareto_front(points);
  return front.empty() ? std::nullopt : std::optional(front.back());
}

/// A scene of the ladder: the scene as written, or a rung.
struct Variant {
  LadderRow row;
  Scene scene;
  std::optional<measure::Trajectory> run{};
};

class Ladder {
 public:
  Ladder(TradeRun& run, std::size_t setting) : run_(run), chosen_(run.table.rows[setting]) {
    ladder_.setting = chosen_.setting;
    ladder_.setting_error = chosen_.error.position + run.table.doubt.position;
  }

  TradeLadder climb() {
    if (!(ladder_.setting_error <= useless_setting)) {
      ladder_.skipped = fmt::format("no setting has an error that is known to be below {:g} %",
                                    100.0 * useless_setting);
      return std::move(ladder_);
    }
    find_rungs();
    const double expected = chosen_.run_seconds * static_cast<double>(valid_.size());
    const double errors = expected / run_.threads();
    if (const double left = run_.limit.left(); expected + errors > left) {
      ladder_.skipped = no_time_text(expected + errors, left);
      return std::move(ladder_);
    }
    run_all();
    time_all(expected);
    collect();
    return std::move(ladder_);
  }

 private:
  void find_rungs() {
    const Scene written = chosen_.setting.applied(run_.scene);
    variants_.push_back({{}, written});
    for (const measure::ModelRung& rung : measure::model_rungs()) {
      measure::RungScene made = measure::on_rung(rung, written);
      if (made.changed == 0) {
        ladder_.absent.push_back(rung.name);
        continue;
      }
      LadderRow row{rung.name, rung.things, rung.change, made.changed, {}};
      if (!made.faults.empty()) row.fault = "no valid scene: " + made.faults.front().message;
      variants_.push_back({std::move(row), std::move(made.scene)});
    }
    for (Variant& variant : variants_) {
      if (variant.row.fault.empty()) valid_.push_back(&variant);
    }
  }

  void run_all() {
    const auto frames = measure::frame_count(run_.scene);
    const auto all = static_cast<std::int64_t>(valid_.size()) * frames;
    std::atomic<std::int64_t> done = 0;
    Progress progress("ladder", 0.0, static_cast<double>(all), run_.options.quiet);
    run_parallel(
        valid_.size(), run_.threads(),
        [&](std::size_t i) {
          if (!interrupted()) run_one(*valid_[i], done);
        },
        [&] { progress.update(static_cast<double>(done), ""); });
    if (interrupted()) stop_interrupted();
  }

  void run_one(Variant& variant, std::atomic<std::int64_t>& done) const {
    bool late = false;
    const StopRequest stop = [&] {
      late = late || run_.limit.left() < 0.0;
      return late || interrupted();
    };
    const auto observe = [&](std::int64_t, std::int64_t) {
      ++done;
      return !stop();
    };
    Result<measure::Trajectory> own = measure::record(variant.scene, observe, stop);
    if (late) {
      variant.row.fault = "no time left";
    } else if (!own) {
      variant.row.fault = to_text(own.errors());
    } else if (!own->complete()) {
      variant.row.fault = "diverged: " + own->divergence->message;
    } else {
      variant.run = std::move(own).value();
    }
  }

  /// Takes as many interleaved samples as the time allows; `expected`: CPU time of one sample of
  /// each.
  void time_all(double expected) {
    std::erase_if(valid_, [](const Variant* variant) { return !variant->run; });
    std::vector<measure::Contender> contenders;
    for (const Variant* variant : valid_) {
      Result<measure::Contender> contender =
          measure::scene_contender(variant->row.name, variant->scene, interrupted);
      // The scene has been run before, so a failure here is an internal error.
      if (!contender) throw Failure(ExitCode::internal, to_text(contender.errors()));
      contenders.push_back(std::move(contender).value());
    }
    const double left = std::max(0.0, run_.limit.left());
    const int fit = static_cast<int>(std::min(1e6, left / std::max(expected, 1e-6)));
    measure::TimingOptions timing;
    timing.clock = run_.options.clock;
    timing.repetitions = std::clamp(fit, 1, run_.options.repetitions);
    if (timing.repetitions < run_.options.repetitions) {
      run_.table.limits.push_back(fmt::format("ladder: {} of {} repetitions", timing.repetitions,
                                              run_.options.repetitions));
    }
    Progress progress("ladder, times", 0.0,
                      static_cast<double>(contenders.size()) * timing.repetitions,
                      run_.options.quiet);
    timing.observe = [&](std::int64_t done, std::int64_t, const std::string& name) {
      progress.update(static_cast<double>(done), name);
      return !interrupted();
    };
    const std::vector<measure::Timing> timings = measure::time_interleaved(contenders, timing);
    if (timings.size() != contenders.size() || interrupted()) stop_interrupted();
    const double dt = run_.table.dt;
    for (std::size_t i = 0; i < timings.size(); ++i) {
      const measure::Spread& frame = timings[i].seconds;
      valid_[i]->row.seconds = {frame.median / dt, frame.lower / dt, frame.upper / dt,
                                frame.minimum / dt, frame.count};
    }
  }

  void collect() {
    Variant& written = variants_.front();
    if (!written.run) {
      ladder_.skipped = written.row.fault;
      return;
    }
    ladder_.seconds = written.row.seconds;
    const double duration = run_.table.simulated_seconds;
    ladder_.row_solves = static_cast<double>(written.run->row_solves) / duration;
    const std::size_t frames = run_.frames > 0 ? run_.frames : written.run->frames.size();
    const measure::Trajectory compared = measure::first_frames(*written.run, frames);
    for (std::size_t i = 1; i < variants_.size(); ++i) {
      Variant& variant = variants_[i];
      if (variant.run) {
        variant.row.difference =
            measure::model_difference(measure::first_frames(*variant.run, frames), compared);
        variant.row.row_solves = static_cast<double>(variant.run->row_solves) / duration;
      }
      ladder_.rows.push_back(std::move(variant.row));
    }
  }

  TradeRun& run_;
  const TradeRow& chosen_;
  TradeLadder ladder_;
  std::vector<Variant> variants_;  // [0] is the scene as written
  std::vector<Variant*> valid_;
};

}  // namespace

void climb_ladder(TradeRun& run) {
  TradeTable& table = run.table;
  const std::optional<std::size_t> setting = ladder_setting(table);
  if (!setting) {
    table.ladder = TradeLadder{};
    table.ladder->skipped = "no setting has been measured";
    return;
  }
  const TradeRow& chosen = table.rows[*setting];
  if ((table.ladder = run.journal.ladder(chosen.setting))) {
    table.ladder->setting_error = chosen.error.position + table.doubt.position;
    return;
  }
  const std::size_t limits = table.limits.size();
  table.ladder = Ladder(run, *setting).climb();
  if (table.ladder->skipped.empty() && table.limits.size() == limits) {
    run.journal.keep(*table.ladder);
  }
}

}  // namespace sheave::command
