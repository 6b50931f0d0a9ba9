#include "render/cable_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/catenary.h"

namespace sheave::render {
namespace {

constexpr double whole_turn = 2.0 * pi;
constexpr double step_angle = 0.1;  ///< angle between points of the polyline round a wheel [rad]
/// largest number of turns drawn; the eye cannot tell more turns apart
constexpr double most_turns = 60.0;
constexpr int catenary_points = 41;

/// The cable on a wheel as drawn: a shallow helix if it makes more than one turn.
struct Winding {
  double angle = 0.0;  ///< from entry to exit, in the direction of winding [rad]
  double shift = 0.0;  ///< along the normal, from entry to exit [m]
  Vector3 first;       ///< unit vector from the axis towards the entry
  Vector3 second;      ///< a quarter turn further along the cable
};

bool is_end(const CableReport& cable, std::size_t link) {
  return !cable.closed && (link == 0 || link + 1 == cable.links.size());
}

Winding winding_of(const CableReport& cable, std::size_t index, const CableStyle& style) {
  const LinkReport& link = cable.links[index];
  Winding w;
  const bool end = is_end(cable, index);
  w.angle = wound_angle(link, end);
  // Whole turns are left out, so that the entry and the exit keep their places.
  if (w.angle > most_turns * whole_turn)
    w.angle = std::remainder(w.angle, whole_turn) + most_turns * whole_turn;
  // The first link of a cable has an exit only; its entry lies `angle` before the exit.
  const bool from_exit = end && index == 0;
  Vector3 out = (from_exit ? link.exit : link.entry) - link.center;
  out -= link.normal * link.normal.dot(out);
  out = out.norm() > 0.0 ? Vector3(out.normalized()) : any_perpendicular(link.normal);
  const Vector3 ahead = link.normal.cross(out) * static_cast<double>(link.winding);
  const double back = from_exit ? -w.angle : 0.0;
  w.first = out * std::cos(back) + ahead * std::sin(back);
  w.second = link.normal.cross(w.first) * static_cast<double>(link.winding);
  const double more_than_one = w.angle / whole_turn - 1.0;
  if (more_than_one > 0.0) {
    // The shift grows from zero, so that no point jumps in the frame in which the second turn
    // begins.
    const double grown = std::min(1.0, 8.0 * more_than_one);
    const double room = index < style.winding_room.size() ? style.winding_room[index] : 0.0;
    const double wanted = 2.15 * style.radius * w.angle / whole_turn * grown;
    w.shift = std::min(wanted, std::max(0.0, room - 2.0 * style.radius));
  }
  return w;
}

/// Half the shift towards one end of the winding. The neighbouring span is drawn to this place.
Vector3 offset_at(const LinkReport& link, const Winding& w, bool at_exit) {
  return link.normal * (at_exit ? 0.5 * w.shift : -0.5 * w.shift);
}

/// The line of a rope with weight. The tension at a share of its length is the force at its start
/// less that share of its weight, and the rope lies along its tension.
std::vector<Vector3> hang_by_weight(const SpanReport& span, const Vector3& start,
                                    const Vector3& end) {
  const Vector3 weight = span.start_force + span.end_force;
  std::vector<Vector3> points{Vector3::Zero()};
  for (int i = 0; i < catenary_points; ++i) {
    const double share = (i + 0.5) / catenary_points;
    points.push_back(points.back() + (span.start_force - share * weight).normalized());
  }
  // The sum has the length of the number of steps; the rest is the error of the sum and the stretch.
  const Vector3 reached = points.back();
  const double scale = (end - start).norm() / std::max(reached.norm(), 1e-300);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double share = static_cast<double>(i) / catenary_points;
    points[i] = start + scale * points[i] + share * (end - start - scale * reached);
  }
  return points;
}

std::vector<Vector3> hang(const SpanReport& span, const Vector3& start, const Vector3& end,
                          const CableStyle& style) {
  if (span.hangs) return hang_by_weight(span, start, end);
  if (!is_slack(span)) return {start, end};
  const Catenary catenary(start, end, span.rest_length, style.gravity);
  std::vector<Vector3> points = catenary.points(catenary_points);
  if (style.floor) {
    const Plane& floor = *style.floor;
    for (Vector3& p : points) {
      const double height = floor.normal.dot(p - floor.point) - style.radius;
      if (height < 0.0) p -= floor.normal * height;
    }
    points.front() = start;
    points.back() = end;
  }
  return points;
}

/// Builds the tubes link by link.
class Drawing {
 public:
  Drawing(const CableReport& cable, const CableStyle& style) : cable_(cable), style_(style) {
    for (std::size_t i = 0; i < cable.links.size(); ++i) {
      windings_.push_back(cable.links[i].radius > 0.0 ? winding_of(cable, i, style) : Winding{});
    }
  }

