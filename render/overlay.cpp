#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "render/font.h"
#include "render/label_layout.h"
#include "render/number_text.h"

namespace sheave::render {
namespace {

constexpr Color ink = rgb(0x1b2430);
constexpr Color soft_ink = rgb(0x4a5563);

/// Sizes in proportion to the picture's height, so that a large picture looks like a small one
/// enlarged.
struct Style {
  double text;    ///< height of labels and ticks [pixels]
  double title;   ///< height of the title [pixels]
  double margin;  ///< distance from the edges [pixels]
  double halo;

  explicit Style(int height)
      : text(std::max(9.0, 0.0245 * height)),
        title(1.3 * text),
        margin(0.035 * height),
        halo(std::max(1.0, 0.0032 * height)) {}
};

/// The layout of the legend. Drawing uses it, and the label layout keeps labels off its area.
struct LegendBox {
  std::string heading;
  Ticks ticks;  ///< in scaled units
  UnitScale scale;
  double bar_x = 0.0;
  double bar_y = 0.0;
  double bar_width = 0.0;
  double bar_height = 0.0;
  double tick_x = 0.0;
  Rectangle area;
};

LegendBox layout_legend(const Legend& legend, const Style& style, int width, int height) {
  LegendBox box;
  const Font& font = Font::builtin();
  box.scale = unit_scale(std::max(std::abs(legend.min), std::abs(legend.max)));
  box.heading = legend.quantity + " [" + std::string(box.scale.prefix) + legend.unit + "]";
  box.ticks = round_ticks(legend.min / box.scale.factor, legend.max / box.scale.factor, 5);
  double label_width = legend.slack.empty() ? 0.0 : font.measure(legend.slack, style.text).width;
  for (const double value : box.ticks.values) {
    label_width = std::max(label_width,
                           font.measure(fixed_text(value, box.ticks.decimals), style.text).width);
  }
  // The bar lies on whole pixels, so that its rows do not blend.
  box.bar_width = std::round(0.95 * style.text);
  box.bar_height = std::round(0.36 * height);
  const double labels = 0.5 * style.text + label_width;
  const double full_width =
      std::max(box.bar_width + labels, font.measure(box.heading, style.text).width);
  const double left = std::floor(width - style.margin - full_width);
  box.bar_x = left;
  box.bar_y = std::floor(0.5 * (height - box.bar_height));
  box.tick_x = box.bar_x + box.bar_width + 0.5 * style.text;
  const double above = 1.9 * style.text;
  const double below = legend.slack.empty() ? 0.5 * style.text : 2.2 * style.text;
  box.area = {left, box.bar_y - above, full_width, above + box.bar_height + below};
  return box;
}

void draw_legend(Canvas& canvas, const Legend& legend, const LegendBox& box, const Style& style) {
  const int rows = static_cast<int>(std::lround(box.bar_height));
  const double frame = std::max(1.0, 0.06 * style.text);
  canvas.fill(box.bar_x - frame, box.bar_y - frame, box.bar_width + 2.0 * frame, rows + 2.0 * frame,
              ink);
  for (int k = 0; k < rows; ++k) {
    canvas.fill(box.bar_x, box.bar_y + k, box.bar_width, 1.0,
                sample(legend.map, 1.0 - (k + 0.5) / rows));
  }
  canvas.text(box.area.x, box.area.y + style.text, box.heading, style.text, ink, style.halo);
  const double low = legend.min / box.scale.factor;
  const double high = legend.max / box.scale.factor;
  for (const double value : box.ticks.values) {
    const double y = box.bar_y + rows * (1.0 - (value - low) / (high - low));
    canvas.fill(box.bar_x + box.bar_width, y - 0.5 * frame, 0.3 * style.text, frame, ink);
    canvas.text(box.tick_x, y + 0.32 * style.text, fixed_text(value, box.ticks.decimals),
                style.text, ink, style.halo);
  }
  if (legend.slack.empty()) return;
  const double y = box.bar_y + rows + 1.1 * style.text;
  const double swatch = 0.55 * style.text;
  canvas.fill(box.bar_x - frame, y - frame, box.bar_width + 2.0 * frame, swatch + 2.0 * frame, ink);
  canvas.fill(box.bar_x, y, box.bar_width, swatch, slack_color);
  canvas.text(box.tick_x, y + 0.5 * swatch + 0.32 * style.text, legend.slack, style.text, ink,
              style.halo);
}

/// Draws a line of text, unless it is empty, and adds its rectangle to `occupied`.
void corner_text(Canvas& canvas, double x, double baseline, const std::string& text, double size,
                 const Color& color, double halo, std::vector<Rectangle>& occupied) {
  if (text.empty()) return;
  const TextSize extent = Font::builtin().measure(text, size);
  canvas.text(x, baseline, text, size, color, halo);
  occupied.push_back({x, baseline - extent.ascent, extent.width, extent.ascent + extent.descent});
}

std::vector<ScreenSegment> visible_lines(const DrawList& list, const Projector& projector) {
  std::vector<ScreenSegment> lines;
  for (const Tube& tube : list.tubes) {
    for (std::size_t i = 1; i < tube.points.size(); ++i) {
      const auto a = projector.project(tube.points[i - 1].position);
      const auto b = projector.project(tube.points[i].position);
      if (a && b) lines.push_back({a->x, a->y, b->x, b->y});
    }
  }
  return lines;
}

/// Rectangles round the solids in the picture.
std::vector<Rectangle> visible_bodies(const DrawList& list, const Projector& projector) {
  std::vector<Rectangle> bodies;
  for (const Solid& solid : list.solids) {
    const Eigen::AlignedBox3d box = bounds(solid);
    if (box.isEmpty()) continue;
    Eigen::AlignedBox2d seen;
    for (int i = 0; i < 8; ++i) {
      const Vector3 corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
      if (const auto p = projector.project(corner)) seen.extend(Eigen::Vector2d(p->x, p->y));
    }
    if (seen.isEmpty()) continue;
    bodies.push_back({seen.min().x(), seen.min().y(), seen.sizes().x(), seen.sizes().y()});
  }
  return bodies;
}

/// The request for a label's place; nothing if its anchor is not in the picture.
std::optional<LabelRequest> request_place(const Label& label, const Projector& projector,
                                          const Style& style, const Canvas& canvas) {
  const auto anchor = projector.project(label.anchor);
  if (label.text.empty() || !anchor || anchor->x < 0.0 || anchor->x > canvas.width() ||
      anchor->y < 0.0 || anchor->y > canvas.height()) {
    return std::nullopt;
  }
  LabelRequest request{.x = anchor->x, .y = anchor->y};
  request.width = Font::builtin().measure(label.text, style.text).width;
  request.height = 0.95 * style.text;
  if (label.direction.norm() > 0.0) {
    // The step is short, so that the tip of a direction towards the eye stays in front of the eye.
    const double step = 1e-3 * anchor->depth / label.direction.norm();
    if (const auto tip = projector.project(label.anchor + label.direction * step)) {
      request.direction_x = tip->x - anchor->x;
      request.direction_y = tip->y - anchor->y;
    }
  }
  if (const auto moved = projector.project(label.anchor + label.slide)) {
    request.slide_x = moved->x - anchor->x;
    request.slide_y = moved->y - anchor->y;
  }
  return request;
}

/// Draws a thin line from the anchor to the nearest point of the text, unless the text is near and
/// covers nothing.
void draw_leader(Canvas& canvas, const LabelPlace& place, const Style& style) {
  const Rectangle& r = place.text;
  const double x = std::clamp(place.anchor_x, r.x - 2.0, r.x + r.width + 2.0);
  const double y = std::clamp(place.anchor_y, r.y, r.y + r.height);
  const double away = std::hypot(x - place.anchor_x, y - place.anchor_y);
  if (away < (place.covers ? 0.1 : 1.3) * style.text) return;
  const double width = std::max(1.0, 0.07 * style.text);
  canvas.line(place.anchor_x, place.anchor_y, x, y, width + 2.0 * style.halo, rgb(0xffffff), 0.6);
  canvas.line(place.anchor_x, place.anchor_y, x, y, width, soft_ink, 0.9);
}

void draw_labels(Canvas& canvas, const DrawList& list, const Projector& projector,
                 const Style& style, const std::vector<Rectangle>& occupied) {
  std::vector<LabelRequest> requests;
  std::vector<const Label*> shown;
  for (const Label& label : list.labels) {
    if (const auto request = request_place(label, projector, style, canvas)) {
      requests.push_back(*request);
      shown.push_back(&label);
    }
  }
  if (requests.empty()) return;
  const std::vector<ScreenSegment> lines = visible_lines(list, projector);
  const std::vector<Rectangle> bodies = visible_bodies(list, projector);
  const LabelSurroundings around{static_cast<double>(canvas.width()),
                                 static_cast<double>(canvas.height()),
                                 0.75 * style.text,
                                 occupied,
                                 lines,
                                 bodies};
  const std::vector<LabelPlace> places = place_labels(requests, around);
  for (const LabelPlace& place : places) draw_leader(canvas, place, style);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Rectangle& r = places[i].text;
    canvas.text(r.x, r.y + 0.5 * r.height + 0.32 * style.text, shown[i]->text, style.text,
                shown[i]->color, style.halo);
  }
}

std::string time_text(double time) { return "t = " + fixed_text(time, 2) + " s"; }

}  // namespace

