// sheave render: simulate a scene and write a video, pictures or a still.

#include <CLI/CLI.hpp>

#include "tools/command.h"

#if SHEAVE_HAS_RENDER

#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "render/scene_view.h"
#include "render/view_builder.h"
#include "render/view_survey.h"
#include "tools/command_line.h"
#include "tools/interrupt.h"
#include "tools/output_file.h"
#include "tools/output_paths.h"
#include "tools/player.h"
#include "tools/render_outputs.h"
#include "tools/scene_options.h"
#include "tools/state_file.h"
#include "tools/terminal.h"
#include "view/gltf_animation.h"

namespace sheave::tools {
namespace {

struct RenderOptions {
  SceneOptions scene;
  PictureOptions pictures;
  std::string load_state;
  bool quiet = false;
};

/// The moments to show, in order, and what each is for.
struct Moments {
  std::vector<double> times;  // [s]
  std::size_t still = none;   // index of the still
  bool frames = false;        // all others, and this too if still_is_frame, are frames
  bool still_is_frame = false;

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  [[nodiscard]] bool is_frame(std::size_t k) const {
    return frames && (k != still || still_is_frame);
  }
};

void insert_still(Moments& moments, double at, double tolerance) {
  const auto place = std::lower_bound(moments.times.begin(), moments.times.end(), at - tolerance);
  moments.still = static_cast<std::size_t>(place - moments.times.begin());
  moments.still_is_frame = place != moments.times.end() && *place <= at + tolerance;
  if (!moments.still_is_frame) moments.times.insert(place, at);
}

/// Frames are those of a run from the start as far as they lie behind `begin` [s], so that films of
/// two parts fit together.
Moments choose_moments(const Scene& scene, const PictureOptions& options, double begin) {
  constexpr double most_frames = 1e7;
  const double dt = scene.model.step.dt;
  const double end = static_cast<double>(step_count(scene)) * dt;
  const double tolerance = 1e-6 * dt;
  if (begin > end + tolerance) {
    throw Failure(ExitCode::usage,
                  fmt::format("--load-state: the state is of {} s, when the run has ended at {} s; "
                              "see --duration",
                              number_text(begin), number_text(end)));
  }
  Moments moments;
  moments.frames = options.has_frames();
  if (moments.frames) {
    const double interval = options.speed / options.fps;
    const double last = std::floor((end + tolerance) / interval);
    if (!(last < most_frames)) {
      throw Failure(ExitCode::usage, fmt::format("{} s at this speed and rate make {:.3g} frames; "
                                                 "at most {:.0f} are possible",
                                                 number_text(end), last, most_frames));
    }
    const double first = std::ceil((begin - tolerance) / interval);
    for (double k = std::max(first, 0.0); k <= last; ++k) moments.times.push_back(k * interval);
  }
  if (options.still.empty()) return moments;
  const double at = options.at.value_or(end);
  if (at > end + tolerance) {
    throw Failure(ExitCode::usage, fmt::format("--at {}: the run ends at {} s; see --duration",
                                               number_text(at), number_text(end)));
  }
  if (at < begin - tolerance) {
    throw Failure(ExitCode::usage, fmt::format("--at {}: the state that is loaded is of {} s",
                                               number_text(at), number_text(begin)));
  }
  insert_still(moments, std::clamp(at, begin, end), tolerance);
  return moments;
}

/// What is known about the whole run before anything is drawn.
struct Look {
  render::ViewBuilder builder;
  render::Camera camera;
  double tension_max = 0;  // [N]
};

/// Plays the scene once, to frame it and to give every tension the same colour in every frame.
Look survey(const Scene& scene, const RenderOptions& settings, std::span<const double> times,
            Progress& progress) {
  const PictureOptions& options = settings.pictures;
  render::ViewSurvey survey;
  const RunOutcome outcome =
      play(scene, settings.load_state, times, progress,
           [&](std::size_t /*k*/, const Simulation& simulation) {
             survey.add(simulation.world, reports_to_show(scene, simulation));
             return true;
           });
  if (outcome.status == RunStatus::interrupted) {
    throw Failure(ExitCode::interrupted, "interrupted before anything was drawn");
  }
  const Simulation start = make_simulation(scene);
  const std::vector<CableReport> cables = start.cable_reports();
  render::ViewOptions view = render::scene_view_options(scene);
  view.tension_max = survey.tension_max();
  view.run_bounds = survey.bounds();
  view.force_labels = view.force_labels || options.labels;
  render::ViewBuilder builder(start.world, cables, view);
  const render::DrawList typical = builder.build(start.world, cables);
  const render::Camera camera =
      render::scene_camera(scene, cables, survey.bounds(), typical, options.width, options.height);
  return {std::move(builder), camera, survey.tension_max()};
}

/// The run as glTF, if that is asked for.
class GlbOutput {
 public:
  GlbOutput(const PictureOptions& options, const Look& look)
      : path_(options.glb), speed_(options.speed), animation_(look.builder, look.tension_max) {
    if (!path_.empty()) file_.emplace(path_);
  }
  [[nodiscard]] bool is_wanted() const { return file_.has_value(); }
  [[nodiscard]] long frames() const { return static_cast<long>(animation_.frames()); }

