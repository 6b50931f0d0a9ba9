#pragma once
// A run with its frames and with the data to show them.

#include <cstdint>
#include <string>

#include "command/failure.h"
#include "command/run/simulate.h"
#include "render/view_survey.h"
#include "scenes/scene.h"
#include "view/machine_json.h"
#include "view/recording.h"

namespace sheave::command {

/// How many steps there are to a frame, so that neither frames nor numbers become too many for a
/// page.
[[nodiscard]] std::int64_t suitable_interval(const Scene& scene);

struct RecordedRun {
  view::Recording recording;
  render::ViewSurvey survey;
  RunOutcome outcome;
};

/// Runs a scene and takes down every `interval`-th step, the first and the last. Where it diverged
/// is an event.
[[nodiscard]] RecordedRun record_run(const Scene& scene, std::int64_t interval, Progress& progress);

/// The looks of the machine in it.
[[nodiscard]] view::Json machine_of(const Scene& scene, const RecordedRun& run);

/// Reports faults of the run on standard error; returns the exit code for them.
ExitCode report_run(const RunOutcome& outcome);

}  // namespace sheave::command
