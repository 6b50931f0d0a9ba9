#pragma once
// Contact of a span with a link; internal to the geometry of spans.

#include "cable/link_geometry.h"
#include "cable/span_row.h"
#include "engine/index.h"

namespace sheave {

/// Present centre of the link's circle. A body whose centre of mass is the centre needs no
/// rotation.
[[gnu::always_inline]] inline Vector3 center_of(const Substep& substep, const LinkGeometry& link,
                                                int corner) {
  if (link.outline) return substep.point(link.carrier, link.outline->corners[at(corner)]);
  if (link.still) return link.center;
  const bool on_mounted_rotor = link.mounted && link.carrier == link.body;
  if (link.centered) {
    return on_mounted_rotor ? substep.position(link.carrier)
                            : substep.moving[at(link.carrier)].position;
  }
  return substep.point(link.carrier, link.center);
}

/// Whether spans before and behind the link end at different points of it.
inline bool has_two_ends(const LinkGeometry& link) { return link.geodesic || link.sheath; }

/// The circle to which a span that leaves the link, or arrives at it, is tangent; for a geodesic
/// and a sheath their end, as a point.
inline LinkCircle end_circle(const Substep& substep, const LinkGeometry& link, int corner,
                             bool leaves) {
  if (link.sheath) {
    const std::vector<Vector3>& points = link.sheath->points;
    const Vector3& end = leaves ? points.back() : points.front();
    const int body = leaves ? link.sheath->exit_body : link.carrier;
    return {substep.point(body, end), Vector3::UnitZ(), 0.0};
  }
  if (!link.geodesic) return circle_of(substep, link, corner);
  const SurfaceFrame& end = leaves ? link.geodesic->exit : link.geodesic->entry;
  return {substep.point(link.carrier, end.point), Vector3::UnitZ(), 0.0};
}

/// Whether the link's geodesic, if it has one, exists for the present positions.
inline bool is_settled(const LinkGeometry& link) {
  return !link.geodesic || link.geodesic->settled;
}

/// Whether both ends of a span move with one rigid body, so that its length cannot change. Such a
/// span needs no row: its gradient is rounding error, and a force along it would be 1e16 times too
/// large.
[[gnu::always_inline]] inline bool on_one_body(const LinkGeometry& first,
                                               const LinkGeometry& second) {
  return first.body == second.body && first.carrier == first.body && second.carrier == second.body;
}

/// The same of a span whose first link may be a sheath from another body.
inline bool leaves_one_body(const LinkGeometry& first, const LinkGeometry& second) {
  if (!first.sheath) return on_one_body(first, second);
  return first.exit_body() == second.body && second.carrier == second.body;
}

/// Adds a unit force along `direction` at the world point `point` of a body that is no mounted rotor.
[[gnu::always_inline]] inline void add_body_force(const Substep& substep, Row& row, int on,
                                                  const Vector3& point, const Vector3& direction) {
  const MovingBody& body = substep.moving[at(on)];
  if (!body.translates && !body.rotates && !body.prescribed) return;
  const Vector3 arm = point - body.position;
  row.add(on, direction, cross(arm, direction), dot(arm, direction));
}

/// Adds a unit force along `direction` at the world point `point` of the link's body.
[[gnu::always_inline]] inline void add_link_force(const Substep& substep, Row& row,
                                                  const LinkGeometry& link, const Vector3& point,
                                                  const Vector3& direction) {
  if (link.mounted) {
    substep.add_force(row, link.body, point, direction);
    return;
  }
  add_body_force(substep, row, link.body, point, direction);
}

/// The same for the first link of a span in space, which may be a sheath from another body.
inline void add_exit_force(const Substep& substep, Row& row, const LinkGeometry& link,
                           const Vector3& point, const Vector3& direction) {
  if (link.exit_body() == link.body) return add_link_force(substep, row, link, point, direction);
  add_body_force(substep, row, link.exit_body(), point, direction);
}

/// Gives the row the rate at which the span's direction turns with its ends.
[[gnu::always_inline]] inline void tell_turning(const SpanGeometry& span, Row& row) {
  if (!span.has_tangent || !(span.length > 0.0)) return;
  row.curved = true;
  row.turning = 1.0 / span.length;
}

/// Unit vector from the centre of `circle` to `point`, where a span along `direction` meets it. If
/// the span leans out of the circle's plane, the contact is farther from the axle
/// (cable/span_geometry.h).
inline Vector3 radial(const LinkCircle& circle, const Vector3& point, const Vector3& direction) {
  const double lean = dot(circle.normal, direction);
  const Vector3 arm = point - circle.center;
  return arm / (lean * lean < 1e-16 ? std::abs(circle.signed_radius) : arm.norm());
}

/// Outward unit normal at the contact of a span with its link, in the link's plane. On a circle the
/// tangent point determines it. A corner of an outline may have no radius; there the direction
/// determines it.
inline Vector3 contact_normal(const Substep& substep, const LinkGeometry& link, int corner,
                              const Vector3& point, const Vector3& direction) {
  if (!link.outline) return radial(circle_of(substep, link), point, direction);
  const Vector3 normal = substep.orientation(link.carrier) * link.normal;
  const Vector3 outward = -link.side * cross(normal, direction);
  const double length = outward.norm();
  return length > 0.0 ? Vector3(outward / length)
                      : Vector3(point - center_of(substep, link, corner));
}

/// Difference between the radius at the end times the angle and the cable that a drum takes on when
/// it is wound by `angle` [rad], due to the growing radius: the integral of pitch angle / 2 pi. An
/// unwound drum gives that much more.
inline double layer_gain(const LinkGeometry& link, double angle) {
  return link.layer_pitch * angle * angle / (4.0 * pi);
}

/// Cable that a relative turn of the contact puts onto a circle, or the path along an outline,
/// counted counter-clockwise [m].
inline double way_along(const LinkGeometry& link, double relative_turn, int start_corner,
                        double start_angle, int corner) {
  if (!link.outline) return std::abs(link.signed_radius) * relative_turn;
  return link.outline->curve.distance(corner, start_angle + relative_turn) -
         link.outline->curve.distance(start_corner, start_angle);
}

/// The corner of the link's outline that a span along `direction` touches.
inline int touched_corner(const Substep& substep, const LinkGeometry& link,
                          const Vector3& direction, int near) {
  if (!link.outline) return 0;
  const Vector3 along = substep.orientation(link.carrier).conjugate() * direction;
  return link.outline->curve.support(link.side * link.outline->y.dot(along),
                                     -link.side * link.outline->x.dot(along), near);
}

}  // namespace sheave
