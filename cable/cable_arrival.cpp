// Attachments that reach a wheel, a pinhole or the end of a sheath.
//
// An attachment holds the cable at one of its points. Cable that comes to a wheel is laid onto it. If
// the cable is drawn on, the attachment reaches the point where its span touches the rim. The rope
// between the two then has no length: an elastic rope of the length l has the stiffness EA / l, which
// has no bound there, and the attachment itself would have to be laid onto the wheel, which the model
// cannot do. The motion therefore ends there. On a wrappable body the cable beyond the attachment
// comes to lie as any span does, and the attachment rides over the body by the contact of colliders.
//
// Arrival is a matter of the positions alone, whatever the law of the rope. At the start of the
// substep the span touches the wheel at P, and the attachment is at A = P + l u with the unit vector
// u along the span. At the end, seen from the wheel's carrier, the attachment is at A'. The attachment
// has passed P if (A' - P).u < 0, that is, if the attachment has moved by more than l along the span.
// The way from A to A' then crosses the plane through P normal to u. The attachment has met the rim
// there unless this way passes outside of the rim, or beside the rim along the axle. At the distance
// r + d from the axle a point outside the rim keeps a free length of sqrt(2 r d) or more, so a point
// that passes the wheel is told from one that arrives as soon as substeps resolve this length; nearer
// than r / 100 and faster than that it counts as arrived. A rope that is slack by more than r / 100
// pulls nothing to the rim, and an attachment may fly past it. An attachment that rests at the rim,
// as with a drive that has stalled, does not arrive, because it does not move, nor does one that
// begins there and moves off.
//
// A pinhole or the end of a sheath is a point P, and no attachment goes through it. An attachment that
// passes the plane through P within a tenth of its way in the substep arrives; farther from P its
// rope turns about P, which substeps resolve.
//
// An attachment between two spans has a second condition: the span on its other side must not cut the
// wheel. A wheel that draws in a rigid rope has drawn in everything before such an attachment when the
// length of the span is 0.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/link_contact.h"
#include "cable/span_contact.h"
#include "engine/index.h"
#include "engine/math/turn_between.h"

namespace sheave {
namespace {

/// Nearer to the rim than this, an attachment is at the rim; relative to the radius.
constexpr double at_rim = 0.01;

/// Beyond this distance another part of the cable crosses the wheel, not the attachment; times the
/// perimeter: two radii.
constexpr double beside_wheel = 2.0 / (2.0 * pi);

/// Motions since the start of the substep that move a point of a link: of its carrier, by
/// translation and by rotation, and of a wheel on its carrier.
struct PointWay {
  double translation = 0.0;  ///< square [m2]
  double rotation = 0.0;     ///< square [m2]
  double spin = 0.0;         ///< square [m2]

