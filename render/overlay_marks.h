#pragma once
// Marks over a picture that a scene or a command asks for: the directions of the axes, and a line of
// the time.

#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/label_layout.h"

namespace sheave::render {

/// Sizes of the texts of an overlay [pixels].
struct MarkStyle {
  double text = 12.0;    ///< height of labels
  double margin = 12.0;  ///< distance from the edges
  double halo = 1.0;
};

/// Side of the square that the axes need in the lower right corner [pixels].
[[nodiscard]] double triad_side(const MarkStyle& style);
/// Draws the directions of x, y and z as the camera sees them. An axis that points almost to the eye
/// or away from it has no direction to draw, and is left out. Returns the square.
Rectangle draw_triad(const Camera& camera, Canvas& canvas, const MarkStyle& style);

/// Draws a line as long as the duration [s], > 0, with a mark at the time, below `baseline`. Returns
/// its rectangle.
Rectangle draw_time_line(double time, double duration, double baseline, Canvas& canvas,
                         const MarkStyle& style);
/// Height of the line with its distance from the text above it [pixels].
[[nodiscard]] double time_line_height(const MarkStyle& style);

}  // namespace sheave::render
