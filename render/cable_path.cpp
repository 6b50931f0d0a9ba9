#include "render/cable_path.h"

#include <cstddef>
#include <utility>

namespace sheave::render {
namespace {

PolylineOptions polyline_options(const CableStyle& style) {
  PolylineOptions options;
  options.tolerance = style.tolerance;
  options.gravity = style.gravity;
  options.radius = style.radius;
  options.winding_room = style.winding_room;
  if (style.floor) options.floor = PolylineFloor{style.floor->point, style.floor->normal};
  return options;
}

using WriteLine = std::size_t (*)(const CableReport&, std::size_t, const PolylineOptions&,
                                  std::span<Vector3>);

/// A line that is written in two rounds, because the first one tells its number of points.
std::vector<Vector3> line_of(WriteLine write, const CableReport& cable, std::size_t index,
                             const CableStyle& style) {
  const PolylineOptions options = polyline_options(style);
  std::vector<Vector3> line(write(cable, index, options, {}));
  write(cable, index, options, line);
  return line;
}

double length_of(const std::vector<Vector3>& line) {
  double sum = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
  return sum;
}

/// The line on a link, where it is long enough to blend the colours of its spans.
std::vector<Vector3> blended_line(const CableReport& cable, std::size_t link,
                                  const CableStyle& style) {
  std::vector<Vector3> line = line_of(&link_polyline, cable, link, style);
  if (cable.links[link].path.empty() && length_of(line) < 2.0 * style.radius) line.clear();
  return line;
}

/// Builds the tubes link by link.
class Drawing {
 public:
  Drawing(const CableReport& cable, const CableStyle& style) : cable_(cable), style_(style) {}

  std::vector<Tube> run() {
    for (std::size_t i = 0; i < cable_.links.size(); ++i) {
      add_link(i);
      if (i < cable_.spans.size()) {
        const Color color = tension_color(cable_.spans[i].tension, style_);
        for (const Vector3& p : line_of(&span_polyline, cable_, i, style_)) add(p, color);
      }
    }
    // A belt ends at its start: at the entry of its first link, or at that link's point.
    const bool joined = cable_.closed && !cut_at_start_ && tubes_.empty();
    cut();
    if (joined && !tubes_.empty()) tubes_.front().closed = true;
    return std::move(tubes_);
  }

 private:
  void add(const Vector3& position, const Color& color) {
    current_.points.push_back({position, color});
  }
  void cut() {
    current_.radius = style_.radius;
    if (current_.points.size() > 1) tubes_.push_back(std::move(current_));
    current_ = Tube{};
  }

  void add_link(std::size_t i) {
    const std::vector<Vector3> line = blended_line(cable_, i, style_);
    if (line.empty()) {
      if (i == 0) cut_at_start_ = true;
      cut();
      return;
    }
    const std::size_t n = cable_.spans.size();
    const bool has_incoming = cable_.closed || i > 0;
    const std::size_t outgoing = i < n ? i : i - 1;
    const std::size_t incoming = has_incoming ? (i + n - 1) % n : outgoing;
    const Color from = tension_color(cable_.spans[incoming].tension, style_);
    const Color to = tension_color(cable_.spans[outgoing].tension, style_);
    for (std::size_t k = 0; k < line.size(); ++k) {
      const auto share = static_cast<float>(
          line.size() > 1 ? static_cast<double>(k) / static_cast<double>(line.size() - 1) : 0.5);
      add(line[k], mix(from, to, share));
    }
  }

  const CableReport& cable_;
  const CableStyle& style_;
  std::vector<Tube> tubes_;
  Tube current_;
  bool cut_at_start_ = false;
};

}  // namespace

Color tension_color(double tension, const CableStyle& style) {
  // A tension below a millionth of the scale is a zero with rounding errors.
  if (!(tension > 1e-6 * style.tension_max)) return slack_color;
  return sample(style.map, tension / style.tension_max);
}

std::vector<std::vector<Vector3>> span_lines(const CableReport& cable, const CableStyle& style) {
  std::vector<std::vector<Vector3>> lines;
  for (std::size_t k = 0; k < cable.spans.size(); ++k) {
    lines.push_back(line_of(&span_polyline, cable, k, style));
  }
  return lines;
}

std::vector<std::vector<Vector3>> link_lines(const CableReport& cable, const CableStyle& style) {
  std::vector<std::vector<Vector3>> lines;
  for (std::size_t i = 0; i < cable.links.size(); ++i) {
    lines.push_back(blended_line(cable, i, style));
  }
  return lines;
}

std::vector<std::vector<Vector3>> piece_lines(const CableReport& cable, const CableStyle& style) {
  return {line_of(&piece_polyline, cable, 0, style), line_of(&piece_polyline, cable, 1, style)};
}

Tube slack_tube(const std::vector<Vector3>& line, double radius) {
  Tube tube;
  tube.radius = radius;
  for (const Vector3& p : line) tube.points.push_back({p, slack_color});
  return tube;
}

std::vector<Tube> cable_tubes(const CableReport& cable, const CableStyle& style) {
  if (!cable.cut) return Drawing(cable, style).run();
  std::vector<Tube> tubes;
  for (const std::vector<Vector3>& line : piece_lines(cable, style)) {
    if (line.size() > 1) tubes.push_back(slack_tube(line, style.radius));
  }
  return tubes;
}

}  // namespace sheave::render
