#include "cable/cable_polyline.h"

#include <algorithm>
#include <cmath>

#include "cable/drum_groove.h"
#include "cable/slack_curve.h"

namespace sheave {
namespace {

constexpr double full_turn = 2.0 * pi;
/// largest number of turns drawn; the eye cannot tell more turns apart
constexpr double most_drawn_turns = 60.0;
constexpr double most_arc_steps = 7999.0;

/// Writes points as long as there is room, and counts them all.
class PolylineWriter {
 public:
  explicit PolylineWriter(std::span<Vector3> room) : room_(room) {}
  void add(const Vector3& point) {
    if (count_ < room_.size()) room_[count_] = point;
    ++count_;
  }
  /// Lets another function write a part.
  template <class Write>
  void append(Write write) {
    count_ += write(room_.subspan(std::min(count_, room_.size())));
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::span<Vector3> room_;
  std::size_t count_ = 0;
};

/// The place of a link in the course of its cable.
enum class LinkPlace { first, between, last };

/// The cable on a wheel as drawn: a shallow helix if it makes more than one turn.
struct DrawnWinding {
  double angle = 0.0;                ///< from entry to exit, in the direction of winding [rad]
  double shift = 0.0;                ///< along the normal, from entry to exit [m]
  Vector3 first = Vector3::Zero();   ///< unit vector from the axis towards the entry
  Vector3 second = Vector3::Zero();  ///< a quarter turn further along the cable
  bool leaves = false;               ///< the link is the cable's first one
};

LinkPlace place_of(const CableReport& cable, std::size_t link) {
  if (cable.closed) return LinkPlace::between;
  if (link == 0) return LinkPlace::first;
  return link + 1 == cable.links.size() ? LinkPlace::last : LinkPlace::between;
}

DrawnWinding winding_of(const LinkReport& link, LinkPlace place, double room, double radius) {
  DrawnWinding w;
  if (!(link.radius > 0.0)) return w;
  w.angle = wound_angle(link, place != LinkPlace::between);
  // Whole turns are left out, so that the entry and the exit keep their places.
  if (w.angle > most_drawn_turns * full_turn)
    w.angle = std::remainder(w.angle, full_turn) + most_drawn_turns * full_turn;
  // The first link of a cable has an exit only; its entry lies `angle` before the exit.
  const bool from_exit = w.leaves = place == LinkPlace::first;
  Vector3 out = (from_exit ? link.exit : link.entry) - link.center;
  out -= link.normal * link.normal.dot(out);
  out = out.norm() > 0.0 ? Vector3(out.normalized()) : any_perpendicular(link.normal);
  const Vector3 ahead = link.normal.cross(out) * static_cast<double>(link.winding);
  const double back = from_exit ? -w.angle : 0.0;
  w.first = out * std::cos(back) + ahead * std::sin(back);
  w.second = link.normal.cross(w.first) * static_cast<double>(link.winding);
  const double more_than_one = w.angle / full_turn - 1.0;
  if (more_than_one > 0.0 && !link.groove) {
    // The shift grows from zero, so that no point jumps in the frame in which the second turn
    // begins.
    const double grown = std::min(1.0, 8.0 * more_than_one);
    const double wanted = 2.15 * radius * w.angle / full_turn * grown;
    w.shift = std::min(wanted, std::max(0.0, room - 2.0 * radius));
  }
  return w;
}

DrawnWinding winding_of(const CableReport& cable, std::size_t link,
                        const PolylineOptions& options) {
  const double room = link < options.winding_room.size() ? options.winding_room[link] : 0.0;
  return winding_of(cable.links[link], place_of(cable, link), room, options.radius);
}

/// Number of chords of an arc that deviate from it by the tolerance at most: r (1 - cos(a/2)).
int arc_steps(double angle, double radius, double tolerance) {
  const double sagitta = std::clamp(tolerance / radius, 0.0, 0.29);  // at most 90 degrees per step
  const double step = 2.0 * std::acos(1.0 - sagitta);
  const double wanted = std::ceil(std::abs(angle) / step);
  return static_cast<int>(wanted < most_arc_steps ? std::max(wanted, 2.0) : most_arc_steps);
}

/// The rope along the groove of a drum, in the direction of the cable. `leaves`: the drum is the
/// cable's first link.
void add_groove(const LinkReport& link, bool leaves, const PolylineOptions& options,
                PolylineWriter& line) {
  const GrooveReport& groove = *link.groove;
  const double drawn = std::min(groove.wound, most_drawn_turns * full_turn);
  Vector3 out = (leaves ? link.exit : link.entry) - link.center;
  out -= link.normal * link.normal.dot(out);
  if (!(out.norm() > 0.0) || !(drawn > 0.0)) return;
  out.normalize();
  const Vector3 aside = link.normal.cross(out) * ((leaves ? -1.0 : 1.0) * link.winding);
  const int steps = arc_steps(drawn, link.radius, options.tolerance);
  for (int k = 0; k <= steps; ++k) {
    const double back = drawn * (leaves ? steps - k : k) / steps;
    const DrumGroove::Place place = groove.course->at(groove.wound - back);
    const double radius = std::sqrt(place.gain * place.gain - place.slope * place.slope);
    line.add(link.center + radius * (out * std::cos(back) + aside * std::sin(back)) +
             link.normal * (place.axial - groove.axial_position));
  }
}

void add_link(const LinkReport& link, const DrawnWinding& w, const PolylineOptions& options,
              PolylineWriter& line) {
  if (link.groove && link.winding != 0) return add_groove(link, w.leaves, options, line);
  for (const Vector3& corner : link.path) line.add(corner);
  if (!link.path.empty() || !(link.radius > 0.0) || w.angle == 0.0) return;
  const int steps = arc_steps(w.angle, link.radius, options.tolerance);
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    const double angle = w.angle * share;
    const Vector3 out = w.first * std::cos(angle) + w.second * std::sin(angle);
    line.add(link.center + out * link.radius + link.normal * (w.shift * (share - 0.5)));
  }
}

/// Lifts points that are below the floor onto it, except the ends.
void lift(const PolylineOptions& options, std::span<Vector3> points, std::size_t count) {
  if (!options.floor) return;
  for (std::size_t k = 1; k < std::min(points.size(), count - 1); ++k) {
    const double height =
        options.floor->normal.dot(points[k] - options.floor->point) - options.radius;
    if (height < 0.0) points[k] -= options.floor->normal * height;
  }
}

std::size_t write_curve(const SlackCurve& curve, const PolylineOptions& options,
                        std::span<Vector3> points) {
  curve.write(options.tolerance, points);
  return curve.point_count(options.tolerance);
}

/// A rope with weight on its floor: the part that hangs from the start, and the part that hangs from
/// the end. The line between both lies on the floor.
void add_lying_span(const SpanReport& span, const Vector3& start, const Vector3& end,
                    const PolylineOptions& options, PolylineWriter& line) {
  const double weight = (span.start_force + span.end_force).norm();
  const Vector3 up = -(span.start_force + span.end_force) / std::max(weight, 1e-300);
  const auto hang = [&](const Vector3& from, const Vector3& to, const Vector3& first,
                        const Vector3& last) {
    const double hung = (first + last).norm();
    if (!(hung > 0.0)) {
      line.add(from);
      line.add(to);
      return;
    }
    const double length = (span.rest_length - span.floored) * hung / weight;
    line.append([&](std::span<Vector3> points) {
      return write_curve(SlackCurve::of_forces(from, to, first, last, length), options, points);
    });
  };
  const Vector3 level = span.start_force - up * span.start_force.dot(up);
  hang(start, span.touches[0], span.start_force, -level);
  hang(span.touches[1], end, level, span.end_force);
}

void add_span(const SpanReport& span, const Vector3& start, const Vector3& end,
              const PolylineOptions& options, PolylineWriter& line) {
  if (span.floored > 0.0) {
    add_lying_span(span, start, end, options, line);
  } else if (span.hangs) {
    line.append([&](std::span<Vector3> points) {
      return write_curve(
          SlackCurve::of_forces(start, end, span.start_force, span.end_force, span.rest_length),
          options, points);
    });
  } else if (is_slack(span)) {
    line.append([&](std::span<Vector3> points) {
      const SlackCurve curve(start, end, span.rest_length, options.gravity);
      const std::size_t count = write_curve(curve, options, points);
      lift(options, points, count);
      return count;
    });
  } else {
    line.add(start);
    line.add(end);
  }
}

/// Half the shift towards one end of the winding. The neighbouring span is drawn to this place.
Vector3 offset(const LinkReport& link, const DrawnWinding& w, double side) {
  return link.normal * (0.5 * side * w.shift);
}

/// The end of a cut cable with cable on its wheel, as if the cable hung plumb from the wheel.
LinkReport plumb_end(const LinkReport& link, bool first, const Vector3& down) {
  LinkReport end;
  end.center = link.center;
  end.normal = link.normal;
  end.radius = link.radius;
  end.winding = link.winding;
  end.wrap_angle = link.wrap_angle;
  end.groove = link.groove;
  // The point at which a cable that runs straight down from the wheel, or up to it, touches the
  // wheel.
  const double side = first ? -link.winding : link.winding;
  end.entry = end.exit = link.center + side * link.radius * link.normal.cross(down);
  return end;
}

void add_plumb_line(const LinkReport& end, double length, bool first, const Vector3& down,
                    const PolylineOptions& options, PolylineWriter& line) {
  double upright = length;
  if (options.floor && options.floor->normal.dot(down) < 0.0) {
    const PolylineFloor& floor = *options.floor;
    const double height = floor.normal.dot(end.exit - floor.point) - options.radius;
    upright = std::clamp(height / -floor.normal.dot(down), 0.0, length);
  }
  const Vector3 foot = end.exit + upright * down;
  Vector3 aside = end.normal.cross(down);
  aside = aside.norm() > 1e-6 ? Vector3(aside.normalized()) : any_perpendicular(down);
  if (options.floor) aside -= options.floor->normal * options.floor->normal.dot(aside);
  const Vector3 tip = foot + (length - upright) * aside;
  const bool lies = upright < length;
  if (!first && lies) line.add(tip);
  line.add(first ? end.exit : foot);
  line.add(first ? foot : end.exit);
  if (first && lies) line.add(tip);
}

}  // namespace

bool is_slack(const SpanReport& span) {
  return !(span.tension > 0.0) && span.rest_length > span.length;
}

double wound_angle(const LinkReport& link, bool is_end) {
  if (is_end) return std::max(link.wrap_angle, 0.0);
  const Vector3 from = link.entry - link.center;
  const Vector3 to = link.exit - link.center;
  const double direct =
      static_cast<double>(link.winding) * std::atan2(link.normal.dot(from.cross(to)), from.dot(to));
  // `direct` is known up to whole turns; the wrap angle of the report tells the number of turns.
  return direct + full_turn * std::round((link.wrap_angle - direct) / full_turn);
}

std::size_t link_polyline(const CableReport& cable, std::size_t link,
                          const PolylineOptions& options, std::span<Vector3> points) {
  PolylineWriter line(points);
  const LinkReport& own = cable.links[link];
  if (!cable.cut) {
    add_link(own, winding_of(cable, link, options), options, line);
  } else if (place_of(cable, link) != LinkPlace::between && options.gravity.norm() > 0.0) {
    const LinkPlace place = place_of(cable, link);
    const double room = link < options.winding_room.size() ? options.winding_room[link] : 0.0;
    const LinkReport end = plumb_end(own, place == LinkPlace::first, options.gravity.normalized());
    add_link(end, winding_of(end, place, room, options.radius), options, line);
  }
  return line.count();
}

std::size_t span_polyline(const CableReport& cable, std::size_t span,
                          const PolylineOptions& options, std::span<Vector3> points) {
  PolylineWriter line(points);
  if (cable.cut) return 0;
  const std::size_t next = (span + 1) % cable.links.size();
  const SpanReport& own = cable.spans[span];
  add_span(own, own.start + offset(cable.links[span], winding_of(cable, span, options), 1.0),
           own.end + offset(cable.links[next], winding_of(cable, next, options), -1.0), options,
           line);
  return line.count();
}

std::size_t piece_polyline(const CableReport& cable, std::size_t piece,
                           const PolylineOptions& options, std::span<Vector3> points) {
  PolylineWriter line(points);
  if (!cable.cut || cable.closed || piece > 1) return 0;
  const double strength = options.gravity.norm();
  const Vector3 down = strength > 0.0 ? Vector3(options.gravity / strength) : -Vector3::UnitY();
  const bool first = piece == 0;
  const std::size_t link = first ? 0 : cable.links.size() - 1;
  const LinkReport& own = cable.links[link];
  const auto wound = [&](std::span<Vector3> room) {
    return link_polyline(cable, link, options, room);
  };
  if (first) line.append(wound);
  const double length = cable.pieces[piece] - own.stored_length;
  if (length > 0.0) {
    add_plumb_line(plumb_end(own, first, down), length, first, down, options, line);
  }
  if (!first) line.append(wound);
  return line.count();
}

std::size_t cable_polyline(const CableReport& cable, std::size_t span,
                           const PolylineOptions& options, std::span<Vector3> points) {
  if (cable.cut) return piece_polyline(cable, span, options, points);
  PolylineWriter line(points);
  const std::size_t next = (span + 1) % cable.links.size();
  const DrawnWinding before = winding_of(cable, span, options);
  const DrawnWinding after = winding_of(cable, next, options);
  add_link(cable.links[span], before, options, line);
  const SpanReport* own = &cable.spans[span];
  Vector3 start = own->start + offset(cable.links[span], before, 1.0);
  for (const WrapReport& wrap : cable.wraps) {
    if (wrap.after != static_cast<int>(span)) continue;
    add_span(*own, start, own->end, options, line);
    add_link(wrap.link, winding_of(wrap.link, LinkPlace::between, 0.0, options.radius), options,
             line);
    own = &wrap.span;
    start = own->start;
  }
  add_span(*own, start, own->end + offset(cable.links[next], after, -1.0), options, line);
  const bool ends = !cable.closed && next + 1 == cable.links.size();
  if (ends) add_link(cable.links[next], after, options, line);
  return line.count();
}

}  // namespace sheave
