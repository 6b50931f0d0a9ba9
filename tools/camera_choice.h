#pragma once
// The camera of a scene: what the scene says, and the rest so that everything is in the picture.

#include <span>

#include "cable/cable_report.h"
#include "render/camera.h"
#include "render/draw_list.h"
#include "scenes/scene.h"

namespace sheave::tools {

/// A camera for a width x height picture of `box` [m], the room that the whole run takes; `typical`
/// is one frame of it, for the texts that need a place.
[[nodiscard]] render::Camera choose_camera(const Scene& scene, std::span<const CableReport> cables,
                                           const Eigen::AlignedBox3d& box,
                                           const render::DrawList& typical, int width, int height);

}  // namespace sheave::tools
