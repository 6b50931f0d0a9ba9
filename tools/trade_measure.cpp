// sheave trade: measuring. The reference, then the error of every setting, then the times of all, interleaved.

#include <algorithm>
#include <limits>
#include <utility>

#include <sheave_version.h>

#include "measure/scene_contender.h"
#include "measure/timing.h"
#include "tools/failure.h"
#include "tools/interrupt.h"
#include "tools/progress.h"
#include "tools/trade_table.h"

namespace sheave::tools {
namespace {

/// A reference is good enough if its error is a hundredth of the smallest that settings are named for.
constexpr double reference_goal = 1e-6;
/// One that is worse than a tenth of the largest cannot judge the whole run...
constexpr double useless_reference = 1e-3;
/// ...but as long as it is known to this.
constexpr double trusted_level = 1e-4;
/// An energy that the reference itself does not know to this has nothing to be compared with: nothing moves.
constexpr double known_energy = 0.1;
/// How often the reference's step is halved beyond the finest setting, at most.
constexpr int most_doublings = 6;

class TradeMeasurement {
 public:
  TradeMeasurement(const Scene& scene, const TradeOptions& options)
      : scene_(scene), options_(options) {}

  TradeTable run() {
    table_.scene = scene_.name;
    table_.dt = scene_.model.step.dt;
    table_.simulated_seconds = table_.dt * static_cast<double>(measure::frame_count(scene_));
    table_.machine = machine_info();
    table_.version = version_string;
    table_.repetitions = options_.repetitions;
    for (TradeSetting& setting : trade_settings(options_.grid, scene_)) {
      table_.rows.emplace_back().setting = std::move(setting);
    }
    make_reference();
    measure_errors();
    measure_times();
    judge(table_);
    return std::move(table_);
  }