void draw_overlay(const DrawList& list, const Camera& camera, Canvas& canvas) {
  const Style style(canvas.height());
  const Projector projector(camera, canvas.width(), canvas.height());
  std::vector<Rectangle> occupied;
  double baseline = style.margin;
  if (!list.title.empty()) {
    baseline += 0.75 * style.title;
    corner_text(canvas, style.margin, baseline, list.title, style.title, ink, style.halo, occupied);
    baseline += 0.45 * style.title;
  }
  if (list.time) {
    corner_text(canvas, style.margin, baseline + 0.8 * style.text, time_text(*list.time),
                style.text, soft_ink, style.halo, occupied);
  }
  corner_text(canvas, style.margin, canvas.height() - style.margin, list.caption, style.text,
              soft_ink, style.halo, occupied);
  std::optional<LegendBox> legend;
  if (list.legend) {
    legend = layout_legend(*list.legend, style, canvas.width(), canvas.height());
    occupied.push_back(legend->area);
  }
  draw_labels(canvas, list, projector, style, occupied);
  if (legend) draw_legend(canvas, *list.legend, *legend, style);
}

Margins overlay_margins(const DrawList& list, int width, int height) {
  const Style style(height);
  Margins margins;
  const double above = (list.title.empty() ? 0.0 : style.title) + (list.time ? style.text : 0.0);
  if (above > 0.0) margins.top = (style.margin + above + 0.5 * style.text) / height;
  if (!list.caption.empty()) margins.bottom = (style.margin + 2.0 * style.text) / height;
  if (list.legend) {
    const LegendBox box = layout_legend(*list.legend, style, width, height);
    margins.right = (width - box.area.x + style.text) / width;
  }
  for (double* side : {&margins.left, &margins.right, &margins.top, &margins.bottom}) {
    *side = std::min(*side, 0.45);
  }
  return margins;
}

}  // namespace sheave::render