  [[nodiscard]] double sum_of_squares() const { return translation + rotation + spin; }
  /// Largest way of the point [m].
  [[nodiscard]] double most() const {
    return std::sqrt(translation) + std::sqrt(rotation) + std::sqrt(spin);
  }
};

PointWay way_of(const Substep& substep, int carrier, const Vector3& point) {
  if (carrier == substep.bodies.count()) return {};
  const int mount = substep.bodies[carrier].mount;
  const auto rotation_of = [&](int body) {
    const MovingBody& moving = substep.moving[at(body)];
    return moving.turn.squaredNorm() * (point - substep.position(body)).squaredNorm();
  };
  const int body = mount >= 0 ? mount : carrier;
  const MovingBody& moving = substep.moving[at(body)];
  return {(moving.position - moving.start_position).squaredNorm(), rotation_of(body),
          mount >= 0 ? rotation_of(carrier) : 0.0};
}

/// Whether the ends of a span may have passed each other since the start of the substep: then they
/// are no farther apart than both have moved.
bool may_have_met(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                  const SpanGeometry& span) {
  constexpr double more = 1.001;
  const PointWay start =
      way_of(substep, first.sheath ? first.exit_body() : first.carrier, span.start);
  const PointWay end = way_of(substep, second.carrier, span.end);
  // The square of a sum of six is at most six times the sum of the squares: no root is taken mostly.
  const double squares = 6.0 * more * more * (start.sum_of_squares() + end.sum_of_squares());
  return span.length * span.length <= squares && span.length <= more * (start.most() + end.most());
}

/// Whether the motion of the body is given: a pointer may lead it through a wheel or a pinhole, and a
/// warning tells of it.
bool is_led(const BodySet& bodies, int body) {
  return body < bodies.count() && bodies[body].mobility == Mobility::kinematic;
}

/// The rotation of the wheel since the start of the substep, without its spin.
Quaternion turn_of(const Substep& start, const Substep& now, const LinkGeometry& wheel) {
  const bool spins = wheel.carrier == wheel.body && !wheel.outline && !wheel.geodesic;
  if (spins) {
    return turn_between(start.orientation(wheel.carrier) * wheel.normal,
                        now.orientation(wheel.carrier) * wheel.normal);
  }
  return now.orientation(wheel.carrier) * start.orientation(wheel.carrier).conjugate();
}

/// Whether cable passes the link in one point.
bool is_eye(const LinkGeometry& link) { return link.slides || link.sheath != nullptr; }

/// Whether an attachment that was at `from` and is at `now`, seen from a pinhole, has met it.
bool meets_eye(const Vector3& from, const Vector3& now, double size) {
  constexpr double rounding = 1e-12;
  constexpr double beside = 0.1;  // of the way
  const double length = from.norm();
  if (length < rounding * size) return false;
  const double left = dot(now, from) / length;
  const double way = length - left;
  if (left > 1e-9 * length || way < 1e-9 * size) return false;
  return (from + length / way * (now - from)).norm() < beside * way;
}

/// A place of a wheel's rim where a span touches it, and the attachment at the span's other end.
struct RimContact {
  Vector3 rim = Vector3::Zero();         ///< P [m]
  Vector3 away = Vector3::Zero();        ///< u, from the rim to the attachment
  Vector3 axle = Vector3::Zero();        ///< unit normal of the plane of the rim
  Vector3 outward = Vector3::Zero();     ///< unit normal of the rim in its plane
  Vector3 attachment = Vector3::Zero();  ///< A [m]
};

/// Of a span at the start of the substep; `geodesic`: that of the wheel then, or null.
RimContact contact_of(const Substep& start, const LinkGeometry& wheel, const SpanGeometry& span,
                      bool wheel_first, const GeodesicLink* geodesic) {
  RimContact contact;
  contact.rim = wheel_first ? span.start : span.end;
  contact.away = wheel_first ? span.direction : Vector3(-span.direction);
  contact.axle =
      circle_of(start, wheel, wheel_first ? span.first_corner : span.second_corner).normal;
  contact.attachment = wheel_first ? span.end : span.start;
  if (geodesic != nullptr) {
    const SurfaceFrame& end = wheel_first ? geodesic->exit : geodesic->entry;
    const Quaternion frame = start.orientation(wheel.carrier);
    contact.rim = start.point(wheel.carrier, end.point);
    contact.away = frame * (wheel_first ? end.tangent : Vector3(-end.tangent));
    contact.axle = frame * end.across();
    contact.outward = frame * end.outward;
    return contact;
  }
  const double side = (wheel.side > 0) == wheel_first ? 1.0 : -1.0;
  contact.outward = side * cross(contact.away, contact.axle);
  return contact;
}

/// Whether an attachment that has moved to `now`, seen from the wheel's carrier, has met the rim of
/// this radius. `rests`: only a way that is no residual counts.
bool meets_rim(const RimContact& contact, const Vector3& now, double radius, bool rests) {
  // The square of a free length is a difference of squares of about r^2, so lengths below 1e-8 r are
  // rounding, whose square is twice the machine's epsilon.
  constexpr double resolved = 1e-7;
  const double least_way = (rests ? 1e-6 : 1e-9) * radius;
  const double length = dot(contact.attachment - contact.rim, contact.away);
  const double left = dot(now - contact.rim, contact.away);
  if (left > resolved * radius || length - left < least_way) return false;
  const double share = std::clamp(length / (length - left), 0.0, 1.0);
  const Vector3 crossing = contact.attachment + share * (now - contact.attachment) - contact.rim;
  const double above = dot(crossing, contact.outward);
  return above < at_rim * radius && above > -radius &&
         std::abs(dot(crossing, contact.axle)) < at_rim * radius;
}

}  // namespace

cable_parts::Arrival cable_parts::arrival_on(const SpanSetup& span,
                                             const std::vector<LinkGeometry>& links) {
  const LinkGeometry& first = links[at(span.first)];
  const bool wheel_first = first.wraps() || is_eye(first);
  const int attachment = wheel_first ? span.second : span.first;
  const LinkGeometry& wheel = links[at(wheel_first ? span.first : span.second)];
  Arrival arrival{span.cable, attachment, links[at(attachment)].touched(),
                  wheel_first ? span.first : span.second, wheel.touched()};
  if (wheel.sheath) {
    arrival.place = "the end of the sheath";
    arrival.body = wheel_first ? wheel.exit_body() : wheel.body;
  } else if (is_eye(wheel)) {
    arrival.place = "the pinhole";
  }
  return arrival;
}

std::string cable_parts::sentence_of(const Arrival& arrival, const CompiledCable& cable,
                                     const BodySet& bodies) {
  const auto name_of = [&](int link, int body) {
    const std::string name = body == bodies.count() ? "the world" : "\"" + bodies.name(body) + "\"";
    // Wraps follow the links of the list.
    if (link > cable.last_listed_link()) return name;
    return "link " + std::to_string(link - cable.first_link) + " on " + name;
  };
  const std::string reached = "cable \"" + cable.name + "\": its attachment, " +
                              name_of(arrival.attachment, arrival.attached) + ", has reached " +
                              std::string(arrival.place) + " of " +
                              name_of(arrival.wheel, arrival.body);
  const auto& between = cable.grips;
  if (std::find(between.begin(), between.end(), arrival.attachment) == between.end()) {
    return reached + ", and no cable is left between them: end the run before that";
  }
  if (arrival.place != Arrival().place) {
    return reached + ", and attachments do not pass through: end the run or the cable before that";
  }
  if (arrival.body < bodies.count() && bodies.definition(arrival.body).wrappable) {
    return reached +
           ", and nothing keeps it outside: give both bodies colliders, so that the attachment "
           "rides over the wheel";
  }
  return reached +
         ", and attachments do not pass grooves: end the run or the cable before that; or let the "
         "attachment ride over the wheel, by a surface link, a body that is \"wrappable\", and "
         "colliders of both bodies";
}

/// Visits (attachment, span to a wheel, the wheel, span on the attachment's other side).
template <class Visit>
void CableSystem::for_each_grip(Visit visit) const {
  for (const CompiledCable& cable : cables_) {
    // Only a wheel in whose groove the cable beyond the attachment cannot come to lie counts.
    const auto is_wrappable = [&](int wheel) {
      const auto has_body = [&](const WrapCandidate& candidate) {
        return candidate.listed < 0 && candidate.body == links_[at(wheel)].touched();
      };
      return std::any_of(cable.candidates.begin(), cable.candidates.end(), has_body);
    };
    for (const int link : cable.grips) {
      const int out = span_after(cable, link);
      const int in = span_before(cable, link, spans_);
      if (in < 0 || !spans_[at(out)].active) continue;
      const int ahead = spans_[at(out)].second;
      const int behind = spans_[at(in)].first;
      visit(link, out, is_wrappable(ahead) ? link : ahead, in);
      visit(link, in, is_wrappable(behind) ? link : behind, out);
    }
  }
}

void CableSystem::begin_arrivals(const Substep& substep) {
  clear_grips_.clear();
  for_each_grip([&](int, int span, int wheel, int beyond) {
    const LinkGeometry& link = links_[at(wheel)];
    // A taut span without weight is at least as long as its rope. If that is far more than the
    // distance at which the other span counts, only arrives() asks.
    const bool far = !weighs_ && start_tensions_[at(span)] > 0.0 &&
                     references_[at(span)].rest_length > 2.0 * beside_wheel * link.perimeter();
    const bool watched = link.wraps() && !far && wheel != spans_[at(beyond)].first &&
                         wheel != spans_[at(beyond)].second;
    clear_grips_.push_back(watched &&
                           !clearance(substep, link, geometry_of(substep, beyond)).cuts(link));
  });
}

void CableSystem::check_arrivals(const Substep& substep) {
  constexpr double spent = 1e-9;
  std::size_t visited = 0;
  for_each_grip([&](int, int span, int wheel, int beyond) {
    const LinkGeometry& link = links_[at(wheel)];
    if (clear_grips_[visited++] == 0) return;
    const double length = geometry_of(substep, span).length;
    // A driven wheel has drawn in all cable before the attachment.
    if (driven_ && drive_work_.stalled[at(wheel)] != 0 && length < spent * link.perimeter()) {
      arrived_ = cable_parts::arrival_on(spans_[at(span)], links_);
      return;
    }
    if (length > beside_wheel * link.perimeter()) return;
    if (!clearance(substep, link, geometry_of(substep, beyond)).cuts(link)) return;
    arrived_ = cable_parts::arrival_on(spans_[at(span)], links_);
  });
  if (substep.at_rest) return;
  for (int k = 0; k < span_count(); ++k) {
    // An affine span is too long to vanish within the substep.
    const SpanSetup& setup = spans_[at(k)];
    if (!setup.active || is_affine_[at(k)] != 0) continue;
    const bool wraps = links_[at(setup.first)].wraps() || links_[at(setup.second)].wraps();
    if (!(wraps ? arrives(substep, k) : reaches_eye(substep, k))) continue;
    arrived_ = cable_parts::arrival_on(spans_[at(k)], links_);
  }
}

bool CableSystem::arrives(const Substep& substep, int span) const {
  const SpanSetup& setup = spans_[at(span)];
  const bool wheel_first = links_[at(setup.first)].wraps();
  const int link = wheel_first ? setup.first : setup.second;
  const LinkGeometry& wheel = links_[at(link)];
  const LinkGeometry& point = links_[at(wheel_first ? setup.second : setup.first)];
  if (point.wraps() || point.hybrid) return false;
  const SpanGeometry geometry = geometry_of(substep, span);
  const Vector3& place = wheel_first ? geometry.end : geometry.start;
  if (!may_have_met(substep, links_[at(setup.first)], links_[at(setup.second)], geometry) ||
      is_led(substep.bodies, point.body)) {
    return false;
  }
  if (point.body < substep.bodies.count()) {
    const Mobility mobility = substep.bodies[point.body].mobility;
    // A drive stalls where it has drawn in a rigid rope. A weight on a rail at its end comes back to
    // the rim there, and hangs from it.
    const CompiledCable& cable = cables_[at(setup.cable)];
    const int last = wheel_first ? setup.second : setup.first;
    const bool held = substep.bodies[wheel.body].prescribed() && cable.is_rigid() &&
                      (last == cable.first_link || last == cable.last_listed_link());
    if (held && mobility == Mobility::slider) return false;
  }
  const Substep start(substep.bodies, substep.start, substep.h, 1);
  const SpanGeometry before =
      span_geometry(start, setup, links_[at(setup.first)], links_[at(setup.second)]);
  const GeodesicLink* geodesic = wheel.geodesic ? &geodesic_starts_[at(link)] : nullptr;
  const RimContact contact = contact_of(start, wheel, before, wheel_first, geodesic);
  const Quaternion back = turn_of(start, substep, wheel).conjugate();
  const Vector3 now = link_center(start, wheel) + back * (place - link_center(substep, wheel));
  // An attachment at rest moves by the residual of the solver only: where a drive has stalled, and
  // inside the rim, where the user has placed it.
  const bool rests = !before.has_tangent || drive_work_.locked[at(link)] != 0;
  const double radius = wheel.perimeter() / (2.0 * pi);
  const double spare = references_[at(span)].rest_length - before.length;
  const bool slack = start_tensions_[at(span)] == 0.0 && multipliers_[at(span)] == 0.0;
  if (slack && spare > at_rim * radius) return false;
  return meets_rim(contact, now, radius, rests);
}

bool CableSystem::reaches_eye(const Substep& substep, int span) const {
  const SpanSetup& setup = spans_[at(span)];
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  const bool eye_first = is_eye(first);
  const LinkGeometry& point = eye_first ? second : first;
  if (eye_first == is_eye(second) || point.hybrid) return false;
  if (start_tensions_[at(span)] == 0.0 || multipliers_[at(span)] == 0.0) return false;  // slack
  const SpanGeometry* const known = known_.find(span);
  const bool met = known != nullptr
                       ? may_have_met(substep, first, second, *known)
                       : may_have_met(substep, first, second, geometry_of(substep, span));
  if (!met || is_led(substep.bodies, point.body)) return false;
  const Substep start(substep.bodies, substep.start, substep.h, 1);
  const auto apart = [&](const Substep& when) {
    const SpanGeometry geometry = span_geometry(when, setup, first, second);
    return Vector3(geometry.end - geometry.start);
  };
  return meets_eye(apart(start), apart(substep), substep.bodies.scale());
}

}  // namespace sheave
