#pragma once
// View of a scene: its settings of camera, labels and colours, completed so that everything is in
// the picture.

#include <span>

#include "cable/cable_report.h"
#include "render/camera_path.h"
#include "render/draw_list.h"
#include "render/view_builder.h"
#include "scenes/scene.h"

namespace sheave::render {

/// Title, annotations, labels, joints, radius of cables, scale of tensions and colours of bodies,
/// from the scene.
[[nodiscard]] ViewOptions scene_view_options(const Scene& scene);

/// The camera over time for width x height pictures [pixels] of `box` [m], the space of the whole
/// run. `typical` is one of its frames, for the space of the texts.
[[nodiscard]] CameraPath scene_camera(const Scene& scene, std::span<const CableReport> cables,
                                      const Eigen::AlignedBox3d& box, const DrawList& typical,
                                      int width, int height);

}  // namespace sheave::render
