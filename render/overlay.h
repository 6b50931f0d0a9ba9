#pragma once
// All texts of a picture, drawn after the scene: title, time, caption, legend, labels.

#include "render/camera.h"
#include "render/canvas.h"
#include "render/draw_list.h"

namespace sheave::render {

/// Draws the texts of the list over a picture taken with this camera.
void draw_overlay(const DrawList& list, const Camera& camera, Canvas& canvas);

/// The space for title, legend and caption in a width x height picture, as margins for frame_box().
[[nodiscard]] Margins overlay_margins(const DrawList& list, int width, int height);

}  // namespace sheave::render
