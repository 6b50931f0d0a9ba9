#pragma once
// What a run says at its end.

#include <string>
#include <string_view>
#include <vector>

#include "scenes/check.h"
#include "scenes/scene.h"
#include "tools/run_monitor.h"
#include "tools/simulate.h"

namespace sheave::tools {

/// Something the user should know although the run went on.
struct Warning {
  std::string kind;     ///< for programs: "no_tangent", "solver_fallback", ...
  std::string subject;  ///< column-like name of what it is about, e.g. "rope.2"; may be empty
  std::string message;  ///< one sentence
};

/// All that a summary is made of. The references must outlive it.
struct RunSummary {
  std::string_view scene_path;
  const Scene& scene;
  const Simulation& simulation;
  const RunMonitor& monitor;
  const RunOutcome& outcome;
  std::vector<Warning> warnings;
  bool checked = false;  ///< whether checks were asked for
  std::vector<CheckResult> checks;

  [[nodiscard]] bool checks_passed() const;
};

/// Warnings about the course of a run: spans that had no tangent, wraps that found no place, substeps that the direct
/// solver left to the other one.
[[nodiscard]] std::vector<Warning> collect_warnings(const Simulation& simulation,
                                                    const RunStatistics& statistics);

/// One JSON object in one line, keys as in the documentation. Numbers that are not finite or not
/// known are null.
[[nodiscard]] std::string to_json(const RunSummary& summary);

/// The same for people.
[[nodiscard]] std::string to_text(const RunSummary& summary);
/// The checks alone, one per line.
[[nodiscard]] std::string checks_text(const std::vector<CheckResult>& checks);

/// Wall time per complete step [s]; NaN without any.
[[nodiscard]] double time_per_step(const RunOutcome& outcome);

}  // namespace sheave::tools
