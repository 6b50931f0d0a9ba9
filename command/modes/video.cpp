#include "command/modes/video.h"

#include <cmath>

#include <fmt/format.h>

#include "command/failure.h"

#if SHEAVE_HAS_RENDER

#include "command/interrupt.h"
#include "command/render/outputs.h"
#include "command/run/player.h"
#include "engine/body_set.h"
#include "render/renderer.h"
#include "render/scene_view.h"
#include "render/view_builder.h"
#include "render/view_survey.h"

namespace sheave::command {
namespace {

static_assert(least_mode_picture == render::Renderer::min_side);
static_assert(most_mode_picture == render::Renderer::max_side / 2);
constexpr int film_frames = 120;
constexpr double film_rate = 30.0;  // [1/s]
constexpr int film_periods = 2;

/// The factor of the mode shape for which no part moves farther than `amplitude` of the scene.
double scale_of(const Simulation& simulation, const Mode& mode, double amplitude) {
  const BodySet& bodies = simulation.world.bodies();
  double farthest = 0.0;
  for (const BodyFreedom& freedom : bodies.coordinates().movable()) {
    const int linear = freedom.kind == Freedom::angle   ? 0
                       : freedom.kind == Freedom::line  ? 1
                       : freedom.kind == Freedom::plane ? 2
                                                        : 3;
    for (int k = 0; k < size_of(freedom.kind); ++k) {
      const double part = std::abs(mode.shape[freedom.first - 1 + k]);
      // A rotation of 1 rad is large, except for a wheel on an axle.
      constexpr double of_wheels = 0.1;
      const double size = k < linear                       ? part / bodies.scale()
                          : freedom.kind == Freedom::angle ? of_wheels * part
                                                           : part;
      farthest = std::max(farthest, size);
    }
  }
  return farthest > 0.0 ? amplitude / farthest : 0.0;
}

/// The view of the film: the scene's own, without the time.
render::ViewOptions view_of(const Scene& scene, const Mode& mode, int number,
                            const render::ViewSurvey& survey) {
  render::ViewOptions view;
  view.tension_max = survey.tension_max();
  if (scene.camera && scene.camera->tension_max) view.tension_max = scene.camera->tension_max;
  view.run_bounds = survey.bounds();
  view.travels = survey.travels();
  view.time = false;
  view.title = mode.frequency > 0.0
                   ? fmt::format("{}: mode {}, {:.4g} Hz", scene.name, number, mode.frequency)
                   : fmt::format("{}: mode {}", scene.name, number);
  if (scene.camera) {
    view.joints = scene.camera->joints;
    view.cable_radius = scene.camera->cable_radius;
  }
  view.body_colors.resize(scene.model.bodies.size());
  for (const PaintDef& paint : scene.paint) {
    view.body_colors[static_cast<std::size_t>(paint.body.index)] =
        render::Color{static_cast<float>(paint.color.x()), static_cast<float>(paint.color.y()),
                      static_cast<float>(paint.color.z())};
  }
  return view;
}

}  // namespace

void animate_mode(const Scene& scene, Simulation& simulation, const Modes& modes,
                  const ModeVideo& video) {
  if (video.mode > static_cast<int>(modes.modes.size())) {
    throw Failure(ExitCode::usage,
                  fmt::format("--mode {}: there are {} modes", video.mode, modes.modes.size()));
  }
  const Mode& mode = modes.modes[static_cast<std::size_t>(video.mode - 1)];
  const double amplitude = scale_of(simulation, mode, video.amplitude);
  const State here = simulation.world.state();
  const auto place = [&](double share) {
    const State there = displaced_state(simulation, modes, mode.shape, share * amplitude);
    if (!simulation.world.restore(there).empty()) throw Failure(ExitCode::internal, "restore");
  };
  const auto leave = [&] {
    if (!simulation.world.restore(here).empty()) throw Failure(ExitCode::internal, "restore");
  };
  render::ViewSurvey survey;
  for (const double share : {-1.0, 0.0, 1.0}) {
    place(share);
    survey.add(simulation.world, simulation.cable_reports());
    leave();
  }
  const render::ViewOptions view = view_of(scene, mode, video.mode, survey);
  PictureOptions options;
  options.video = video.path;
  options.still = video.still;
  options.width = video.width;
  options.height = video.height;
  options.fps = film_rate;
  const std::vector<CableReport> cables = simulation.cable_reports();
  render::ViewBuilder builder(simulation.world, cables, view);
  const render::DrawList typical = builder.build(simulation.world, cables);
  const render::Camera camera =
      render::scene_camera(scene, cables, survey.bounds(), typical, options.width, options.height)
          .at(simulation.world.state().time);
  catch_interrupts();
  PictureOutputs outputs(options);
  const auto draw = [&](double share, bool still) {
    place(share);
    const render::DrawList list = builder.build(simulation.world, simulation.cable_reports());
    if (still) {
      outputs.add_still(list, camera);
    } else {
      outputs.add_frame(list, camera);
    }
    leave();
  };
  if (!video.path.empty()) {
    for (int i = 0; i < film_frames; ++i) {
      if (interrupted()) throw Failure(ExitCode::interrupted, video.path + ": interrupted");
      draw(std::sin(2.0 * pi * film_periods * i / film_frames), false);
    }
  }
  if (!video.still.empty()) draw(1.0, true);
  outputs.finish();
  const ExitCode code = outputs.faults().report(ExitCode::done);
  if (code != ExitCode::done) throw Failure(code, "the mode's picture could not be written");
}

}  // namespace sheave::command

#else

namespace sheave::command {

void animate_mode(const Scene& /*scene*/, Simulation& /*simulation*/, const Modes& /*modes*/,
                  const ModeVideo& /*video*/) {
  throw Failure(ExitCode::internal,
                "this build has no renderer: configure with -DSHEAVE_RENDER=ON");
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
