#pragma once
// What a run says at its end.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cable/step_warnings.h"
#include "command/run/checker.h"
#include "command/run/monitor.h"
#include "command/run/simulate.h"
#include "engine/joint_report.h"
#include "measure/error_estimate.h"
#include "scenes/check.h"
#include "scenes/scene.h"

namespace sheave::command {

/// Something that happened at a moment.
struct RunEvent {
  /// What it happened to.
  enum class Source { cable, joint, trigger };
  double time = 0.0;  ///< [s]
  Source source = Source::cable;
  std::string subject;    ///< name of the cable, joint or trigger
  int link = -1;          ///< of the cable; -1: none, and for others
  std::string body;       ///< that the cable met; empty: the world, or none
  std::string_view kind;  ///< "break" of a joint; as in cable_event_names, trigger_action_names
};

/// What cables and joints went through and triggers did last, in the order of time.
[[nodiscard]] std::vector<RunEvent> collect_events(const Simulation& simulation,
                                                   const std::vector<JointReport>& joints);

/// What became of a file of the run.
struct OutputSummary {
  enum class Kind { table, state };
  Kind kind;
  std::string path;
  std::int64_t rows;  ///< of a table that are under its name
  std::string fault;  ///< why it is not complete; empty if it is
};

/// All that a summary is made of. The references must outlive it.
struct RunSummary {
  std::string_view scene_path;
  const Scene& scene;
  const Simulation& simulation;
  const RunMonitor& monitor;
  const RunOutcome& outcome;
  std::vector<JointReport> joints;  ///< at the end
  std::vector<RunEvent> events;
  std::vector<Warning> warnings;
  bool checked = false;  ///< whether checks were asked for
  std::vector<CheckResult> checks;
  std::optional<measure::ErrorEstimate> error_estimate;  ///< if it was asked for
  double trust = default_trust;  ///< figures of the certificate above it make the run doubtful
  std::vector<OutputSummary> outputs{};

  [[nodiscard]] bool checks_passed() const;
  /// Whether the run was done and its own numbers contradict each other.
  [[nodiscard]] bool doubtful() const;
  /// "done", "doubtful", "diverged", "interrupted", "time limit".
  [[nodiscard]] std::string_view status() const;
};

/// Warnings about a scene and the course of its run: spans that had no tangent, wraps that found no
/// place, drives that stalled for want of cable, rigid cables that do not keep
/// their length, vibrations that the step damps, steps too short for the digits of positions,
/// substeps that the direct solver or rattle left to the other one, energy that nothing has put
/// into the scene.
[[nodiscard]] std::vector<Warning> collect_warnings(const Scene& scene,
                                                    const Simulation& simulation,
                                                    const RunStatistics& statistics,
                                                    const RunMonitor& monitor);

/// Numbers of a scene that the engine does not vouch for (scenes/magnitude.h).
[[nodiscard]] std::vector<Warning> magnitude_warnings(const Scene& scene);
/// Warnings about a scene that can be run but may not be what was meant: such numbers, windings
/// that look as if they were entered the wrong way round.
[[nodiscard]] std::vector<Warning> scene_warnings(const CableSystem& cables);
[[nodiscard]] std::vector<Warning> scene_warnings(const Scene& scene);

/// One JSON object in one line, keys as in the documentation. Numbers that are not finite or not
/// known are null.
[[nodiscard]] std::string to_json(const RunSummary& summary);

/// The same for people.
[[nodiscard]] std::string to_text(const RunSummary& summary);
/// The checks alone, one per line.
[[nodiscard]] std::string checks_text(const std::vector<CheckResult>& checks);

/// Wall time per complete step [s]; NaN without any.
[[nodiscard]] double time_per_step(const RunOutcome& outcome);

}  // namespace sheave::command
