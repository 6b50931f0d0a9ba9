#pragma once
// Everything written on a picture after the scene is drawn: title, time, caption, legend, labels.

#include "render/camera.h"
#include "render/canvas.h"
#include "render/draw_list.h"

namespace sheave::render {

/// Draws the texts of the list over a picture taken with this camera.
void draw_overlay(const DrawList& list, const Camera& camera, Canvas& canvas);

/// The part of a width x height picture that title, legend and caption need, as margins to pass to
/// frame_box() so that the scene stays clear of them.
[[nodiscard]] Margins overlay_margins(const DrawList& list, int width, int height);

}  // namespace sheave::render
