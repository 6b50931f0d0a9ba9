#include "render/scene_view.h"

#include <utility>
#include <vector>

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

CameraPath keyframed(const Scene& scene, const CameraDef& def) {
  std::vector<CameraKey> keys;
  for (const CameraKeyDef& key : scene.camera_path) {
    CameraDef own = def;
    if (key.up) own.up = key.up;
    Camera camera;
    camera.position = key.position;
    camera.target = key.target;
    camera.up = up_of(scene, own, key.target - key.position);
    if (key.height) {
      camera.projection = Orthographic{*key.height};
    } else if (key.vertical_fov || def.vertical_fov) {
      camera.projection = Perspective{key.vertical_fov ? *key.vertical_fov : *def.vertical_fov};
    }
    keys.push_back({key.time, camera});
  }
  return CameraPath(std::move(keys));
}

}  // namespace

ViewOptions scene_view_options(const Scene& scene) {
  ViewOptions options;
  options.title = scene.name;
  options.annotations = scene.annotations;
  if (scene.camera) {
    options.cable_radius = scene.camera->cable_radius;
    options.tension_max = scene.camera->tension_max;
    options.force_labels = scene.camera->labels;
    options.joints = scene.camera->joints;
    options.axes = scene.camera->axes;
    if (scene.camera->time_line) options.duration = scene.duration;
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

CameraPath scene_camera(const Scene& scene, std::span<const CableReport> cables,
                        const Eigen::AlignedBox3d& box, const DrawList& typical, int width,
                        int height) {
  const CameraDef def = scene.camera.value_or(CameraDef{});
  if (!scene.camera_path.empty()) return keyframed(scene, def);
  Vector3 direction = Vector3::Zero();
  if (def.position) {
    direction = *def.target - *def.position;
  } else if (def.direction) {
    direction = *def.direction;
  } else {
    direction =
        default_view_direction(up_direction(scene.model), motion_plane(scene.model, cables));
  }
  DrawList fullest = typical;
  for (const AnnotationDef& text : scene.annotations) {
    if (text.kind != AnnotationDef::Kind::caption) continue;
    if (text.text.size() > fullest.caption.size()) fullest.caption = text.text;
  }
  Camera camera = frame_box(box, direction, up_of(scene, def, direction),
                            scene_frame_options(def, fullest, width, height));
  if (!def.position) return CameraPath::standing(camera);
  camera.position = *def.position;
  camera.target = *def.target;
  if (def.height) camera.projection = Orthographic{*def.height};
  return CameraPath::standing(camera);
}

}  // namespace sheave::render
