#include "command/tune/tune.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/interrupt.h"
#include "command/progress.h"
#include "command/sweep/journal.h"
#include "command/sweep/row_run.h"
#include "command/text/table.h"
#include "command/tune/task.h"
#include "scenes/json/document.h"

namespace sheave::command {
namespace {

/// The first change of a local search, as a part of each range; smaller after a global search.
constexpr double first_step = 0.2;
constexpr double step_after_global = 0.05;
/// The search aims so much inside a bound, relative to its limit, that rounding does not break it.
constexpr double inside = 1e-6;
/// A bound is active, and a setting at the end of its range, within so many tolerances.
constexpr double near_tolerances = 10.0;
/// Values of the goal that differ less, relative to their size, are the same.
constexpr double flat_part = 1e-9;

/// The runs of a tune, one after the other.
class TuneSearch {
 public:
  TuneSearch(const TuneOptions& options, TuneResult& result, SweepJournal& journal,
             std::vector<SweepRow> known)
      : options_(options),
        result_(result),
        journal_(journal),
        known_(std::move(known)),
        progress_("tune", 0.0, static_cast<double>(options.most_runs), options.rows.quiet) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (known_[i].run != i) foreign_journal(i);
    }
  }

  /// Runs the scene at a place; false at the limit or after a signal.
  bool evaluate(std::span<const double> x, double& f, std::span<double> g) {
    const std::vector<std::string> values = values_at(options_, x);
    auto found = rows_of_values_.find(values);
    if (found == rows_of_values_.end()) {
      if (result_.table.rows.size() >= limit_ || !add_row(values)) return false;
      places_.emplace_back(x.begin(), x.end());
      found = rows_of_values_.emplace(values, places_.size() - 1).first;
    }
    const SweepRow& row = result_.table.rows[found->second];
    if (!is_result(row)) {
      // Worse than everything known, so that the search turns back.
      f = worst_ + std::max(worst_ - least_, 1e-3 * std::abs(worst_) + 1e-12);
      std::fill(g.begin(), g.end(), 1.0);
      return true;
    }
    const bool first = !scale_;
    if (first) scale_ = scale_of(row);
    f = cost(row);
    worst_ = first ? f : std::max(worst_, f);
    least_ = first ? f : std::min(least_, f);
    for (std::size_t b = 0; b < g.size(); ++b) g[b] = excess(row, b);
    return true;
  }

  void set_limit(std::size_t runs) { limit_ = runs; }
  [[nodiscard]] bool interrupted() const { return interrupted_; }

  /// The place of a row.
  [[nodiscard]] Place place_of(std::size_t row) const { return places_[row]; }

 private:
  [[noreturn]] void foreign_journal(std::size_t run) const {
    throw Failure(ExitCode::bad_scene,
                  fmt::format("{}:{}:1: run {} is not the one that this search does there; remove "
                              "the file, or name another",
                              options_.rows.journal, run + 2, run));
  }

  bool add_row(const std::vector<std::string>& values) {
    std::vector<SweepRow>& rows = result_.table.rows;
    if (rows.size() < known_.size()) {
      if (known_[rows.size()].values != values) foreign_journal(rows.size());
      rows.push_back(known_[rows.size()]);
    } else {
      SweepRow row;
      row.run = rows.size();
      row.values = values;
      std::atomic<double> done = 0.0;
      if (command::interrupted() || !do_row(options_.rows, row, done)) {
        interrupted_ = true;
        return false;
      }
      journal_.keep(row);
      rows.push_back(std::move(row));
    }
    take_if_better(rows.size() - 1);
    progress_.update(static_cast<double>(rows.size()), progress_text());
    return true;
  }

  /// Keeps the best row: the least cost among the rows that keep all bounds; before there is one,
  /// the least violation.
  void take_if_better(std::size_t candidate) {
    const SweepRow& row = result_.table.rows[candidate];
    if (!is_result(row)) return;
    if (result_.best) {
      const SweepRow& best = result_.table.rows[*result_.best];
      const double here = std::max(violation_of(options_, row), 0.0);
      const double there = std::max(violation_of(options_, best), 0.0);
      const bool better = here != there ? here < there
                                        : options_.goal.cost(row.measured[0]) <
                                              options_.goal.cost(best.measured[0]);
      if (!better) return;
    }
    result_.best = candidate;
    result_.improved.push_back(candidate);
  }

  [[nodiscard]] std::string progress_text() const {
    std::string text = fmt::format("{} runs", result_.table.rows.size());
    if (result_.best) {
      text += ", best " + short_number(result_.table.rows[*result_.best].measured[0]);
    }
    return text;
  }

  /// The size of the goal's values, by which the search sees numbers near 1.
  [[nodiscard]] double scale_of(const SweepRow& row) const {
    const double size =
        std::abs(options_.goal.sense == TuneGoal::Sense::target && options_.goal.target != 0.0
                     ? options_.goal.target
                     : row.measured[0]);
    return size > 0.0 ? size : 1.0;
  }

  [[nodiscard]] double cost(const SweepRow& row) const {
    const double scaled = options_.goal.cost(row.measured[0]) / *scale_;
    // The square of a distance has no kink at the target.
    return options_.goal.sense == TuneGoal::Sense::target ? scaled * scaled : scaled;
  }

  [[nodiscard]] double excess(const SweepRow& row, std::size_t b) const {
    const TuneBound& bound = options_.bounds[b];
    const double size = bound.limit == 0.0 ? 1.0 : std::abs(bound.limit);
    return bound.excess(row.measured[b + 1]) / size + inside;
  }

