#include "command/sweep/run.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/interrupt.h"
#include "command/parallel.h"
#include "command/progress.h"
#include "command/sweep/journal.h"
#include "command/sweep/row_run.h"
#include "scenes/json/document.h"

namespace sheave::command {
namespace {

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
  head = head_of(options);
  head.key = key_of(options, points, scenes);
  head.runs = points.size();

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
          if (!do_row(options, row, done)) return;
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
