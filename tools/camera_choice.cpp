// Only in builds with the renderer.
#if SHEAVE_HAS_RENDER

#include "tools/camera_choice.h"

#include "render/overlay.h"
#include "render/view_builder.h"

namespace sheave::tools {
namespace {

/// Up in the picture: as the scene says, or against gravity unless one looks along it.
Vector3 up_of(const Scene& scene, const CameraDef& camera, const Vector3& direction) {
  if (camera.up) return *camera.up;
  const Vector3 up = render::up_direction(scene.model);
  const Vector3 view = direction.normalized();
  return view.cross(up).norm() > 1e-6 ? up : any_perpendicular(view);
}

render::FrameOptions frame_options(const CameraDef& camera, const render::DrawList& typical,
                                   int width, int height) {
  render::FrameOptions options;
  options.aspect = static_cast<double>(width) / height;
  options.margins = render::overlay_margins(typical, width, height);
  if (camera.projection == Projection::orthographic) {
    options.projection = render::Orthographic{};
  } else if (camera.vertical_fov) {
    options.projection = render::Perspective{*camera.vertical_fov};
  }
  return options;
}

}  // namespace

render::Camera choose_camera(const Scene& scene, std::span<const CableReport> cables,
                             const Eigen::AlignedBox3d& box, const render::DrawList& typical,
                             int width, int height) {
  const CameraDef def = scene.camera.value_or(CameraDef{});
  Vector3 direction = Vector3::Zero();
  if (def.position) {
    direction = *def.target - *def.position;
  } else if (def.direction) {
    direction = *def.direction;
  } else {
    direction = render::default_view_direction(render::up_direction(scene.model),
                                               render::motion_plane(scene.model, cables));
  }
  const Vector3 up = up_of(scene, def, direction);
  render::Camera camera =
      render::frame_box(box, direction, up, frame_options(def, typical, width, height));
  if (!def.position) return camera;
  camera.position = *def.position;
  camera.target = *def.target;
  if (def.height) camera.projection = render::Orthographic{*def.height};
  return camera;
}

}  // namespace sheave::tools

#endif  // SHEAVE_HAS_RENDER
