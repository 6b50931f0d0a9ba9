// sheave render: simulate a scene and write a video, pictures or a still.

#include <CLI/CLI.hpp>

#include "command/registry.h"

#if SHEAVE_HAS_RENDER

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "command/camera_side.h"
#include "command/command_line.h"
#include "command/interrupt.h"
#include "command/output/file.h"
#include "command/output/paths.h"
#include "command/render/look.h"
#include "command/render/moments.h"
#include "command/render/outputs.h"
#include "command/render/trails.h"
#include "command/run/checker.h"
#include "command/run/player.h"
#include "command/scene_options.h"
#include "command/terminal.h"
#include "engine/field_check.h"
#include "engine/number_text.h"
#include "render/video_writer.h"
#include "render/view_builder.h"
#include "view/gltf_animation.h"

namespace sheave::command {
namespace {

struct RenderOptions {
  SceneOptions scene;
  std::string view;
  PictureOptions pictures;
  bool quiet = false;
};

/// Writes the run as glTF, if requested.
class GlbOutput {
 public:
  GlbOutput(const PictureOptions& options, const Look& look)
      : path_(options.glb), speed_(options.speed), animation_(look.builder, look.tension_max) {
    if (!path_.empty()) file_.emplace(path_);
  }
  [[nodiscard]] bool is_wanted() const { return file_.has_value(); }
  [[nodiscard]] long frames() const { return static_cast<long>(animation_.frames()); }

