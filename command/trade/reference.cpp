// sheave trade: the predicted costs of runs, and the reference for all errors.

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <tuple>
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

/// A reference is good enough if its error is a hundredth of the smallest error level of the
/// report.
constexpr double reference_goal = 1e-6;
/// A reference with an error above a tenth of the largest level cannot judge the whole run.
constexpr double useless_reference = 1e-3;
/// Such a reference judges the frames up to which its error is below this bound.
constexpr double trusted_level = 1e-4;
/// Largest number of halvings of the reference's step beyond the finest setting.
constexpr int most_doublings = 6;

/// Shares of the total time after which no finer run is begun, and after which a running one is
/// given up.
constexpr double reference_share = 0.2;
constexpr double reference_end = 0.4;
/// Share of the total time for one prediction of a run's cost.
constexpr double pilot_share = 0.002;
/// Factor by which the substeps of a reference are reduced if it was not completed in time.
constexpr int coarser = 4;

/// CPU time of a whole run [s], predicted from its first frames; 0 if the run fails.
double pilot_seconds(const TradeSetting& setting, const Scene& scene, double enough,
                     const measure::Clock& clock) {
  const Result<measure::Contender> contender =
      measure::scene_contender("", setting.applied(scene), interrupted);
  if (!contender) return 0.0;
  const double start = clock.cpu();
  std::int64_t frames = 0;
  double seconds = 0.0;
  while (frames < contender->frames && seconds < enough) {
    const bool good = contender->frame();
    ++frames;
    seconds = clock.cpu() - start;
    if (!good) break;
  }
  return seconds * static_cast<double>(contender->frames) / static_cast<double>(frames);
}

/// The cost of runs: one part per substep and, for gauss-seidel, one per sweep; for each solver,
/// integrator and tangent update. Each tolerance has a cost of its own.
class CostModel {
 public:
  /// `enough`: CPU time for one prediction [s]; at least one frame is run.
  CostModel(const Scene& scene, double enough, const measure::Clock& clock)
      : scene_(scene), enough_(enough), clock_(clock) {}

  double seconds(const TradeSetting& setting) {
    const StepSettings& step = setting.step;
    if (step.tolerance > 0.0) return pilot_seconds(setting, scene_, enough_, clock_);
    const auto key = std::tuple(step.solver, step.integrator, setting.tangents);
    auto found = parts_.find(key);
    if (found == parts_.end()) found = parts_.emplace(key, measured(setting)).first;
    const auto& [base, sweep] = found->second;
    return step.substeps * (base + sweep * step.iterations);
  }

 private:
  [[nodiscard]] std::array<double, 2> measured(TradeSetting setting) const {
    setting.step.substeps = 1;
    if (setting.step.solver == SolverKind::direct)
      return {pilot_seconds(setting, scene_, enough_, clock_), 0.0};
    constexpr int few = 1;
    constexpr int more = 11;
    setting.step.iterations = few;
    const double first = pilot_seconds(setting, scene_, enough_, clock_);
    setting.step.iterations = more;
    const double second = pilot_seconds(setting, scene_, enough_, clock_);
    const double sweep = std::max(0.0, (second - first) / (more - few));
    return {std::max(0.0, first - few * sweep), sweep};
  }

  using Key = std::tuple<SolverKind, IntegratorKind, std::optional<TangentUpdate>>;
  const Scene& scene_;
  double enough_;
  const measure::Clock& clock_;
  std::map<Key, std::array<double, 2>> parts_;
};

/// Number of frames in which a reference can judge.
std::size_t known_frames(const measure::Reference& reference, double dt) {
  if (reference.estimate.position <= useless_reference) return reference.differences.size();
  return measure::error_growth(reference.differences, dt, trusted_level).trusted_frames;
}

/// The kinds of references, in the order of preference.
enum ReferenceKind : std::size_t { by_rattle, by_tolerance, by_xpbd, reference_kinds };
using References = std::array<Result<measure::Reference>, reference_kinds>;

/// Selects the first reference that is good. Otherwise the one that is valid for longest is
/// selected, and of those that are valid equally long the one with the smallest error. (In a chaotic
/// scene the estimate at the end has no meaning: more damping by the integrator makes it smaller.)
measure::Reference choose(References& references, double dt) {
  Result<measure::Reference>* best = nullptr;
  std::size_t best_known = 0;
  for (Result<measure::Reference>& own : references) {
    if (!own) continue;
    if (own->good) return std::move(own).value();
    const std::size_t known = known_frames(*own, dt);
    const bool better =
        best == nullptr || known > best_known ||
        (known == best_known && own->estimate.position < (*best)->estimate.position);
    if (!better) continue;
    best = &own;
    best_known = known;
  }
  if (best == nullptr) {
    throw Failure(ExitCode::diverged, to_text(references[by_rattle].errors()));
  }
  return std::move(*best).value();
}

