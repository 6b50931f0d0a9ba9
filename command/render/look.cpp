// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "command/render/look.h"

#include <cmath>
#include <utility>

#include "command/failure.h"
#include "render/scene_view.h"
#include "render/view_survey.h"

namespace sheave::command {
namespace {

/// A camera for one format, and its scale in the middle of the picture.
struct Framing {
  render::CameraPath camera;
  double scale = 0.0;  // [pixels/m]
};

Framing frame(const Scene& scene, const std::vector<CableReport>& cables,
              const Eigen::AlignedBox3d& box, const render::DrawList& typical,
              const PictureOptions& options) {
  const render::CameraPath path =
      render::scene_camera(scene, cables, box, typical, options.width, options.height);
  const render::Camera first = path.keys().front().camera;
  const render::Projector projector(first, options.width, options.height);
  const Vector3 middle = box.isEmpty() ? first.target : Vector3(box.center());
  return {path, projector.scale_at(projector.depth_of(middle))};
}

/// Another format is chosen only if it shows the scene larger by this factor.
constexpr double worth = 1.15;

std::pair<PictureFormat, render::CameraPath> choose_format(const Scene& scene,
                                                           const std::vector<CableReport>& cables,
                                                           const Eigen::AlignedBox3d& box,
                                                           const render::DrawList& typical,
                                                           const PictureOptions& options) {
  const auto framed = [&](PictureFormat format) {
    return frame(scene, cables, box, typical, sized(options, format));
  };
  // A camera that the scene places explicitly is meant for the default format.
  const bool placed = (scene.camera && scene.camera->position) || !scene.camera_path.empty();
  if (options.format != PictureFormat::best) {
    return {options.format, framed(options.format).camera};
  }
  PictureFormat chosen = PictureFormat::landscape;
  Framing best = framed(chosen);
  for (const PictureFormat other : {PictureFormat::square, PictureFormat::portrait}) {
    if (placed) break;
    const Framing framing = framed(other);
    if (framing.scale < worth * best.scale) continue;
    chosen = other;
    best = framing;
  }
  return {chosen, best.camera};
}

}  // namespace

PictureOptions sized(PictureOptions options, PictureFormat format) {
  if (format == PictureFormat::portrait) std::swap(options.width, options.height);
  if (format == PictureFormat::square) {
    const double pixels = static_cast<double>(options.width) * options.height;
    // The encoder needs an even size.
    options.width = options.height = 2 * static_cast<int>(std::lround(0.5 * std::sqrt(pixels)));
  }
  return options;
}

Look survey(const Scene& scene, const SurveyOptions& options, std::span<const Moment> moments,
            Progress& progress) {
  const PictureOptions& pictures = options.pictures;
  render::ViewOptions view = render::scene_view_options(scene);
  if (pictures.tension_max) view.tension_max = pictures.tension_max;
  std::vector<Moment> looked_at(moments.begin(), moments.end());
  if (!view.tension_max || options.finds_highest) {
    looked_at = merged(moments, scale_moments(scene, options.begin));
  }
  if (options.finds_highest) looked_at = merged(looked_at, peak_moments(scene, options.begin));
  render::ViewSurvey survey;
  const RunOutcome outcome =
      play(scene, times_of(looked_at), progress, [&](std::size_t k, const Simulation& simulation) {
        const std::vector<CableReport> cables = reports_to_show(scene, simulation);
        if (looked_at[k].peak) {
          survey.look_for_highest(simulation.world, cables);
          return true;
        }
        const bool scale = looked_at[k].scale;
        if (scale) survey.add_tensions(simulation.world, cables);
        // The still may be of any of these moments.
        if (!scale || options.finds_highest) survey.add_room(simulation.world, cables);
        return true;
      });
  if (outcome.status == RunStatus::interrupted) {
    throw Failure(ExitCode::interrupted, "interrupted before the first frame was drawn");
  }
  const Simulation start = make_in_pose(scene);
  const std::vector<CableReport> cables = start.cable_reports();
  if (!view.tension_max) view.tension_max = survey.tension_max();
  view.run_bounds = survey.bounds();
  view.travels = survey.travels();
  view.force_labels = view.force_labels || pictures.labels || pictures.label_names;
  view.label_names = pictures.label_names;
  view.axes = view.axes || pictures.axes;
  if (pictures.time_line) view.duration = scene.duration;
  const double tension_max = *view.tension_max;
  render::ViewBuilder builder(start.world, cables, view);
  const render::DrawList typical = builder.build(start.world, cables);
  const auto [format, camera] = choose_format(scene, cables, survey.bounds(), typical, pictures);
  const bool ends_well = options.finds_highest && outcome.status == RunStatus::done;
  return {std::move(builder), camera, tension_max, format,
          ends_well ? survey.highest() : std::nullopt};
}

}  // namespace sheave::command

#endif  // SHEAVE_HAS_RENDER
