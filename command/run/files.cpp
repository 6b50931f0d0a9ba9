#include "command/run/files.h"

#include "command/terminal.h"
#include "scenes/saved_state.h"

namespace sheave::command {

RunFiles::RunFiles(const RecordOptions& tables, const std::string& state_path, bool other_output,
                   const Simulation& simulation)
    : origin_(state_path.empty() ? StateOrigin{} : origin_of(simulation)),
      recorder_(tables, simulation),
      other_output_(other_output) {
  if (!state_path.empty()) state_.emplace(state_path);
}

bool RunFiles::observe(const Simulation& simulation, Progress& progress) {
  if (recorder_.observe(simulation)) return true;
  progress.clear();
  // Reports a fault immediately: the run may take hours.
  for (const RecordedTable& table : recorder_.tables()) {
    if (!table.complete() && told_.insert(&table).second) print_warning(table.fault);
  }
  return other_output_ || recorder_.is_writing();
}

void RunFiles::finish(const State& state, RunStatus status) {
  faults_.attempt([&] { recorder_.finish(); });
  for (const RecordedTable& table : recorder_.tables()) {
    if (!table.complete()) faults_.add(table.fault);
    outputs_.push_back({OutputSummary::Kind::table, table.path, table.rows, table.fault});
  }
  if (!state_ || status == RunStatus::diverged) return;
  OutputSummary saved{OutputSummary::Kind::state, state_->path(), 0, {}};
  try {
    state_->write(to_bytes(state, origin_));
    state_->commit();
  } catch (const Failure& failure) {
    saved.fault = failure.what();
    faults_.add(saved.fault);
  }
  outputs_.push_back(std::move(saved));
}

}  // namespace sheave::command