/// Tolerances of the reference: quarters, from a thousandth of the scene's size to a millionth,
/// which is the least that a scene allows.
void set_reference_tolerance(const TradeRun& run, measure::ReferenceOptions& options) {
  constexpr double least = 1e-6;
  constexpr double first =
      1.001 * 1024.0 * least;  // a little more, so that rounding does not count
  options.first_tolerance = tolerance_of({first, true}, run.scene);
  options.least_tolerance = tolerance_of({least, true}, run.scene);
}

/// Two runs with fixed substeps may meet an event in the same substep and seem to be right. A run
/// with a tolerance locates it, so a reference that differs from such a run is off by the difference.
void compare_references(References& references) {
  Result<measure::Reference>& fixed = references[by_rattle];
  Result<measure::Reference>& located = references[by_tolerance];
  if (!located) return;
  const measure::Reference& other = *located;
  if (!fixed || !fixed->trajectory.complete()) return;
  const measure::RunError between = measure::error_of(fixed->trajectory, other.trajectory);
  if (between.position <= fixed->estimate.position + other.estimate.position) return;
  fixed->estimate.position = between.position;
  fixed->estimate.position_end = std::max(fixed->estimate.position_end, between.position_end);
  fixed->estimate.tension = std::max(fixed->estimate.tension, between.tension);
  fixed->differences = measure::position_errors(fixed->trajectory, other.trajectory);
  fixed->good = between.position <= reference_goal;
}

/// Computes all references in parallel; that of `xpbd` is given up if another one is good. nullopt
/// if the time was too short.
std::optional<measure::Reference> all_references(TradeRun& run) {
  const double limit =
      std::min(run.options.reference_seconds, reference_share * run.limit.seconds());
  Progress progress("reference, at most", 0.0, 1.0, run.options.quiet);
  const TimeLimit end = run.limit.part(reference_end);
  std::atomic<bool> good = false;  // one of the first two is
  References results{Error{"", "not run"}, Error{"", "not run"}, Error{"", "not run"}};
  const bool tolerates = !run.options.grid.tolerances.empty();
  const auto make = [&](std::size_t i) {
    measure::ReferenceOptions options;
    options.integrator = i == by_xpbd ? IntegratorKind::xpbd : IntegratorKind::rattle;
    if (i == by_tolerance) set_reference_tolerance(run, options);
    options.first_substeps = run.first_substeps;
    options.most_substeps = std::min(options.first_substeps, 100'000 >> most_doublings)
                            << most_doublings;
    options.most_seconds = limit;
    options.clock = run.options.clock;
    options.good_enough = [](const measure::Reference& reference) {
      return reference.estimate.position <= reference_goal;
    };
    options.stop = [&, i] {
      return interrupted() || (i == by_xpbd && good) || !(end.left() > 0.0);
    };
    options.observe = [&](std::int64_t, std::int64_t) { return !options.stop(); };
    if ((i == by_xpbd && good) || (i == by_tolerance && !tolerates)) return;
    results[i] = measure::reference_run(run.scene, options);
    if (i != by_xpbd && results[i] && results[i]->good) good = true;
  };
  run_parallel(reference_kinds, run.threads(), make,
               [&] { progress.update(1.0 - end.left() / end.seconds(), ""); });
  if (interrupted()) stop_interrupted();
  const bool none = std::none_of(results.begin(), results.end(),
                                 [](const Result<measure::Reference>& own) { return own.ok(); });
  if (none && end.left() <= 0.0) return {};
  compare_references(results);
  return choose(results, run.table.dt);
}

measure::Reference new_reference(TradeRun& run) {
  while (true) {
    if (std::optional<measure::Reference> made = all_references(run)) return std::move(*made);
    if (run.first_substeps == 1) break;
    run.first_substeps = std::max(1, run.first_substeps / coarser);
  }
  throw Failure(ExitCode::check_failed,
                fmt::format("two runs of the reference, with 1 and 2 substeps, take more than {:g} "
                            "minutes allow; give more with --minutes",
                            run.options.minutes));
}

/// Limits the comparison to the time in which the reference is valid. If that is time 0 only, the
/// whole run is compared, and the reference's error shows that the comparison has no meaning.
void limit_comparison(TradeRun& run) {
  TradeTable& table = run.table;
  const std::vector<double>& differences = table.reference.differences;
  if (table.doubt.position <= useless_reference || differences.empty()) return;
  table.chaos_rate = measure::error_growth(differences, table.dt, trusted_level).rate;
  const std::size_t known = known_frames(table.reference, table.dt);
  if (known < 2) return;
  run.frames = known;
  table.compared_seconds = table.dt * static_cast<double>(run.frames - 1);
  table.doubt.position =
      *std::max_element(differences.begin(), differences.begin() + static_cast<long>(run.frames));
  table.doubt.position_end = differences[run.frames - 1];
}

/// Repeats the finest run of a reference from the journal.
void repeat_reference(TradeRun& run) {
  TradeSetting setting;
  const measure::Reference& known = run.table.reference;
  setting.step = {run.table.dt,       known.substeps,   measure::ReferenceOptions{}.rounds,
                  SolverKind::direct, known.integrator, known.tolerance};
  const auto frames = static_cast<double>(measure::frame_count(run.scene));
  Progress progress("reference, again", 0.0, frames, run.options.quiet);
  Result<measure::Trajectory> again = measure::record(
      setting.applied(run.scene),
      [&](std::int64_t done, std::int64_t) {
        progress.update(static_cast<double>(done), "");
        return !interrupted();
      },
      interrupted);
  if (interrupted()) stop_interrupted();
  if (!again || !again->complete()) {
    throw Failure(ExitCode::bad_scene,
                  "--resume " + run.options.resume +
                      ": the reference of this file cannot be run; the file may have been changed");
  }
  run.truth = std::move(again).value();
}

/// Why a setting cannot be compared with the reference; empty: it can.
std::string finer_text(const StepSettings& step, const measure::Reference& reference) {
  const bool tolerates = reference.tolerance > 0.0;
  if (tolerates && step.tolerance > 0.0 && step.tolerance < reference.tolerance) {
    return fmt::format("finer than the reference that the time allows ({:.3g} m)",
                       reference.tolerance);
  }
  if (tolerates || step.tolerance > 0.0 || step.substeps <= reference.substeps) return {};
  return fmt::format("finer than the reference that the time allows ({} substeps)",
                     reference.substeps);
}

bool needs_truth(TradeRun& run) {
  return std::any_of(run.table.rows.begin(), run.table.rows.end(),
                     [&](TradeRow row) { return row.measured() && !run.journal.restore(row); });
}

}  // namespace