  const TuneOptions& options_;
  TuneResult& result_;
  SweepJournal& journal_;
  std::vector<SweepRow> known_;
  Progress progress_;
  std::map<std::vector<std::string>, std::size_t> rows_of_values_;
  std::vector<Place> places_;
  std::optional<double> scale_;
  double worst_ = 0.0;
  double least_ = 0.0;
  bool interrupted_ = false;
  std::size_t limit_ = 0;
};

/// A local search has nothing to start from if its first run has no result.
void check_start(const TuneOptions& options, const SweepRow& row) {
  if (is_result(row)) return;
  std::string values;
  for (std::size_t a = 0; a < row.values.size(); ++a) {
    values +=
        fmt::format("{}{} = {}", a > 0 ? ", " : "", options.rows.plan.axes[a].name, row.values[a]);
  }
  const ExitCode code =
      row.status == SweepStatus::invalid ? ExitCode::bad_scene : ExitCode::diverged;
  throw Failure(code, fmt::format("the run at the start ({}) is {}: {}; --start NAME=VALUE names "
                                  "another start, and --method direct needs none",
                                  values, sweep_status_names[static_cast<std::size_t>(row.status)],
                                  row.message));
}

SearchEnd search(const TuneOptions& options, const Place& start, TuneResult& result,
                 TuneSearch& runs) {
  const auto evaluate = [&](std::span<const double> x, double& f, std::span<double> g) {
    const bool goes_on = runs.evaluate(x, f, g);
    if (goes_on && result.method != TuneMethod::direct && result.table.rows.size() == 1) {
      check_start(options, result.table.rows.front());
    }
    return goes_on;
  };
  SearchSettings settings{result.method, start, first_step, options.tolerance,
                          options.bounds.size()};
  if (result.method == TuneMethod::direct) {
    runs.set_limit(std::max<std::size_t>(options.most_runs / 2, 1));
    const SearchEnd global = search_least(settings, evaluate);
    if (runs.interrupted() || !result.best || options.most_runs < 2) return global;
    const bool smooth = start.size() > 1 && options.bounds.empty();
    settings.method = smooth ? TuneMethod::bobyqa : TuneMethod::cobyla;
    settings.start = runs.place_of(*result.best);
    settings.step = step_after_global;
  }
  runs.set_limit(options.most_runs);
  return search_least(settings, evaluate);
}

bool is_flat(const SweepTable& table) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::size_t count = 0;
  for (const SweepRow& row : table.rows) {
    if (!is_result(row)) continue;
    low = std::min(low, row.measured[0]);
    high = std::max(high, row.measured[0]);
    ++count;
  }
  return count > 1 && high - low <= flat_part * std::max(std::abs(low), std::abs(high));
}

void judge(const TuneOptions& options, SearchEnd end, const TuneSearch& runs, TuneResult& result) {
  if (!result.best) return;
  const SweepRow& best = result.table.rows[*result.best];
  const double near = std::max(near_tolerances * options.tolerance, near_tolerances * inside);
  for (std::size_t b = 0; b < options.bounds.size(); ++b) {
    const TuneBound& bound = options.bounds[b];
    const double size = bound.limit == 0.0 ? 1.0 : std::abs(bound.limit);
    if (std::abs(bound.excess(best.measured[b + 1])) <= near * size) result.active.push_back(b);
  }
  const Place place = runs.place_of(*result.best);
  for (std::size_t a = 0; a < place.size(); ++a) {
    if (place[a] <= options.tolerance || place[a] >= 1.0 - options.tolerance) {
      result.at_end.push_back(a);
    }
  }
  result.end = violation_of(options, best) > 0.0 ? TuneEnd::violated
               : is_flat(result.table)           ? TuneEnd::flat
               : end == SearchEnd::stopped       ? TuneEnd::limit
                                                 : TuneEnd::converged;
}

}  // namespace

TuneResult run_tune(TuneOptions& options) {
  SweepOptions& rows = options.rows;
  if (rows.scene.path == "-") {
    throw Failure(ExitCode::usage, "a tune needs a scene file, not standard input");
  }
  check_axes(options);
  TuneResult result;
  result.method = method_of(options);
  if (result.method == TuneMethod::direct && !options.starts.empty()) {
    throw Failure(ExitCode::usage, "--start: --method direct searches the whole range");
  }
  const Place start = start_of(options);
  rows.scene.text = read_input(rows.scene.path, json::Limits{}.bytes);
  const Place ends(start.size(), 1.0);
  const std::vector<std::string> scenes =
      find_measures(rows, {values_at(options, start), values_at(options, ends)});
  SweepHead& head = result.table.head;
  head = head_of(rows);
  head.key = key_of_tune(options, result.method, start, scenes);
  head.runs = most_tune_runs;
  head.tune = true;

  std::vector<SweepRow> known;
  SweepJournal journal(rows.journal, head, known);
  TuneSearch runs(options, result, journal, std::move(known));
  const SearchEnd end = search(options, start, result, runs);
  journal.finish();
  if (runs.interrupted()) {
    throw Failure(
        ExitCode::interrupted,
        fmt::format("interrupted; {} runs have ended{}", result.table.rows.size(),
                    rows.journal.empty() ? ", and are lost without --resume FILE"
                                         : "; the same command resumes with " + rows.journal));
  }
  if (end == SearchEnd::failed) {
    throw Failure(ExitCode::internal,
                  fmt::format("the method {} gave up after {} runs; --method names another",
                              name_of(result.method), result.table.rows.size()));
  }
  head.runs = result.table.rows.size();
  judge(options, end, runs, result);
  return result;
}

}  // namespace sheave::command
