#pragma once
// The files of a run. One failing file does not prevent the others.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "command/output/faults.h"
#include "command/output/file.h"
#include "command/run/recorder.h"
#include "command/run/summary.h"

namespace sheave::command {

class RunFiles {
 public:
  /// Creates the tables and the state file (`state_path` empty: none). A Failure if one cannot be
  /// created. `other_output`: whether a run is useful even if all tables fail.
  RunFiles(const RecordOptions& tables, const std::string& state_path, bool other_output,
           const Simulation& simulation);

  /// To be called at the start and after every step. False if no output needs a further step.
  bool observe(const Simulation& simulation, Progress& progress);

  /// Runs `action`. If it throws, the data recorded so far is saved.
  template <class Action>
  auto keep_on_throw(const Action& action) {
    try {
      return action();
    } catch (...) {
      recorder_.finish();
      throw;
    }
  }

  /// Moves all files to their destinations. The state is written unless it is meaningless.
  void finish(const State& state, RunStatus status);

  /// The outcome of each file; valid after finish().
  [[nodiscard]] const std::vector<OutputSummary>& summary() const { return outputs_; }
  [[nodiscard]] OutputFaults& faults() { return faults_; }

 private:
  StateOrigin origin_;  // determined before any file exists that a fault could leave behind
  Recorder recorder_;
  std::optional<OutputFile> state_;
  bool other_output_;
  std::set<const RecordedTable*> told_;
  std::vector<OutputSummary> outputs_;
  OutputFaults faults_;
};

}  // namespace sheave::command
