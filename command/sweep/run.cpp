#include "command/sweep/run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/content_hash.h"
#include "command/input/file.h"
#include "command/input/state_file.h"
#include "command/interrupt.h"
#include "command/parallel.h"
#include "command/run/player.h"
#include "command/run/simulate.h"
#include "command/sweep/journal.h"
#include "scenes/check.h"
#include "scenes/json/document.h"
#include "scenes/quantity_list.h"

namespace sheave::command {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// A message in one line, for a table.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// The scene with the values of a run.
SceneOptions with_values(const SweepOptions& options, const std::vector<std::string>& values) {
  SceneOptions own = options.scene;
  own.warns = false;  // other settings than those of the state are the purpose of a sweep
  for (std::size_t a = 0; a < values.size(); ++a) {
    const SweepAxis& axis = options.plan.axes[a];
    (axis.is_setting() ? own.settings : own.parameters).push_back(axis.name + "=" + values[a]);
  }
  return own;
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
    Scene scene;
    std::optional<Simulation> made;
    try {
      scene = load(with_values(options_, row.values));
      scene.checks.clear();
      for (const SweepMeasure& measure : options_.measures) scene.checks.push_back(measure.course);
      made.emplace(make_simulation(scene));
    } catch (const Failure& failure) {
      // An unreadable file is not a fault of these values, so the sweep ends.
      const bool no_rest = failure.code() == ExitCode::diverged;
      if (failure.code() != ExitCode::bad_scene && failure.code() != ExitCode::usage && !no_rest) {
        throw;
      }
      row.status = SweepStatus::invalid;
      row.message = one_line(failure.what());
      return true;
    }
    Simulation& simulation = *made;
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
      row.message += (row.message.empty() ? "" : "; ") + results[i].message;
    }
  }

  const SweepOptions& options_;
  std::atomic<double>& done_;
};

std::string key_of(const SweepOptions& options, const std::vector<std::vector<std::string>>& points,
                   const std::vector<std::string>& scenes) {
  ContentHash hash;
  hash.add(sweep_journal_formats.marked);
  hash.add_program();
  hash.add(*options.scene.text);
  // Includes the settings of the command line, which the scene file does not contain.
  for (const std::string& text :
       {options.scene.dt, options.scene.substeps, options.scene.iterations, options.scene.solver,
        options.scene.integrator, options.scene.duration}) {
    hash.add(text);
  }
  if (!options.scene.load_state.empty()) hash.add(read_state_bytes(options.scene.load_state));
  for (const std::string& setting : options.scene.settings) hash.add(setting);
  for (const std::string& parameter : options.scene.parameters) hash.add(parameter);
  // The hash is of the resulting scenes, so that it covers imports.
  for (const std::string& scene : scenes) hash.add(scene);
  for (const SweepAxis& axis : options.plan.axes) hash.add(axis.name);
  for (const SweepMeasure& measure : options.measures) hash.add(measure.name);
  for (const std::vector<std::string>& point : points) {
    for (const std::string& value : point) hash.add(value);
  }
  hash.add(fmt::format("{} {}", options.trust, options.time_limit.value_or(0.0)));
  return hash.text();
}

std::string unit_of(const CheckDef& course, std::string unit) {
  if (course.statistic == Statistic::rate) unit = unit.empty() ? "1/s" : unit + "/s";
  if (course.statistic == Statistic::integral) unit += unit.empty() ? "s" : " s";
  return unit;
}

/// Fails before hours of runs if a measure exists neither in the first nor in the last run. Fills
/// in the units. Returns the texts of these two scenes.
std::vector<std::string> find_measures(SweepOptions& options,
                                       const std::vector<std::vector<std::string>>& points) {
  std::vector<std::string> faults(options.measures.size());
  std::vector<bool> found(options.measures.size(), false);
  std::optional<Failure> no_scene;
  std::vector<std::string> scenes;
  for (const std::vector<std::string>* point : {&points.front(), &points.back()}) {
    try {
      const Scene scene = load(with_values(options, *point));
      scenes.push_back(write_scene(scene));
      const QuantityIndex quantities(ObservableSet(scene.model, scene.cables));
      for (std::size_t i = 0; i < options.measures.size(); ++i) {
        SweepMeasure& measure = options.measures[i];
        const Result<Expression> quantity = quantities.compile(measure.course.quantity);
        if (quantity) {
          found[i] = true;
          measure.unit = unit_of(measure.course, quantity->unit().text());
        } else {
          faults[i] = to_text(quantity.errors());
        }
      }
    } catch (const Failure& failure) {
      no_scene = failure;
    }
  }
  if (scenes.empty()) throw Failure(*no_scene);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) continue;
    throw Failure(ExitCode::usage, "--measure " + options.measures[i].name + ": " + faults[i]);
  }
  return scenes;
}

std::string counted_text(const SweepTable& table, std::size_t wanted, const std::string& journal) {
  std::string text =
      fmt::format("interrupted; {} of {} runs have ended", table.rows.size(), wanted);
  return text + (journal.empty() ? ", and are lost without --resume FILE"
                                 : "; the same command resumes with " + journal);
}

}  // namespace

SweepTable run_sweep(SweepOptions options) {
  if (options.scene.path == "-") {
    throw Failure(ExitCode::usage, "a sweep needs a scene file, not standard input");
  }
  const auto points = sweep_points(options.plan);
  options.scene.text = read_input(options.scene.path, json::Limits{}.bytes);
  const std::vector<std::string> scenes = find_measures(options, points);
  SweepTable table;
  SweepHead& head = table.head;
  head.key = key_of(options, points, scenes);
  head.scene = options.scene.path;
  for (const SweepAxis& axis : options.plan.axes) head.axes.push_back(axis.name);
  head.measures = options.measures;
  head.runs = points.size();
  head.shard = options.shard;

  SweepJournal journal(options.journal, head, table.rows);
  std::vector<bool> known(points.size(), false);
  for (const SweepRow& row : table.rows) known[row.run] = true;
  std::vector<std::size_t> runs;
  std::size_t wanted = 0;
  for (std::size_t run = 0; run < points.size(); ++run) {
    if (!options.shard.has(run)) continue;
    ++wanted;
    if (!known[run]) runs.push_back(run);
  }

  std::atomic<double> done = 0.0;
  std::atomic<std::size_t> ended = table.rows.size();
  std::mutex mutex;  // guards the journal and the rows
  {
    Progress progress("sweep", 0.0, static_cast<double>(runs.size()), options.quiet);
    run_parallel(
        runs.size(), options.threads > 0 ? options.threads : core_count(),
        [&](std::size_t i) {
          if (interrupted()) return;
          SweepRow row;
          row.run = runs[i];
          row.values = points[runs[i]];
          if (!RowRun(options, done).run(row)) return;
          const std::lock_guard lock(mutex);
          journal.keep(row);
          table.rows.push_back(std::move(row));
          ++ended;
        },
        [&] { progress.update(done, fmt::format("{} of {} runs", ended.load(), wanted)); });
  }
  journal.finish();
  std::sort(table.rows.begin(), table.rows.end(),
            [](const SweepRow& a, const SweepRow& b) { return a.run < b.run; });
  if (interrupted() && table.rows.size() < wanted) {
    throw Failure(ExitCode::interrupted, counted_text(table, wanted, options.journal));
  }
  return table;
}

}  // namespace sheave::command
