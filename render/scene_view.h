#pragma once
// How a scene asks to be shown: what it says of camera, labels and colours, and the rest so that
// everything is in the picture.

#include <span>

#include "cable/cable_report.h"
#include "render/camera.h"
#include "render/draw_list.h"
#include "render/view_builder.h"
#include "scenes/scene.h"

namespace sheave::render {

/// Title, labels, joints, radius of cables, scale of tensions and colours of bodies as the scene
/// has them.
[[nodiscard]] ViewOptions scene_view_options(const Scene& scene);

/// A camera for a width x height picture [pixels] of `box` [m], the room that the whole run takes;
/// `typical` is one frame of it, for the texts that need a place.
[[nodiscard]] Camera scene_camera(const Scene& scene, std::span<const CableReport> cables,
                                  const Eigen::AlignedBox3d& box, const DrawList& typical,
                                  int width, int height);

}  // namespace sheave::render