  void add(const Simulation& simulation, const std::vector<CableReport>& cables) {
    if (!file_) return;
    const double time = simulation.world.state().time;
    if (animation_.frames() == 0) begin_ = time;
    animation_.add((time - begin_) / speed_, simulation.world, cables);
  }
  void finish(const Model& model) {
    if (!file_ || animation_.frames() == 0) return;
    file_->write(animation_.finish(model));
    file_->commit();
  }

 private:
  std::string path_;
  double speed_;
  double begin_ = 0.0;  // [s]
  view::GltfAnimation animation_;
  std::optional<OutputFile> file_;
};

ExitCode report(const RunOutcome& outcome, const PictureOutputs& outputs, long glb_frames,
                const PictureOptions& options) {
  if (outcome.status == RunStatus::done) {
    if (!outcome.certificate.clean(default_trust)) {
      print_warning("doubtful: " + doubt_text(outcome.certificate, default_trust));
    }
    return ExitCode::done;
  }
  const bool diverged = outcome.status == RunStatus::diverged;
  std::string text =
      diverged ? "diverged: " + outcome.divergence->message : std::string("interrupted");
  const auto tell = [&](const std::string& path, long frames) {
    if (path.empty()) return;
    text += frames > 0 ? fmt::format("\n{}: partial, {} frames", path, frames)
                       : fmt::format("\n{}: no frame was drawn", path);
  };
  // What is at fault is told with its fault.
  if (outputs.has_video() || outputs.frames() == 0) tell(options.video, outputs.frames());
  tell(options.png, outputs.png_frames());
  tell(options.glb, glb_frames);
  if (!options.still.empty() && !outputs.has_still()) {
    text += "\n" + options.still + ": not written, its time was not reached";
  }
  if (diverged) {
    print_error(text);
  } else {
    print_warning(text);
  }
  return diverged ? ExitCode::diverged : ExitCode::interrupted;
}

ExitCode render_scene(const RenderOptions& options) {
  const PictureOptions& pictures = options.pictures;
  const NamedPath first_frame{
      "--png", pictures.png.empty() ? "" : fmt::format("{}/frame_000000.png", pictures.png)};
  check_paths({{"the scene", options.scene.path}, {"--load-state", options.load_state}},
              {{"--video", pictures.video},
               {"--still", pictures.still},
               {"--glb", pictures.glb},
               first_frame},
              false);
  const Scene scene = load(options.scene);
  double begin = 0.0;
  if (!options.load_state.empty()) {
    Simulation loaded = make_simulation(scene);
    load_state(loaded.world, options.load_state);
    begin = loaded.world.state().time;
  }
  const Moments moments = choose_moments(scene, pictures, begin);
  catch_interrupts();
  PictureOutputs outputs(pictures);
  const auto steps = static_cast<double>(step_count(scene));
  Progress survey_progress("survey", 0.0, steps, options.quiet);
  const Look look = survey(scene, options, moments.times, survey_progress);
  survey_progress.clear();
  Progress progress("draw", 0.0, steps, options.quiet);
  GlbOutput glb(pictures, look);
  const auto show = [&](std::size_t k, const Simulation& simulation) {
    const std::vector<CableReport> cables = reports_to_show(scene, simulation);
    if (moments.is_frame(k)) glb.add(simulation, cables);
    if (outputs.any_left()) {
      render::DrawList list = look.builder.build(simulation.world, cables);
      if (k == moments.still) outputs.add_still(list, look.camera);
      if (moments.is_frame(k)) outputs.add_frame(std::move(list), look.camera);
    }
    return outputs.any_left() || glb.is_wanted();
  };
  RunOutcome outcome;
  try {
    outcome = play(scene, options.load_state, moments.times, progress, show);
  } catch (...) {
    outputs.finish();  // keeps what has been drawn
    throw;
  }
  progress.clear();
  outputs.finish();
  const long glb_frames = glb.frames();
  outputs.faults().attempt([&] { glb.finish(scene.model); });
  return outputs.faults().report(report(outcome, outputs, glb_frames, pictures));
}

void check_usage(const PictureOptions& options) {
  const auto ends_with_any = [](const std::string& path, std::initializer_list<const char*> ends) {
    return std::any_of(ends.begin(), ends.end(),
                       [&](const char* end) { return path.ends_with(end); });
  };
  if (!options.has_frames() && options.still.empty()) {
    throw Failure(ExitCode::usage, "nothing to write: give --video, --png, --still or --glb");
  }
  if (!options.video.empty() && !ends_with_any(options.video, {".mp4", ".mov", ".mkv"})) {
    throw Failure(ExitCode::usage,
                  "--video " + options.video + ": the name must end in .mp4, .mov or .mkv");
  }
  if (!options.glb.empty() && !ends_with_any(options.glb, {".glb"})) {
    throw Failure(ExitCode::usage, "--glb " + options.glb + ": the name must end in .glb");
  }
  if (!options.still.empty() && !ends_with_any(options.still, {".png"})) {
    throw Failure(ExitCode::usage, "--still " + options.still + ": the name must end in .png");
  }
}

void add_picture_options(CLI::App& app, PictureOptions& options) {
  app.add_option("--video", options.video, "write a video (.mp4, .mov or .mkv; needs ffmpeg)")
      ->option_text("FILE");
  app.add_option("--png", options.png, "write every frame into a folder, frame_000000.png ...")
      ->option_text("DIR");
  CLI::Option* still = app.add_option("--still", options.still, "write one picture (.png)");
  still->option_text("FILE");
  app.add_option("--at", options.at, "time of the still [s]; default: the end")
      ->check(number_between(0.0, std::numeric_limits<double>::max()))
      ->option_text("T")
      ->needs(still);
  app.add_option("--glb", options.glb, "write an animated glTF 2.0 model (.glb)")
      ->option_text("FILE");
  app.add_option("--width", options.width, "pixels; default 1280")
      ->check(CLI::Range(render::Renderer::min_side, render::Renderer::max_side / 2))
      ->option_text("N");
  app.add_option("--height", options.height, "pixels; default 720")
      ->check(CLI::Range(render::Renderer::min_side, render::Renderer::max_side / 2))
      ->option_text("N");
  app.add_option("--fps", options.fps, "frames per second of the video and of glTF; default 60")
      ->check(number_between(0.001, 1000.0))
      ->option_text("X");
  app.add_option("--speed", options.speed,
                 "simulated seconds per second of the video; default 1, 0.1 is slow motion")
      ->check(number_between(1e-9, 1e9))
      ->option_text("X");
  app.add_option("--parallel", options.threads, "frames drawn side by side; default: one per core")
      ->check(CLI::Range(1, 1024))
      ->option_text("N");
  app.add_flag("--labels", options.labels, "write the tensions [N] beside the cables");
}

}  // namespace

Action declare_render(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  add_scene_options(app, options->scene);
  add_picture_options(app, options->pictures);
  app.add_option("--load-state", options->load_state, "start from a saved state (sheave run)")
      ->option_text("FILE");
  app.add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
  app.footer(R"(Examples:
  sheave render crane.json --video crane.mp4
  sheave render crane.json --still crane.png --at 1.5 --labels --width 1920 --height 1080
  sheave render crane.json --glb crane.glb --fps 30
  sheave render crane.json --video slow.mp4 --speed 0.1 --dt 0.001 --png frames

The camera is that of the scene. What the scene leaves open is chosen so that the whole run is in
the picture. Outputs appear when they are complete; after a divergence or Ctrl-C they hold the
frames so far. Exit codes as for sheave run.)");
  return [options] {
    check_usage(options->pictures);
    return render_scene(*options);
  };
}

}  // namespace sheave::tools

#else

namespace sheave::tools {

Action declare_render(CLI::App& app) { return declare_without_renderer(app); }

}  // namespace sheave::tools

#endif  // SHEAVE_HAS_RENDER