  void add(const Simulation& simulation, const std::vector<CableReport>& cables,
           const render::CutRopes& ropes) {
    if (!file_) return;
    const double time = simulation.world.state().time;
    if (animation_.frames() == 0) begin_ = time;
    animation_.add((time - begin_) / speed_, simulation.world, cables, ropes);
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
  // An output that failed is reported with its fault.
  if (outputs.has_video() || outputs.frames() == 0) tell(options.video, outputs.frames());
  tell(options.png, outputs.png_frames());
  tell(options.glb, glb_frames);
  if (!options.still.empty() && !outputs.has_still()) {
    text += "\n" + options.still + ": not written, because the run ended before its time";
  }
  if (diverged) {
    print_error(text);
  } else {
    print_warning(text);
  }
  return diverged ? ExitCode::diverged : ExitCode::interrupted;
}

/// Plays the scene again and draws it.
ExitCode draw(const Scene& scene, const RenderOptions& options, std::span<const Moment> moments,
              const Look& look, Trails& trails, PictureOutputs& outputs) {
  Progress progress("draw", 0.0, static_cast<double>(step_count(scene)), options.quiet);
  GlbOutput glb(options.pictures, look);
  render::CutRopes ropes;
  const auto show = [&](std::size_t k, const Simulation& simulation) {
    const Moment& moment = moments[k];
    trails.observe(simulation.world);
    const std::vector<CableReport> cables = reports_to_show(scene, simulation);
    ropes.follow(simulation.world, cables);
    if (!moment.frame && !moment.still) return true;
    if (moment.frame) glb.add(simulation, cables, ropes);
    if (outputs.any_left()) {
      render::DrawList list = look.builder.build(simulation.world, cables, &ropes);
      trails.add_to(list, look.builder.cable_radius());
      const render::Camera camera = look.camera.at(simulation.world.state().time);
      if (moment.still) outputs.add_still(list, camera);
      if (moment.frame) outputs.add_frame(std::move(list), camera);
    }
    return outputs.any_left() || glb.is_wanted();
  };
  RunOutcome outcome;
  try {
    outcome = play(scene, times_of(moments), progress, show);
  } catch (...) {
    outputs.finish();  // completes the outputs with the frames drawn so far
    throw;
  }
  progress.clear();
  outputs.finish();
  const long glb_frames = glb.frames();
  outputs.faults().attempt([&] { glb.finish(scene.model); });
  return outputs.faults().report(report(outcome, outputs, glb_frames, options.pictures));
}

ExitCode render_scene(RenderOptions options) {
  const PictureOptions& pictures = options.pictures;
  const NamedPath first_frame{
      "--png", pictures.png.empty() ? "" : fmt::format("{}/frame_000000.png", pictures.png)};
  check_paths({{"the scene", options.scene.path}, {"--load-state", options.scene.load_state}},
              {{"--video", pictures.video},
               {"--still", pictures.still},
               {"--glb", pictures.glb},
               first_frame},
              false);
  Scene scene = load(options.scene);
  look_from(options.view, scene);
  const double begin = start_time(scene);
  Trails trails(scene, pictures.trails);
  std::vector<Moment> moments = choose_moments(scene, pictures, begin, trails.longest_interval());
  catch_interrupts();
  std::optional<PictureOutputs> outputs;
  // Faults of the outputs are reported before the simulation, as far as the size is known.
  if (pictures.format == PictureFormat::best) {
    check_still(pictures);
  } else {
    outputs.emplace(sized(pictures, pictures.format));
  }
  const auto steps = static_cast<double>(step_count(scene));
  Progress survey_progress("survey", 0.0, steps, options.quiet);
  const bool finds_highest = !pictures.still.empty() && !pictures.at;
  const Look look = survey(scene, {pictures, begin, finds_highest}, moments, survey_progress);
  survey_progress.clear();
  if (look.highest) {  // otherwise the still is of the end
    options.pictures.at = look.highest;
    moments = choose_moments(scene, pictures, begin, trails.longest_interval());
  }
  if (!outputs) outputs.emplace(sized(pictures, look.format));
  const std::vector<Moment> followed = merged(moments, chain_moments(scene, moments, begin));
  return draw(scene, options, followed, look, trails, *outputs);
}

void check_usage(const PictureOptions& options) {
  const auto ends_with_any = [](const std::string& path, std::initializer_list<const char*> ends) {
    return std::any_of(ends.begin(), ends.end(),
                       [&](const char* end) { return path.ends_with(end); });
  };
  if (!options.has_frames() && options.still.empty()) {
    throw Failure(ExitCode::usage, "nothing to write: give --video, --png, --still or --glb");
  }
  if (!options.video.empty() && !ends_with_any(options.video, {".mp4", ".mov", ".mkv", ".gif"})) {
    throw Failure(ExitCode::usage,
                  "--video " + options.video + ": the name must end in .mp4, .mov, .mkv or .gif");
  }
  if (options.video.ends_with(".gif") && options.fps > render::VideoWriter::most_gif_rate) {
    throw Failure(
        ExitCode::usage,
        fmt::format(
            "--fps {}: the frame rate of a GIF must be at most {}, which is the limit of browsers",
            number_text(options.fps), number_text(render::VideoWriter::most_gif_rate)));
  }
  if (!options.glb.empty() && !ends_with_any(options.glb, {".glb"})) {
    throw Failure(ExitCode::usage, "--glb " + options.glb + ": the name must end in .glb");
  }
  if (!options.still.empty() && !ends_with_any(options.still, {".png", ".svg"})) {
    throw Failure(ExitCode::usage,
                  "--still " + options.still + ": the name must end in .png or .svg");
  }
}

void add_look_options(CLI::App& app, PictureOptions& options) {
  const std::map<std::string, PictureFormat> formats{{"landscape", PictureFormat::landscape},
                                                     {"portrait", PictureFormat::portrait},
                                                     {"square", PictureFormat::square},
                                                     {"best", PictureFormat::best}};
  app.add_option("--format", options.format,
                 "landscape: --width x --height; portrait: the two exchanged; square; best: the "
                 "format of these that shows the scene largest. Default: best for a still alone "
                 "without --width and --height, otherwise landscape")
      ->transform(CLI::Transformer(formats))
      ->option_text("FORMAT");
  app.add_option("--tension-max", options.tension_max,
                 "tension at the top of the colour scale [N]; default: that of the scene, "
                 "otherwise what 98 % of the tensions of the run do not exceed")
      ->check(number_between(1e-30, 1e30))
      ->option_text("N");
  app.add_option("--trail", options.trails,
                 "draw the path of a body in the last seconds, NAME:SECONDS, or of a point in its "
                 "frame, NAME:SECONDS:X,Y,Z; may be repeated")
      ->option_text("TRAIL");
}

void add_picture_options(CLI::App& app, PictureOptions& options) {
  app.add_option("--video", options.video, "write a video (.mp4, .mov, .mkv or .gif; needs ffmpeg)")
      ->option_text("FILE");
  app.add_option("--png", options.png, "write every frame into a folder, frame_000000.png ...")
      ->option_text("DIR");
  CLI::Option* still = app.add_option("--still", options.still,
                                      "write one picture (.png, or .svg with its texts as texts)");
  still->option_text("FILE");
  app.add_option("--at", options.at, "time of the still [s]; default: that of the highest tension")
      ->check(number_between(0.0, std::numeric_limits<double>::max()))
      ->option_text("T")
      ->needs(still);
  app.add_option("--glb", options.glb, "write an animated glTF 2.0 model (.glb)")
      ->option_text("FILE");
  app.add_option("--width", options.width, "width in pixels; default 1280; of a GIF alone 640")
      ->check(CLI::Range(render::Renderer::min_side, render::Renderer::max_side / 2))
      ->option_text("N");
  app.add_option("--height", options.height, "height in pixels; default 720; of a GIF alone 360")
      ->check(CLI::Range(render::Renderer::min_side, render::Renderer::max_side / 2))
      ->option_text("N");
  app.add_option("--fps", options.fps,
                 "frames per second of the video and of glTF; default 60; for a GIF 25, at most 50")
      ->check(number_between(0.001, 1000.0))
      ->option_text("X");
  app.add_option("--speed", options.speed,
                 "simulated seconds per second of the video; default 1, 0.1 is slow motion")
      ->check(number_between(1e-9, 1e9))
      ->option_text("X");
  app.add_option("--parallel", options.threads,
                 "number of frames drawn at the same time; default: one per core, at most 8")
      ->check(CLI::Range(1, 1024))
      ->option_text("N");
  add_look_options(app, options);
  app.add_flag("--labels", options.labels, "write the tensions [N] beside the cables");
  app.add_flag("--label-names", options.label_names,
               "as --labels, with the name of each cable at its highest tension");
  app.add_flag("--axes", options.axes,
               "draw the directions of x, y and z in the lower right corner, as pages do");
  app.add_flag("--time-line", options.time_line,
               "write the duration beside the time, and draw a line with a mark for the time");
}

}  // namespace

Action declare_render(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  add_scene_options(app, options->scene);
  add_picture_options(app, options->pictures);
  add_view_option(app, options->view);
  app.add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
  app.footer(R"(Examples:
  sheave render crane.json --video crane.mp4
  sheave render crane.json --still crane.png --at 1.5 --labels --width 1920 --height 1080
  sheave render crane.json --video crane.gif --width 480 --height 270 --format best
  sheave render crane.json --still way.png --trail hook:3
  sheave render crane.json --glb crane.glb --fps 30
  sheave render crane.json --video slow.mp4 --speed 0.1 --dt 0.001 --png frames

The scene sets the camera. Settings that the scene leaves out are chosen so that the whole run is
in the picture. Outputs appear when they are complete; after a divergence or Ctrl-C they have the
frames up to then. Exit codes as for sheave run.)");
  const CLI::Option* rate = app.get_option("--fps");
  const std::array sizes{app.get_option("--width"), app.get_option("--height"),
                         app.get_option("--format")};
  return [options, rate, sizes] {
    constexpr double usual_gif_rate = 25.0;
    PictureOptions& pictures = options->pictures;
    const bool sized = std::any_of(sizes.begin(), sizes.end(),
                                   [](const CLI::Option* size) { return size->count() > 0; });
    if (!sized && !pictures.has_frames()) pictures.format = PictureFormat::best;
    const bool is_gif = pictures.video.ends_with(".gif");
    if (rate->count() == 0 && is_gif) pictures.fps = usual_gif_rate;
    const bool measured = sizes[0]->count() > 0 || sizes[1]->count() > 0;
    if (!measured && is_gif && pictures.png.empty() && pictures.still.empty()) {
      // A GIF is for pages and mails, which take a few megabytes.
      pictures.width = 640;
      pictures.height = 360;
    }
    check_usage(pictures);
    return render_scene(*options);
  };
}

}  // namespace sheave::command

#else

namespace sheave::command {

Action declare_render(CLI::App& app) { return declare_without_renderer(app); }

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
