#pragma once
// The files of a run. One that fails does not take the others with it.

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
  /// Creates the tables and the state file (`state_path` empty: none); a Failure if one cannot be
  /// created. `other_output`: whether a run is of use even if all tables fail.
  RunFiles(const RecordOptions& tables, const std::string& state_path, bool other_output,
           const Simulation& simulation);

  /// To be called at the start and after every step. False if there is nothing left that a further
  /// step would be for.
  bool observe(const Simulation& simulation, Progress& progress);

  /// Runs `action`; what has been recorded is kept if it throws.
  template <class Action>
  auto keep_on_throw(const Action& action) {
    try {
      return action();
    } catch (...) {
      recorder_.finish();
      throw;
    }
  }

  /// Puts everything in place, the state where the run stopped unless that means nothing.
  void finish(const State& state, RunStatus status);

  /// What became of them, after finish().
  [[nodiscard]] const std::vector<OutputSummary>& summary() const { return outputs_; }
  [[nodiscard]] OutputFaults& faults() { return faults_; }

 private:
  StateOrigin origin_;  // found while there are no files yet that could be left behind
  Recorder recorder_;
  std::optional<OutputFile> state_;
  bool other_output_;
  std::set<const RecordedTable*> told_;
  std::vector<OutputSummary> outputs_;
  OutputFaults faults_;
};

}  // namespace sheave::command
