#pragma once
// sheave sweep: running the plan.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command/run/checker.h"
#include "command/scene_options.h"
#include "command/sweep/table.h"

namespace sheave::command {

struct SweepOptions {
  SceneOptions scene;
  SweepPlan plan;
  SweepKind kind = SweepKind::run;
  std::vector<SweepMeasure> measures;
  SweepShard shard;
  std::string journal;                 ///< file of --resume; empty: no journal
  int threads = 0;                     ///< number of threads; 0: one per core
  double trust = default_trust;        ///< as in `sheave run`
  std::optional<double> time_limit{};  ///< wall time of one run [s]
  bool quiet = false;
};

/// Runs all rows that are missing in the journal, on all cores. A row depends only on its values. A
/// Failure: 2 or 65 if no run can be started or a measure does not exist, 130 on a signal; rows
/// completed by then are in the journal.
[[nodiscard]] SweepTable run_sweep(SweepOptions options);

}  // namespace sheave::command
