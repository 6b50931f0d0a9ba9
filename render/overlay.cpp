#include "render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "render/font.h"
#include "render/label_layout.h"
#include "render/number_text.h"
#include "render/overlay_marks.h"
#include "render/text_lines.h"

namespace sheave::render {
namespace {

constexpr Color ink = rgb(0x1b2430);
constexpr Color soft_ink = rgb(0x4a5563);
/// Distance of the lines of a caption, in heights of their text.
constexpr double line_height = 1.2;

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
  [[nodiscard]] MarkStyle marks() const { return {text, margin, halo}; }
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

/// Draws a line with an arrowhead from the nearest point of the text to the anchor.
void draw_arrow(Canvas& canvas, const LabelPlace& place, const Style& style) {
  constexpr double half_angle = 0.42;  // of the head [rad]
  const Rectangle& r = place.text;
  const double x = std::clamp(place.anchor_x, r.x - 2.0, r.x + r.width + 2.0);
  const double y = std::clamp(place.anchor_y, r.y, r.y + r.height);
  const double back = std::atan2(y - place.anchor_y, x - place.anchor_x);
  const double head =
      std::min(0.6 * style.text, 0.5 * std::hypot(x - place.anchor_x, y - place.anchor_y));
  std::vector<ScreenSegment> lines{{place.anchor_x, place.anchor_y, x, y}};
  for (const double side : {back - half_angle, back + half_angle}) {
    lines.push_back({place.anchor_x, place.anchor_y, place.anchor_x + head * std::cos(side),
                     place.anchor_y + head * std::sin(side)});
  }
  const double width = std::max(1.0, 0.09 * style.text);
  for (const auto& [x0, y0, x1, y1] : lines) {
    canvas.line(x0, y0, x1, y1, width + 2.0 * style.halo, rgb(0xffffff), 0.6);
  }
  for (const auto& [x0, y0, x1, y1] : lines) canvas.line(x0, y0, x1, y1, width, ink, 1.0);
}

using Leader = void (*)(Canvas&, const LabelPlace&, const Style&);

/// Draws labels at `gap` or more from their anchors, with leaders, and adds their rectangles to
/// `occupied`.
void draw_labels(Canvas& canvas, const DrawList& list, const std::vector<Label>& labels,
                 const Projector& projector, const Style& style, double gap, Leader leader,
                 std::vector<Rectangle>& occupied) {
  std::vector<LabelRequest> requests;
  std::vector<const Label*> shown;
  for (const Label& label : labels) {
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
                                 gap,
                                 occupied,
                                 lines,
                                 bodies};
  const std::vector<LabelPlace> places = place_labels(requests, around);
  for (const LabelPlace& place : places) leader(canvas, place, style);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Rectangle& r = places[i].text;
    canvas.text(r.x, r.y + 0.5 * r.height + 0.32 * style.text, shown[i]->text, style.text,
                shown[i]->color, style.halo);
  }
  for (const LabelPlace& place : places) occupied.push_back(place.text);
}

/// The legend's width, with its distance from the texts beside it [pixels].
double legend_room(const std::optional<LegendBox>& legend, int width, const Style& style) {
  return legend ? width - legend->area.x + style.text : style.margin;
}

/// The room at the right of a caption: for the legend, and for the axes below it [pixels].
double caption_room(const DrawList& list, const std::optional<LegendBox>& legend, int width,
                    const Style& style) {
  const double triad = list.axes ? 0.5 * style.margin + triad_side(style.marks()) : 0.0;
  return std::max(legend_room(legend, width, style), triad);
}

/// Lines of the title: the legend stands lower.
std::vector<std::string> title_lines(const std::string& title, const Style& style, int width) {
  return text_lines(title, style.title, width - 2.0 * style.margin);
}

/// Lines of the caption, beside the legend.
std::vector<std::string> caption_lines(const DrawList& list, const Style& style, int width,
                                       const std::optional<LegendBox>& legend) {
  return text_lines(list.caption, style.text,
                    width - style.margin - caption_room(list, legend, width, style));
}

std::string time_text(const DrawList& list) {
  const std::string end = list.duration ? " of " + fixed_text(*list.duration, 2) + " s" : "";
  return "t = " + fixed_text(*list.time, 2) + " s" + end;
}

/// Draws the time below the title, whose last baseline is given.
void draw_time(const DrawList& list, double above, Canvas& canvas, const Style& style,
               std::vector<Rectangle>& occupied) {
  const double baseline = above + 0.45 * style.title + 0.8 * style.text;
  corner_text(canvas, style.margin, baseline, time_text(list), style.text, soft_ink, style.halo,
              occupied);
  if (!list.duration) return;
  occupied.push_back(draw_time_line(*list.time, *list.duration, baseline, canvas, style.marks()));
}

}  // namespace

void draw_overlay(const DrawList& list, const Camera& camera, Canvas& canvas) {
  const Style style(canvas.height());
  const Projector projector(camera, canvas.width(), canvas.height());
  std::optional<LegendBox> legend;
  if (list.legend) legend = layout_legend(*list.legend, style, canvas.width(), canvas.height());
  std::vector<Rectangle> occupied;
  double baseline = style.margin - 0.45 * style.title;
  for (const std::string& line : title_lines(list.title, style, canvas.width())) {
    baseline += 1.2 * style.title;
    corner_text(canvas, style.margin, baseline, line, style.title, ink, style.halo, occupied);
  }
  if (list.time) draw_time(list, baseline, canvas, style, occupied);
  const auto caption = caption_lines(list, style, canvas.width(), legend);
  baseline = canvas.height() - style.margin -
             line_height * style.text * (static_cast<double>(caption.size()) - 1.0);
  for (const std::string& line : caption) {
    corner_text(canvas, style.margin, baseline, line, style.text, soft_ink, style.halo, occupied);
    baseline += line_height * style.text;
  }
  if (legend) occupied.push_back(legend->area);
  if (list.axes) occupied.push_back(draw_triad(camera, canvas, style.marks()));
  draw_labels(canvas, list, list.arrows, projector, style, 2.5 * style.text, draw_arrow, occupied);
  draw_labels(canvas, list, list.labels, projector, style, 0.75 * style.text, draw_leader,
              occupied);
  if (legend) draw_legend(canvas, *list.legend, *legend, style);
}

Margins overlay_margins(const DrawList& list, int width, int height) {
  const Style style(height);
  Margins margins;
  std::optional<LegendBox> legend;
  if (list.legend) {
    legend = layout_legend(*list.legend, style, width, height);
    margins.right = legend_room(legend, width, style) / width;
  }
  const auto titles = static_cast<double>(title_lines(list.title, style, width).size());
  const double above = std::max(0.0, 1.2 * titles - 0.2) * style.title +
                       (list.time ? style.text : 0.0) +
                       (list.time && list.duration ? time_line_height(style.marks()) : 0.0);
  if (above > 0.0) margins.top = (style.margin + above + 0.5 * style.text) / height;
  const auto captions = static_cast<double>(caption_lines(list, style, width, legend).size());
  if (captions > 0.0) {
    margins.bottom = (style.margin + (0.8 + line_height * captions) * style.text) / height;
  }
  for (double* side : {&margins.left, &margins.right, &margins.top, &margins.bottom}) {
    *side = std::min(*side, 0.45);
  }
  return margins;
}

}  // namespace sheave::render
