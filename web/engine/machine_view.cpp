#include "web/engine/machine_view.h"

#include <algorithm>

#include "render/view_survey.h"
#include "scenes/control/scene_supervisor.h"

namespace sheave::web {
namespace {

constexpr int most_steps = 60;

render::ViewSurvey survey_of(const Scene& scene) {
  render::ViewSurvey survey;
  auto trial = create_simulation(scene);
  if (!trial) return survey;
  survey.add(trial->world, trial->cable_reports());
  const double end = std::min(1.0, scene.duration);
  for (int k = 0; k < most_steps && trial->world.state().time < end; ++k) {
    if (!trial->step().ok()) break;
    survey.add(trial->world, trial->cable_reports());
  }
  return survey;
}

/// The scene's camera, or a default one: perpendicular to a planar scene's plane, or from the side
/// and above. The page adapts the distance to its own size.
render::Camera camera_of(const Scene& scene, const std::vector<CableReport>& cables,
                         const Vector3& middle) {
  render::Camera camera;
  camera.up = render::up_direction(scene.model);
  Vector3 along;
  if (const auto plane = render::motion_plane(scene.model, cables)) {
    along = -*plane;
    if (along.z() > 0.0 || (along.z() == 0.0 && along.y() < 0.0)) along = -along;
  } else {
    const Vector3 side = camera.up.unitOrthogonal();
    along = -side + 0.5 * side.cross(camera.up) - 0.4 * camera.up;
  }
  if (scene.camera) {
    const CameraDef& said = *scene.camera;
    if (said.up) camera.up = *said.up;
    if (said.direction) along = *said.direction;
    if (said.position && said.target) along = *said.target - *said.position;
    if (said.vertical_fov) camera.projection = render::Perspective{*said.vertical_fov};
    if (said.projection == Projection::orthographic) {
      camera.projection = render::Orthographic{said.height.value_or(1.0)};
    }
  }
  if (along.normalized().cross(camera.up.normalized()).norm() < 1e-3) {
    camera.up = along.unitOrthogonal();
  }
  camera.target = middle;
  camera.position = middle - along.normalized();
  return camera;
}

}  // namespace

view::Json machine_description(const Scene& scene, const Simulation& start,
                               const view::FrameChannels& channels) {
  const render::ViewSurvey survey = survey_of(scene);
  const std::vector<CableReport> cables = start.cable_reports();
  render::ViewOptions options;
  options.tension_max = survey.tension_max();
  options.run_bounds = survey.bounds();
  options.title = scene.name;
  if (scene.camera) {
    options.joints = scene.camera->joints;
    options.cable_radius = scene.camera->cable_radius;
  }
  options.body_colors.resize(scene.model.bodies.size());
  for (const PaintDef& paint : scene.paint) {
    options.body_colors[static_cast<std::size_t>(paint.body.index)] =
        render::Color{static_cast<float>(paint.color.x()), static_cast<float>(paint.color.y()),
                      static_cast<float>(paint.color.z())};
  }
  const render::ViewBuilder builder(start.world, cables, options);
  const Vector3 middle =
      survey.bounds().isEmpty() ? Vector3(Vector3::Zero()) : Vector3(survey.bounds().center());
  const view::MachineLook look{builder,
                               render::CameraPath::standing(camera_of(scene, cables, middle)),
                               survey.bounds(), survey.tension_max()};
  return view::machine_json(scene, cables, channels, look);
}

}  // namespace sheave::web
