#pragma once
// sheave sweep: running.

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
  std::vector<SweepMeasure> measures;
  SweepShard shard;
  std::string journal;                 ///< of --resume; empty: nothing is kept
  int threads = 0;                     ///< 0: one per core
  double trust = default_trust;        ///< as of `sheave run`
  std::optional<double> time_limit{};  ///< of one run [s of wall time]
  bool quiet = false;
};

/// Runs what the journal does not have, over the cores. What a row says depends on its values
/// alone. A Failure: 2 or 65 if no run can be begun or nothing measures what is asked for, 130 on a
/// signal; what has ended then is in the journal.
[[nodiscard]] SweepTable run_sweep(SweepOptions options);

}  // namespace sheave::command