  [[nodiscard]] std::vector<Vector3> span_line(std::size_t k) const {
    const std::size_t next = (k + 1) % cable_.links.size();
    const SpanReport& span = cable_.spans[k];
    return hang(span, span.start + offset_at(cable_.links[k], windings_[k], true),
                span.end + offset_at(cable_.links[next], windings_[next], false), style_);
  }

  /// The line round a wheel or along an outline; empty where the tube is cut.
  [[nodiscard]] std::vector<Vector3> link_line(std::size_t i) const {
    const LinkReport& link = cable_.links[i];
    if (!link.path.empty()) return link.path;
    const Winding& w = windings_[i];
    std::vector<Vector3> line;
    // An arc that is too short to blend colours over cuts the tube.
    if (!(link.radius > 0.0) || std::abs(w.angle) * link.radius < 2.0 * style_.radius) return line;
    const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(w.angle) / step_angle)));
    for (int k = 0; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const double angle = w.angle * share;
      const Vector3 out = w.first * std::cos(angle) + w.second * std::sin(angle);
      line.emplace_back(link.center + out * link.radius + link.normal * (w.shift * (share - 0.5)));
    }
    return line;
  }

  std::vector<Tube> run() {
    for (std::size_t i = 0; i < cable_.links.size(); ++i) {
      add_link(i);
      if (i < cable_.spans.size()) {
        const Color color = tension_color(cable_.spans[i].tension, style_);
        for (const Vector3& p : span_line(i)) add(p, color);
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
    const std::vector<Vector3> line = link_line(i);
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
  std::vector<Winding> windings_;
  std::vector<Tube> tubes_;
  Tube current_;
  bool cut_at_start_ = false;
};

/// The pieces that hang from the ends of a cut cable; a cut belt has none.
std::vector<Tube> cut_pieces(const CableReport& cable, const CableStyle& style) {
  std::vector<Tube> tubes;
  if (cable.closed || !(style.gravity.norm() > 0.0)) return tubes;
  const Vector3 down = style.gravity.normalized();
  for (const bool first : {true, false}) {
    const LinkReport& end = first ? cable.links.front() : cable.links.back();
    // The point at which a cable that runs straight down from the wheel, or up to it, touches the
    // wheel.
    const double side = first ? -end.winding : end.winding;
    const Vector3 start = end.center + side * end.radius * end.normal.cross(down);
    double length = cable.pieces[first ? 0 : 1] - end.stored_length;
    if (style.floor && style.floor->normal.dot(down) < 0.0) {
      const double height = style.floor->normal.dot(start - style.floor->point) - style.radius;
      length = std::min(length, height / -style.floor->normal.dot(down));
    }
    if (!(length > 0.0)) continue;
    Tube tube;
    tube.radius = style.radius;
    tube.points = {{start, slack_color}, {start + length * down, slack_color}};
    tubes.push_back(std::move(tube));
  }
  return tubes;
}

}  // namespace

bool is_slack(const SpanReport& span) {
  return !(span.tension > 0.0) && span.rest_length > span.length;
}

Color tension_color(double tension, const CableStyle& style) {
  // A tension below a millionth of the scale is a zero with rounding errors.
  if (!(tension > 1e-6 * style.tension_max)) return slack_color;
  return sample(style.map, tension / style.tension_max);
}

double wound_angle(const LinkReport& link, bool is_end) {
  if (is_end) return std::max(link.wrap_angle, 0.0);
  const Vector3 from = link.entry - link.center;
  const Vector3 to = link.exit - link.center;
  const double direct =
      static_cast<double>(link.winding) * std::atan2(link.normal.dot(from.cross(to)), from.dot(to));
  // `direct` is known up to whole turns; the wrap angle of the report tells the number of turns.
  return direct + whole_turn * std::round((link.wrap_angle - direct) / whole_turn);
}

std::vector<std::vector<Vector3>> span_lines(const CableReport& cable, const CableStyle& style) {
  if (cable.cut) return std::vector<std::vector<Vector3>>(cable.spans.size());
  const Drawing drawing(cable, style);
  std::vector<std::vector<Vector3>> lines;
  for (std::size_t k = 0; k < cable.spans.size(); ++k) lines.push_back(drawing.span_line(k));
  return lines;
}

std::vector<std::vector<Vector3>> link_lines(const CableReport& cable, const CableStyle& style) {
  if (cable.cut) return std::vector<std::vector<Vector3>>(cable.links.size());
  const Drawing drawing(cable, style);
  std::vector<std::vector<Vector3>> lines;
  for (std::size_t i = 0; i < cable.links.size(); ++i) lines.push_back(drawing.link_line(i));
  return lines;
}

std::vector<Tube> cable_tubes(const CableReport& cable, const CableStyle& style) {
  if (cable.cut) return cut_pieces(cable, style);
  return Drawing(cable, style).run();
}

}  // namespace sheave::render
