#include "command/sweep/row_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "command/failure.h"
#include "command/run/player.h"
#include "command/run/simulate.h"
#include "scenes/check.h"

namespace sheave::command {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// A message in one line, for a table.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Runs one row; a fault is stored in the row.
class RowRun {
 public:
  RowRun(const SweepOptions& options, std::atomic<double>& done) : options_(options), done_(done) {}

  /// False if a signal ended the run.
  bool run(SweepRow& row) {
    row.measured.assign(options_.measures.size(), no_number);
    row.doubt = no_number;
    double counted = 0.0;
    const bool ended = attempt(row, counted);
    done_ += 1.0 - counted;
    return ended;
  }

 private:
  bool attempt(SweepRow& row, double& counted) {
    try {
      Scene scene = load(with_values(options_, row.values));
      if (options_.kind == SweepKind::run) return simulate_row(std::move(scene), row, counted);
      measure_at_rest(options_, std::move(scene), row);
    } catch (const Failure& failure) {
      // An unreadable file is not a fault of these values, so the sweep ends.
      const bool no_rest = failure.code() == ExitCode::diverged;
      if (failure.code() != ExitCode::bad_scene && failure.code() != ExitCode::usage && !no_rest) {
        throw;
      }
      row.status = no_rest ? SweepStatus::no_rest : SweepStatus::invalid;
      row.message = one_line(failure.what());
    }
    return true;
  }

  bool simulate_row(Scene scene, SweepRow& row, double& counted) {
    scene.checks.clear();
    for (const SweepMeasure& measure : options_.measures) scene.checks.push_back(measure.course);
    Simulation simulation = make_simulation(scene);
    CheckRecorder recorder(scene, simulation);
    const std::int64_t steps = step_count(scene);
    Progress none("", 0.0, 1.0, true);
    const auto observe = [&](const RunStatistics&) {
      recorder.record(simulation);
      const double share =
          static_cast<double>(simulation.world.state().steps) / static_cast<double>(steps);
      done_ += share - counted;
      counted = share;
      return true;
    };
    const RunOutcome outcome = simulate(simulation, steps, none, observe, limit());
    if (outcome.status == RunStatus::interrupted) return false;
    judge(outcome, simulation, row);
    if (row.usable()) read_measures(recorder, row);
    return true;
  }

  [[nodiscard]] StopRequest limit() const {
    if (!options_.time_limit) return {};
    return [start = Clock::now(), most = *options_.time_limit] {
      return std::chrono::duration<double>(Clock::now() - start).count() >= most;
    };
  }

  void judge(const RunOutcome& outcome, const Simulation& simulation, SweepRow& row) const {
    row.end = simulation.world.state().time;
    if (outcome.status == RunStatus::time_limit) {
      row.status = SweepStatus::time_limit;
      row.message = "took longer than --time-limit";
      row.end = 0.0;  // the time reached within a time limit depends on the machine
      return;
    }
    if (outcome.status == RunStatus::diverged) {
      row.status = SweepStatus::diverged;
      row.message = one_line(outcome.divergence->message);
      return;
    }
    if (!std::isfinite(simulation.world.energy().total())) {
      row.status = SweepStatus::diverged;
      row.message = "the energy is not finite; the scene's numbers are too large";
      return;
    }
    const CertificateItem* const worst = outcome.certificate.worst();
    if (worst == nullptr) return;
    row.doubt = worst->relative;
    row.doubt_of = certificate_kind_names[static_cast<std::size_t>(worst->kind)];
    if (outcome.certificate.clean(options_.trust)) return;
    row.status = SweepStatus::doubtful;
    row.message = one_line(worst->sentence());
  }

  static void read_measures(const CheckRecorder& recorder, SweepRow& row) {
    const std::vector<CheckResult> results = recorder.results();
    for (std::size_t i = 0; i < results.size(); ++i) {
      row.measured[i] = results[i].measured;
      if (std::isfinite(results[i].measured)) continue;
      add_message(row, results[i].message);
    }
  }

  const SweepOptions& options_;
  std::atomic<double>& done_;
};

}  // namespace

SceneOptions with_values(const SweepOptions& options, const std::vector<std::string>& values) {
  SceneOptions own = options.scene;
  own.warns = false;  // other settings than those of the state are the purpose of a sweep
  own.tells_strains = false;
  for (std::size_t a = 0; a < values.size(); ++a) {
    for (const SweepSetting& setting : options.plan.axes[a].settings_of(values[a])) {
      (setting.is_parameter() ? own.parameters : own.settings)
          .push_back(setting.name + "=" + setting.value);
    }
  }
  return own;
}

void add_message(SweepRow& row, const std::string& text) {
  row.message += (row.message.empty() ? "" : "; ") + one_line(text);
}

bool do_row(const SweepOptions& options, SweepRow& row, std::atomic<double>& done) {
  return RowRun(options, done).run(row);
}

}  // namespace sheave::command
