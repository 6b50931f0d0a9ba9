#pragma once
// The summary at the end of a run.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cable/step_warnings.h"
#include "command/run/checker.h"
#include "command/run/monitor.h"
#include "command/run/rope_wear.h"
#include "command/run/simulate.h"
#include "engine/joint_report.h"
#include "measure/error_estimate.h"
#include "scenes/check.h"
#include "scenes/scene.h"

namespace sheave::command {

/// An event of a run.
struct RunEvent {
  /// The kind of the affected entity.
  enum class Source { cable, joint, trigger };
  double time = 0.0;  ///< [s]
  Source source = Source::cable;
  std::string subject;    ///< name of the cable, joint or trigger
  int link = -1;          ///< index in the cable; -1: none, or no cable
  std::string body;       ///< the body that the cable met; empty: the world, or none
  std::string_view kind;  ///< "break" of a joint; as in cable_event_names, trigger_action_names
};

/// The events of cables and joints, and the last event of each trigger, in the order of time.
[[nodiscard]] std::vector<RunEvent> collect_events(const Simulation& simulation,
                                                   const std::vector<JointReport>& joints);

/// The outcome of one file of the run.
struct OutputSummary {
  enum class Kind { table, state };
  Kind kind;
  std::string path;
  std::int64_t rows;  ///< rows of a table under its final name
  std::string fault;  ///< why the file is incomplete; empty if it is complete
};

/// The data of a summary. The references must outlive it.
struct RunSummary {
  std::string_view scene_path;
  const Scene& scene;
  const Simulation& simulation;
  const RunMonitor& monitor;
  const RunOutcome& outcome;
  std::vector<JointReport> joints;  ///< at the end
  std::vector<RunEvent> events;
  std::vector<Warning> warnings;
  bool checked = false;  ///< whether checks were requested
  std::vector<CheckResult> checks;
  std::optional<measure::ErrorEstimate> error_estimate;  ///< set if it was requested
  double trust = default_trust;  ///< a certificate figure above it makes the run doubtful
  std::vector<OutputSummary> outputs{};
  std::vector<RopeWear> ropes{};  ///< with --rope-life

  [[nodiscard]] bool checks_passed() const;
  /// Whether the run was completed but its certificate is not clean.
  [[nodiscard]] bool doubtful() const;
  /// "done", "doubtful", "diverged", "interrupted", "time limit".
  [[nodiscard]] std::string_view status() const;
};

/// Warnings about a scene and its run: spans without a tangent, wraps that found no place, drives
/// that stalled for lack of cable, rigid cables that do not keep their length, vibrations that the
/// step damps, steps too short for the digits of positions, substeps that the direct solver or
/// rattle left to the other method, energy without a source.
[[nodiscard]] std::vector<Warning> collect_warnings(const Scene& scene,
                                                    const Simulation& simulation,
                                                    const RunStatistics& statistics,
                                                    const RunMonitor& monitor);

/// One JSON object in one line, with the keys of the documentation. Numbers that are not finite or
/// unknown are null.
[[nodiscard]] std::string to_json(const RunSummary& summary);

/// The summary as text for people.
[[nodiscard]] std::string to_text(const RunSummary& summary);
/// The checks alone, one per line.
[[nodiscard]] std::string checks_text(const std::vector<CheckResult>& checks);

/// Wall time per complete step [s]; NaN if there is none.
[[nodiscard]] double time_per_step(const RunOutcome& outcome);

}  // namespace sheave::command
