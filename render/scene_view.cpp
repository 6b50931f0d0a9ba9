#include "render/scene_view.h"

#include "render/overlay.h"
#include "render/view_survey.h"

namespace sheave::render {
namespace {

/// The picture's up direction: the one the scene gives, else against gravity, unless the view is
/// along gravity.
Vector3 up_of(const Scene& scene, const CameraDef& camera, const Vector3& direction) {
  if (camera.up) return *camera.up;
  const Vector3 up = up_direction(scene.model);
  const Vector3 view = direction.normalized();
  return view.cross(up).norm() > 1e-6 ? up : any_perpendicular(view);
}

FrameOptions scene_frame_options(const CameraDef& camera, const DrawList& typical, int width,
                                 int height) {
  FrameOptions options;
  options.aspect = static_cast<double>(width) / height;
  options.margins = overlay_margins(typical, width, height);
  if (camera.projection == Projection::orthographic) {
    options.projection = Orthographic{};
  } else if (camera.vertical_fov) {
    options.projection = Perspective{*camera.vertical_fov};
  }
  return options;
}

}  // namespace

ViewOptions scene_view_options(const Scene& scene) {
  ViewOptions options;
  options.title = scene.name;
  if (scene.camera) {
    options.cable_radius = scene.camera->cable_radius;
    options.tension_max = scene.camera->tension_max;
    options.force_labels = scene.camera->labels;
    options.joints = scene.camera->joints;
  }
  options.body_colors.resize(scene.model.bodies.size());
  for (const PaintDef& paint : scene.paint) {
    if (paint.body.is_world()) continue;
    const Vector3& c = paint.color;
    options.body_colors[static_cast<std::size_t>(paint.body.index)] =
        Color{static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())};
  }
  return options;
}

Camera scene_camera(const Scene& scene, std::span<const CableReport> cables,
                    const Eigen::AlignedBox3d& box, const DrawList& typical, int width,
                    int height) {
  const CameraDef def = scene.camera.value_or(CameraDef{});
  Vector3 direction = Vector3::Zero();
  if (def.position) {
    direction = *def.target - *def.position;
  } else if (def.direction) {
    direction = *def.direction;
  } else {
    direction =
        default_view_direction(up_direction(scene.model), motion_plane(scene.model, cables));
  }
  Camera camera = frame_box(box, direction, up_of(scene, def, direction),
                            scene_frame_options(def, typical, width, height));
  if (!def.position) return camera;
  camera.position = *def.position;
  camera.target = *def.target;
  if (def.height) camera.projection = Orthographic{*def.height};
  return camera;
}

}  // namespace sheave::render
