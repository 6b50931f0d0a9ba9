#include "render/overlay_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "render/font.h"

namespace sheave::render {
namespace {

/// An axis whose share in the plane of the picture is below this has no direction to draw.
constexpr double least_seen = 0.15;
/// In heights of the text: length of an axis in the plane of the picture, and distance of its name
/// from the end that is seen.
constexpr double axis_reach = 1.9;
constexpr double name_gap = 0.7;
/// In heights of the text: length and thickness of the line of the time, and its distance from the
/// text above.
constexpr double line_length = 9.0;
constexpr double line_thickness = 0.16;
constexpr double line_gap = 0.75;

struct SeenAxis {
  std::string_view name;
  Color color;
  double right = 0.0;
  double up = 0.0;
  double near = 0.0;
};

/// The axes in the order in which to draw them: those that point to the eye last.
std::array<SeenAxis, 3> seen_axes(const Camera& camera) {
  const CameraAxes view = axes(camera);
  const std::array colors{rgb(0xa63c00), rgb(0x00644a), rgb(0x0b5fae)};
  constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
  std::array<SeenAxis, 3> seen{};
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    seen[k] = {names[k], colors[k], view.right[i], view.up[i], view.back[i]};
  }
  std::stable_sort(seen.begin(), seen.end(),
                   [](const SeenAxis& a, const SeenAxis& b) { return a.near < b.near; });
  return seen;
}

}  // namespace

double triad_side(const MarkStyle& style) {
  return 2.0 * (axis_reach + name_gap + 0.6) * style.text;
}

Rectangle draw_triad(const Camera& camera, Canvas& canvas, const MarkStyle& style) {
  const double side = triad_side(style);
  const Rectangle area{canvas.width() - 0.5 * style.margin - side,
                       canvas.height() - 0.5 * style.margin - side, side, side};
  const double x = area.x + 0.5 * side;
  const double y = area.y + 0.5 * side;
  const double width = std::max(1.5, 0.14 * style.text);
  for (const SeenAxis& axis : seen_axes(camera)) {
    const double size = std::hypot(axis.right, axis.up);
    if (size < least_seen) continue;
    const double reach = axis_reach * style.text;
    const double tip_x = x + reach * axis.right;
    const double tip_y = y - reach * axis.up;
    canvas.line(x, y, tip_x, tip_y, width + 2.0 * style.halo, rgb(0xffffff), 0.6);
    canvas.line(x, y, tip_x, tip_y, width, axis.color, 1.0);
    const double away = (axis_reach + name_gap / size) * style.text;
    const TextSize extent = Font::builtin().measure(axis.name, style.text);
    canvas.text(x + away * axis.right - 0.5 * extent.width, y - away * axis.up + 0.32 * style.text,
                axis.name, style.text, axis.color, style.halo);
  }
  return area;
}

Rectangle draw_time_line(double time, double duration, double baseline, Canvas& canvas,
                         const MarkStyle& style) {
  const double thickness = std::max(1.0, line_thickness * style.text);
  const double length = line_length * style.text;
  const double x = style.margin;
  const double y = baseline + line_gap * style.text;
  const double share = std::clamp(time / duration, 0.0, 1.0);
  canvas.fill(x - style.halo, y - 0.5 * thickness - style.halo, length + 2.0 * style.halo,
              thickness + 2.0 * style.halo, rgb(0xffffff), 0.6);
  canvas.fill(x, y - 0.5 * thickness, length, thickness, rgb(0xb4bcc8));
  canvas.fill(x, y - 0.5 * thickness, share * length, thickness, rgb(0x4a5563));
  const double mark = 3.5 * thickness;
  canvas.fill(x + share * length - 0.5 * thickness, y - 0.5 * mark, thickness, mark, rgb(0x1b2430));
  return {x, y - 0.5 * mark, length, mark};
}

double time_line_height(const MarkStyle& style) { return (line_gap + 0.4) * style.text; }

}  // namespace sheave::render
