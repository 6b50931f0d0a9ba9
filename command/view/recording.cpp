// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "command/view/recording.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "command/run/checker.h"
#include "command/run/player.h"
#include "command/run/summary.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "engine/field_check.h"
#include "engine/joint_report.h"
#include "render/scene_view.h"

namespace sheave::command {
namespace {

// 200 s at 60 frames per second, and the number of values that a page holds without trouble.
constexpr std::int64_t most_frames = 12'000;
constexpr std::int64_t most_values = 40'000'000;

/// Of the picture that camera and margins are chosen for; a page fits it to its own.
constexpr int usual_width = 1280;
constexpr int usual_height = 720;

std::string text_of(const RunEvent& event) {
  switch (event.source) {
    case RunEvent::Source::joint:
      return fmt::format("joint {} breaks", event.subject);
    case RunEvent::Source::trigger:
      return fmt::format("trigger {}: {}", event.subject, event.kind);
    case RunEvent::Source::cable:
      break;
  }
  const std::string where = event.link < 0 ? "a wrap" : fmt::format("link {}", event.link);
  return fmt::format("cable {}: {} at {}{}", event.subject, event.kind, where,
                     event.body.empty() ? "" : " on " + event.body);
}

void add_events(const Simulation& simulation, const RunOutcome& outcome,
                view::Recording& recording) {
  for (const RunEvent& event : collect_events(simulation, joint_reports(simulation.world))) {
    recording.add({event.time, std::string(event.kind), text_of(event)});
  }
  if (!outcome.divergence) return;
  recording.add(
      {simulation.world.state().time, "diverged", "diverged: " + outcome.divergence->message});
}

/// The verdict of the run's certificate, for the head of the page.
view::Json verdict_of(const RunOutcome& outcome) {
  if (outcome.divergence) return {{"clean", false}, {"text", "diverged"}};
  const bool clean = outcome.certificate.clean(default_trust);
  return {{"clean", clean},
          {"text", clean ? "certificate: clean"
                         : "doubtful: " + doubt_text(outcome.certificate, default_trust)}};
}

}  // namespace

std::int64_t suitable_interval(const Scene& scene) {
  const Simulation simulation = make_in_pose(scene);
  const view::FrameChannels channels(simulation, simulation.cable_reports());
  const auto values = static_cast<std::int64_t>(channels.channels().size());
  const std::int64_t frames = std::clamp(most_values / values, std::int64_t{2}, most_frames);
  return std::max(std::int64_t{1}, (step_count(scene) + frames - 1) / frames);
}

RecordedRun record_run(const Scene& scene, std::int64_t interval, Progress& progress) {
  Simulation simulation = make_simulation(scene);
  RecordedRun run{view::Recording(simulation), {}, {}};
  const std::int64_t first = simulation.world.state().steps;
  const auto take = [&] {
    run.recording.add(simulation);
    run.survey.add(simulation.world, reports_to_show(scene, simulation));
  };
  run.outcome = simulate(simulation, step_count(scene), progress, [&](const RunStatistics&) {
    if ((simulation.world.state().steps - first) % interval == 0) take();
    return true;
  });
  if (run.recording.times().back() < simulation.world.state().time) take();
  add_events(simulation, run.outcome, run.recording);
  return run;
}

view::Json machine_of(const Scene& scene, const RecordedRun& run) {
  const Simulation start = make_in_pose(scene);
  const std::vector<CableReport> cables = start.cable_reports();
  render::ViewOptions options = render::scene_view_options(scene);
  if (!options.tension_max) options.tension_max = run.survey.tension_max();
  options.run_bounds = run.survey.bounds();
  options.travels = run.survey.travels();
  const render::ViewBuilder builder(start.world, cables, options);
  const render::CameraPath camera =
      render::scene_camera(scene, cables, run.survey.bounds(), builder.build(start.world, cables),
                           usual_width, usual_height);
  const view::MachineLook look{builder, camera, run.survey.bounds(), *options.tension_max};
  view::Json machine = view::machine_json(scene, cables, run.recording.channels(), look);
  machine["verdict"] = verdict_of(run.outcome);
  return machine;
}

ExitCode report_run(const RunOutcome& outcome) {
  switch (outcome.status) {
    case RunStatus::diverged:
      print_error("diverged: " + outcome.divergence->message +
                  "\nthe output has the run up to then");
      return ExitCode::diverged;
    case RunStatus::interrupted:
      print_warning("interrupted; the output has the run up to then");
      return ExitCode::interrupted;
    case RunStatus::time_limit:
    case RunStatus::done:
      break;
  }
  if (!outcome.certificate.clean(default_trust)) {
    print_warning("doubtful: " + doubt_text(outcome.certificate, default_trust));
  }
  return ExitCode::done;
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