 private:
  void make_reference() {
    measure::ReferenceOptions options;
    options.first_substeps =
        *std::max_element(options_.grid.substeps.begin(), options_.grid.substeps.end());
    options.most_substeps = std::min(options.first_substeps, 100'000 >> most_doublings)
                            << most_doublings;
    options.most_seconds = options_.reference_seconds;
    options.good_enough = [](const measure::Reference& reference) {
      return reference.estimate.position <= reference_goal;
    };
    const auto frames = static_cast<double>(measure::frame_count(scene_));
    Progress progress("reference", 0.0, frames, options_.quiet);
    options.observe = observer(progress, 0.0);
    table_.reference = chosen_reference(options);
    truth_ = std::exchange(table_.reference.trajectory, {});
    table_.doubt = table_.reference.estimate;
    table_.compared_seconds = table_.simulated_seconds;
    limit_comparison();
  }

  /// That of `rattle`; if it is not good, that of `xpbd` if it is known for longer, or better all the time. (In a chaotic scene
  /// the estimate at the end tells nothing: there it is the smaller the more the integrator damps.)
  measure::Reference chosen_reference(measure::ReferenceOptions& options) const {
    Result<measure::Reference> second_order = measure::reference_run(scene_, options);
    if (second_order && second_order->good) return std::move(second_order).value();
    options.integrator = IntegratorKind::xpbd;
    Result<measure::Reference> first_order = measure::reference_run(scene_, options);
    if (!first_order && !second_order) {
      throw Failure(ExitCode::diverged, to_text(second_order.errors()));
    }
    if (!first_order) return std::move(second_order).value();
    if (!second_order) return std::move(first_order).value();
    const std::size_t long_known = known_frames(*second_order);
    const std::size_t other = known_frames(*first_order);
    const bool better = other != long_known
                            ? other > long_known
                            : first_order->estimate.position < second_order->estimate.position;
    return better ? std::move(first_order).value() : std::move(second_order).value();
  }

  /// Frames in which a reference can judge.
  [[nodiscard]] std::size_t known_frames(const measure::Reference& reference) const {
    if (reference.estimate.position <= useless_reference) return reference.differences.size();
    return measure::error_growth(reference.differences, table_.dt, trusted_level).trusted_frames;
  }

  /// To the time up to which the reference is known.
  void limit_comparison() {
    const std::vector<double>& differences = table_.reference.differences;
    if (table_.doubt.position <= useless_reference || differences.empty()) return;
    table_.chaos_rate = measure::error_growth(differences, table_.dt, trusted_level).rate;
    frames_ = known_frames(table_.reference);
    table_.compared_seconds = table_.dt * static_cast<double>(frames_ - 1);
    table_.doubt.position =
        *std::max_element(differences.begin(), differences.begin() + static_cast<long>(frames_));
    table_.doubt.position_end = differences[frames_ - 1];
  }

  void measure_errors() {
    const auto frames = static_cast<double>(measure::frame_count(scene_));
    Progress progress("errors", 0.0, frames * static_cast<double>(table_.rows.size()),
                      options_.quiet);
    double begin = 0.0;
    for (TradeRow& row : table_.rows) {
      measure_error(row, observer(progress, begin));
      begin += frames;
    }
  }

  void measure_error(TradeRow& row, const measure::FrameObserver& observe) {
    const Result<measure::Trajectory> run = measure::record(row.setting.applied(scene_), observe);
    if (!run) {
      row.fault = to_text(run.errors());
      return;
    }
    if (!run->complete()) {
      row.fault = "diverged: " + run->divergence->message;
      return;
    }
    row.error = measure::error_of(*run, truth_);
    if (frames_ > 0) {
      const double energy = row.error.energy;
      row.error = measure::error_of(measure::first_frames(*run, frames_),
                                    measure::first_frames(truth_, frames_));
      row.error.energy = energy;
    }
    if (table_.doubt.energy > known_energy) {
      row.error.energy = std::numeric_limits<double>::quiet_NaN();
    }
    if (scene_.cables.empty()) row.error.tension = std::numeric_limits<double>::quiet_NaN();
    row.stretch = run->stretch;
    row.length_error = run->length_error;
    row.row_solves = static_cast<double>(run->row_solves) / table_.simulated_seconds;
    row.fallbacks = run->fallbacks;
  }

  void measure_times() {
    std::vector<measure::Contender> contenders;
    std::vector<TradeRow*> timed;
    for (TradeRow& row : table_.rows) {
      if (!row.measured()) continue;
      Result<measure::Contender> contender =
          measure::scene_contender(row.setting.name(), row.setting.applied(scene_));
      if (!contender) {
        row.fault = to_text(contender.errors());
        continue;
      }
      contenders.push_back(std::move(contender).value());
      timed.push_back(&row);
    }
    const auto samples = static_cast<double>(contenders.size()) * options_.repetitions;
    Progress progress("times", 0.0, samples, options_.quiet);
    measure::TimingOptions timing;
    timing.repetitions = options_.repetitions;
    timing.observe = [&](std::int64_t done, std::int64_t, const std::string& name) {
      progress.update(static_cast<double>(done), name);
      return !interrupted();
    };
    const std::vector<measure::Timing> timings = measure::time_interleaved(contenders, timing);
    if (timings.size() != contenders.size()) stop();
    for (std::size_t i = 0; i < timed.size(); ++i) {
      const measure::Spread& frame = timings[i].seconds;
      timed[i]->seconds = {frame.median / table_.dt, frame.lower / table_.dt,
                           frame.upper / table_.dt, frame.minimum / table_.dt, frame.count};
      if (timings[i].failed) timed[i]->fault = "diverged while it was timed";
    }
  }

  measure::FrameObserver observer(Progress& progress, double begin) const {
    return [&progress, begin](std::int64_t done, std::int64_t) {
      if (progress.due()) progress.update(begin + static_cast<double>(done), "");
      if (interrupted()) stop();
      return true;
    };
  }

  [[noreturn]] static void stop() { throw Failure(ExitCode::interrupted, "interrupted"); }

  const Scene& scene_;
  const TradeOptions& options_;
  measure::Trajectory truth_;
  std::size_t frames_ = 0;  // of both runs that are compared; 0: all
  TradeTable table_;
};

}  // namespace

TradeTable measure_trade(const Scene& scene, const TradeOptions& options) {
  return TradeMeasurement(scene, options).run();
}

}  // namespace sheave::tools