void plan_trade(TradeRun& run) {
  CostModel model(run.scene, pilot_share * run.limit.seconds(), run.options.clock);
  for (TradeRow& row : run.table.rows) {
    if (interrupted()) stop_interrupted();
    row.expected_seconds = model.seconds(row.setting);
  }
  // At least two runs of the reference, with s and 2 s substeps, should fit into its share.
  const std::vector<int>& substeps = run.options.grid.substeps;
  run.first_substeps = *std::max_element(substeps.begin(), substeps.end());
  TradeSetting finest = run.table.rows.front().setting;
  double expected = 0.0;  // of one substep with the cheaper integrator
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    finest.step = {run.table.dt, 1, measure::ReferenceOptions{}.rounds, SolverKind::direct,
                   integrator};
    const double own = model.seconds(finest);
    expected = expected > 0.0 ? std::min(expected, own) : own;
  }
  const double share = reference_share * run.limit.seconds();
  while (run.first_substeps > 1 && 3.0 * run.first_substeps * expected > share) {
    run.first_substeps /= 2;
  }
}

void make_reference(TradeRun& run) {
  TradeTable& table = run.table;
  auto known = run.journal.reference();
  if (known) {
    std::tie(table.reference, table.motion) = std::move(*known);
  } else {
    table.reference = new_reference(run);
    run.truth = std::exchange(table.reference.trajectory, {});
  }
  table.doubt = table.reference.estimate;
  table.compared_seconds = table.simulated_seconds;
  limit_comparison(run);
  if (!known) {
    const std::size_t frames = run.frames > 0 ? run.frames : run.truth.frames.size();
    table.motion = measure::motion_of(measure::first_frames(run.truth, frames));
    run.journal.keep(table.reference, table.motion);
  }
  for (TradeRow& row : table.rows) {
    row.skipped = finer_text(row.setting.step, table.reference);
  }
  if (run.truth.frames.empty() && needs_truth(run)) repeat_reference(run);
}

}  // namespace sheave::command
