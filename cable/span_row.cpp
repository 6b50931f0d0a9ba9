#include "cable/span_row.h"

#include <algorithm>

#include <Eigen/LU>

#include "engine/index.h"

namespace sheave {
namespace {

/// Centre of the link's circle now; bodies that hold it at their centre of mass need no rotation.
inline Vector3 center_of(const Substep& substep, const LinkGeometry& link, int corner) {
  if (link.outline) return substep.point(link.carrier, link.outline->corners[at(corner)]);
  const bool on_mounted_rotor = link.mounted && link.carrier == link.body;
  if (link.centered && !on_mounted_rotor) return substep.moving[at(link.carrier)].position;
  return substep.point(link.carrier, link.center);
}

/// Adds a unit force along `direction` at the world point `point` of the link's body.
inline void add_link_force(const Substep& substep, Row& row, const LinkGeometry& link,
                           const Vector3& point, const Vector3& direction) {
  if (link.mounted) {
    substep.add_force(row, link.body, point, direction);
    return;
  }
  const MovingBody& body = substep.moving[at(link.body)];
  if (!body.translates && !body.rotates) return;
  row.add(link.body, direction, cross(point - body.position, direction));
}

/// Whether both ends of a span move with one rigid body, so that nothing changes its length. What rounding leaves of its
/// gradient would have to pull with 1e16 times its error.
bool on_one_body(const LinkGeometry& first, const LinkGeometry& second) {
  return first.body == second.body && first.carrier == first.body && second.carrier == second.body;
}

/// Velocity of the link's centre at the start of the substep (of an outline: of its origin, which is near enough for a
/// guess of the span's turn).
Vector3 start_velocity(const Substep& substep, const LinkGeometry& link) {
  if (link.carrier == substep.bodies.count()) return Vector3::Zero();
  const BodyState& carrier = substep.start.bodies[at(link.carrier)];
  if (link.centered) return carrier.velocity;
  return carrier.velocity + cross(carrier.angular_velocity, carrier.orientation * link.center);
}

/// Unit vector from the centre of `circle` to `point` on it.
Vector3 radial(const LinkCircle& circle, const Vector3& point) {
  return (point - circle.center) / std::abs(circle.signed_radius);
}

/// Rotation A - B of the tangent point at one end, relative to the body, since the start. `radial` is the unit vector
/// from the centre of the end's circle to the tangent point, now; `start_radial` the same at the start, own frame.
double relative_turn(const Substep& substep, const LinkGeometry& link, const Vector3& start_radial,
                     const Vector3& radial) {
  const MovingBody& carrier = substep.moving[at(link.carrier)];
  const Quaternion orientation = substep.orientation(link.carrier);
  const Vector3 normal = orientation * link.normal;
  const double raw = angle_between(start_radial, orientation.conjugate() * radial, link.normal);
  const double carrier_turn = normal.dot(carrier.turn);
  // In the carrier's frame the tangent point moves against the carrier's rotation.
  const double relative_to_carrier = unwrapped(raw, -carrier_turn);
  if (link.carrier == link.body) return relative_to_carrier;
  return relative_to_carrier - (normal.dot(substep.moving[at(link.body)].turn) - carrier_turn);
}

/// Outward unit normal at the contact of a span with its link, in the link's plane. On a circle the tangent point tells
/// it; a corner of an outline may have no radius, but there the direction does.
Vector3 contact_normal(const Substep& substep, const LinkGeometry& link, int corner,
                       const Vector3& point, const Vector3& direction) {
  if (!link.outline) return radial(circle_of(substep, link), point);
  const Vector3 normal = substep.orientation(link.carrier) * link.normal;
  const Vector3 outward = -link.side * cross(normal, direction);
  const double length = outward.norm();
  return length > 0.0 ? Vector3(outward / length)
                      : radial({center_of(substep, link, corner), normal, 1.0}, point);
}

/// What a drum takes on beyond radius times angle when it is wound by `angle` [rad], because it gets thicker: the
/// integral of pitch angle / 2 pi.
inline double layer_gain(const LinkGeometry& link, double angle) {
  return link.layer_pitch * angle * angle / (4.0 * pi);
}

/// Cable that a relative turn of the tangent point puts onto a circle, or the way along an outline, counter-clockwise.
inline double way_along(const LinkGeometry& link, double relative_turn, int start_corner,
                        double start_angle, int corner) {
  if (!link.outline) return std::abs(link.signed_radius) * relative_turn;
  return link.outline->curve.distance(corner, start_angle + relative_turn) -
         link.outline->curve.distance(start_corner, start_angle);
}

/// The forces along e1 and e2 that the moving tangent points of skew planes add to the row.
void add_skew_terms(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                    const SpanGeometry& span, Row& row) {
  const LinkCircle circle1 = circle_of(substep, first, span.first_corner);
  const LinkCircle circle2 = circle_of(substep, second, span.second_corner);
  const double r1 = std::abs(first.signed_radius);
  const double r2 = std::abs(second.signed_radius);
  // A point is a circle whose tangent point cannot move: k = 0, and 1 on the diagonal of M.
  const Vector3 e1 = r1 > 0.0 ? radial(circle1, span.start) : Vector3(Vector3::Zero());
  const Vector3 e2 = r2 > 0.0 ? radial(circle2, span.end) : Vector3(Vector3::Zero());
  const Vector3 t1 = circle1.normal.cross(e1);
  const Vector3 t2 = circle2.normal.cross(e2);
  const Eigen::Vector2d k(-(r1 * span.direction.dot(t1) - first.signed_radius),
                          r2 * span.direction.dot(t2) - second.signed_radius);
  Eigen::Matrix2d m;
  m << (r1 > 0.0 ? t1.dot(span.end - circle1.center) : 1.0), r2 * e1.dot(t2), r1 * e2.dot(t1),
      (r2 > 0.0 ? t2.dot(span.start - circle2.center) : 1.0);
  const double determinant = m.determinant();
  if (!(std::abs(determinant) > 0.0)) return;
  const Eigen::Vector2d y = m.inverse().transpose() * k;
  // d(l - L) = -y . g, so dC = y . g with g1 = e1.(v2(a2) - v1(a2)), g2 = e2.(v1(a1) - v2(a1)).
  if (r1 > 0.0) {
    add_link_force(substep, row, second, span.end, y[0] * e1);
    add_link_force(substep, row, first, span.end, -y[0] * e1);
  }
  if (r2 > 0.0) {
    add_link_force(substep, row, first, span.start, y[1] * e2);
    add_link_force(substep, row, second, span.start, -y[1] * e2);
  }
}

}  // namespace

LinkCircle circle_of(const Substep& substep, const LinkGeometry& link, int corner) {
  return {center_of(substep, link, corner), substep.orientation(link.carrier) * link.normal,
          link.signed_radius};
}

double normal_angle(const Substep& substep, const LinkGeometry& link, const Vector3& direction) {
  const Vector3 along = substep.orientation(link.carrier).conjugate() * direction;
  // Outward is -side times left of the direction, and left of x is y.
  return std::atan2(-link.side * link.outline->x.dot(along),
                    link.side * link.outline->y.dot(along));
}

namespace {

inline SpanGeometry span_between(const Substep& substep, const SpanSetup& setup,
                                 const LinkGeometry& first, const LinkGeometry& second,
                                 int first_corner, int second_corner) {
  switch (setup.kind) {
    case SpanKind::straight:
      return straight_span(center_of(substep, first, 0), center_of(substep, second, 0));
    case SpanKind::planar:
      return planar_span(center_of(substep, first, first_corner), setup.first_radius,
                         center_of(substep, second, second_corner), setup.second_radius,
                         setup.normal);
    case SpanKind::spatial:
      break;
  }
  return spatial_span(circle_of(substep, first, first_corner),
                      circle_of(substep, second, second_corner));
}

/// The corner of the link's outline that a span along `direction` touches.
int touched_corner(const Substep& substep, const LinkGeometry& link, const Vector3& direction,
                   int near) {
  if (!link.outline) return 0;
  const Vector3 along = substep.orientation(link.carrier).conjugate() * direction;
  return link.outline->curve.support(link.side * link.outline->y.dot(along),
                                     -link.side * link.outline->x.dot(along), near);
}

/// Finds the corners: each round turns the span about one end until it no longer cuts the other outline. Between convex
/// outlines that do not overlap every turn goes the same way for the same end, so each corner is passed once at most
/// and the rounds are bounded by the number of corners; if they are used up, the outlines overlap.
SpanGeometry outlined_span(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second) {
  const Vector3 between = link_center(substep, second) - link_center(substep, first);
  int first_corner = touched_corner(substep, first, between, 0);
  int second_corner = touched_corner(substep, second, between, 0);
  const int rounds = 4 + 2 * (first.outline ? first.outline->curve.corner_count() : 0) +
                     2 * (second.outline ? second.outline->curve.corner_count() : 0);
  SpanGeometry span;
  bool settled = false;
  for (int round = 0; round < rounds && !settled; ++round) {
    span = span_between(substep, setup, first, second, first_corner, second_corner);
    const int next_first = touched_corner(substep, first, span.direction, first_corner);
    if (next_first != first_corner) {
      first_corner = next_first;
      continue;
    }
    const int next_second = touched_corner(substep, second, span.direction, second_corner);
    settled = next_second == second_corner;
    second_corner = next_second;
  }
  span.first_corner = first_corner;
  span.second_corner = second_corner;
  span.has_tangent = span.has_tangent && settled;
  return span;
}

inline SpanGeometry span_geometry_now(const Substep& substep, const SpanSetup& setup,
                                      const LinkGeometry& first, const LinkGeometry& second) {
  if (setup.outlined) return outlined_span(substep, setup, first, second);
  return span_between(substep, setup, first, second, 0, 0);
}

}  // namespace

SpanGeometry span_geometry(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second) {
  return span_geometry_now(substep, setup, first, second);
}

SpanReference span_reference(const Substep& substep, const SpanSetup& setup,
                             const LinkGeometry& first, const LinkGeometry& second,
                             double rest_length) {
  SpanReference reference;
  reference.rest_length = rest_length;
  if (setup.kind == SpanKind::straight) return reference;
  const SpanGeometry span = span_geometry_now(substep, setup, first, second);
  if (setup.outlined) {
    reference.first_corner = span.first_corner;
    reference.second_corner = span.second_corner;
    if (first.outline) reference.first_angle = normal_angle(substep, first, span.direction);
    if (second.outline) reference.second_angle = normal_angle(substep, second, span.direction);
  }
  if (setup.kind == SpanKind::planar) {
    reference.direction = span.direction;
    const Vector3 apart = center_of(substep, second, span.second_corner) -
                          center_of(substep, first, span.first_corner);
    const Vector3 velocity = start_velocity(substep, second) - start_velocity(substep, first);
    const double distance_squared = dot(apart, apart);
    if (distance_squared > 0.0) {
      reference.expected_turn =
          substep.h * dot(setup.normal, cross(apart, velocity)) / distance_squared;
    }
    return reference;
  }
  const auto own_radial = [&](const LinkGeometry& link, int corner,
                              const Vector3& point) -> Vector3 {
    if (!link.wraps()) return Vector3::Zero();
    return substep.orientation(link.carrier).conjugate() *
           contact_normal(substep, link, corner, point, span.direction);
  };
  reference.first_radial = own_radial(first, span.first_corner, span.start);
  reference.second_radial = own_radial(second, span.second_corner, span.end);
  return reference;
}

SpanTransport span_transport(const Substep& substep, const SpanSetup& setup,
                             const LinkGeometry& first, const LinkGeometry& second,
                             const SpanReference& reference, const SpanGeometry& geometry) {
  SpanTransport transport;
  switch (setup.kind) {
    case SpanKind::straight:
      break;
    case SpanKind::planar: {
      const double turn =
          unwrapped(angle_between(reference.direction, geometry.direction, setup.normal),
                    reference.expected_turn);
      const auto body_turn = [&](const LinkGeometry& link) {
        return dot(setup.normal, substep.moving[at(link.body)].turn);
      };
      const double first_turn = turn - body_turn(first);
      const double second_turn = turn - body_turn(second);
      if (setup.outlined) {
        // The outline counts about its own normal, which may be opposite to the span's.
        transport.from_first =
            -first.side * way_along(first, setup.first_sense * first_turn, reference.first_corner,
                                    reference.first_angle, geometry.first_corner);
        transport.from_second =
            second.side * way_along(second, setup.second_sense * second_turn,
                                    reference.second_corner, reference.second_angle,
                                    geometry.second_corner);
        break;
      }
      transport.from_first = -setup.first_radius * first_turn - layer_gain(first, first_turn);
      transport.from_second = setup.second_radius * second_turn - layer_gain(second, second_turn);
      break;
    }
    case SpanKind::spatial: {
      const auto way = [&](const LinkGeometry& link, const Vector3& start_radial, int start_corner,
                           double start_angle, int corner, const Vector3& point) {
        const Vector3 outward = contact_normal(substep, link, corner, point, geometry.direction);
        const double turn = relative_turn(substep, link, start_radial, outward);
        // `side` makes the gain of either end a loss of the span.
        const double gain = &link == &first ? layer_gain(link, turn) : -layer_gain(link, turn);
        return way_along(link, turn, start_corner, start_angle, corner) + link.side * gain;
      };
      if (first.wraps()) {
        transport.from_first =
            -first.side * way(first, reference.first_radial, reference.first_corner,
                              reference.first_angle, geometry.first_corner, geometry.start);
      }
      if (second.wraps()) {
        transport.from_second =
            second.side * way(second, reference.second_radial, reference.second_corner,
                              reference.second_angle, geometry.second_corner, geometry.end);
      }
      break;
    }
  }
  return transport;
}

namespace {

/// Whether a piece of the line from `start` along `direction`, both in the outline's plane, lies within its corners.
bool runs_through(const Outline& curve, const Vector3& start, const Vector3& direction,
                  double length) {
  double from = 0.0;
  double to = length;
  const int count = curve.corner_count();
  for (int i = 0; i < count && from < to; ++i) {
    const Vector3& corner = curve.corner(i);
    const Vector3 edge = curve.corner((i + 1) % count) - corner;
    // Inside is left of the edge.
    const double height = cross(edge, start - corner).z();
    const double rise = cross(edge, direction).z();
    if (rise == 0.0) {
      if (height < 0.0) return false;
    } else if (rise > 0.0) {
      from = std::max(from, -height / rise);
    } else {
      to = std::min(to, -height / rise);
    }
  }
  return from < to;
}

}  // namespace

Clearance clearance(const Substep& substep, const LinkGeometry& link, const SpanGeometry& span) {
  const Quaternion orientation = substep.orientation(link.carrier);
  Vector3 left = cross(orientation * link.normal, span.direction);
  const double share = left.norm();
  if (!(share > 0.0)) return {0.0, 0.0, false};
  left /= share;
  const Vector3 corner = center_of(substep, link, touched_corner(substep, link, span.direction, 0));
  const Vector3 center = link_center(substep, link) - span.start;
  const double along = dot(span.direction, center);
  bool between = along > 0.0 && along < span.length;
  if (link.outline) {
    const auto in_plane = [&](const Vector3& vector) {
      const Vector3 own = orientation.conjugate() * vector;
      return Vector3(link.outline->x.dot(own), link.outline->y.dot(own), 0.0);
    };
    between =
        runs_through(link.outline->curve, in_plane(-center), in_plane(span.direction), span.length);
  }
  return {link.side * dot(left, corner - span.start) - std::abs(link.signed_radius),
          link.side * dot(left, center), between};
}

double arc_between(const Substep& substep, const LinkGeometry& link, const SpanGeometry& incoming,
                   const SpanGeometry& outgoing, double angle) {
  if (!link.outline) return std::abs(link.signed_radius) * angle;
  const double entry = normal_angle(substep, link, incoming.direction);
  const Outline& curve = link.outline->curve;
  return link.side * (curve.distance(outgoing.first_corner, entry + link.side * angle) -
                      curve.distance(incoming.second_corner, entry));
}

double contact_shift(const Substep& substep, const LinkGeometry& link, const SpanGeometry& from,
                     const SpanGeometry& to, bool first) {
  if (!link.wraps()) return 0.0;
  const int corner_from = first ? from.first_corner : from.second_corner;
  const int corner_to = first ? to.first_corner : to.second_corner;
  const Vector3 normal = substep.orientation(link.carrier) * link.normal;
  const double angle = angle_between(
      contact_normal(substep, link, corner_from, first ? from.start : from.end, from.direction),
      contact_normal(substep, link, corner_to, first ? to.start : to.end, to.direction), normal);
  const double start = link.outline ? normal_angle(substep, link, from.direction) : 0.0;
  return way_along(link, angle, corner_from, start, corner_to);
}

double wrap_angle(const Substep& substep, const LinkGeometry& link, const SpanGeometry& incoming,
                  const SpanGeometry& outgoing, double stored_length) {
  if (!link.wraps()) {
    return std::atan2(cross(incoming.direction, outgoing.direction).norm(),
                      dot(incoming.direction, outgoing.direction));
  }
  return std::max(signed_wrap_angle(substep, link, incoming, outgoing, stored_length), 0.0);
}

double signed_wrap_angle(const Substep& substep, const LinkGeometry& link,
                         const SpanGeometry& incoming, const SpanGeometry& outgoing,
                         double stored_length) {
  const Vector3 normal = substep.orientation(link.carrier) * link.normal;
  const Vector3 entry =
      contact_normal(substep, link, incoming.second_corner, incoming.end, incoming.direction);
  const Vector3 exit =
      contact_normal(substep, link, outgoing.first_corner, outgoing.start, outgoing.direction);
  const double angle = link.side * angle_between(entry, exit, normal);
  return unwrapped(angle, 2.0 * pi * stored_length / link.perimeter());
}

SpanGeometry evaluate_span(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second,
                           const SpanReference& reference, Row& row) {
  const SpanGeometry span = span_geometry_now(substep, setup, first, second);
  const SpanTransport transport = span_transport(substep, setup, first, second, reference, span);
  row.value = reference.rest_length + transport.from_first + transport.from_second - span.length;
  if (on_one_body(first, second)) return span;
  add_link_force(substep, row, first, span.start, span.direction);
  add_link_force(substep, row, second, span.end, -span.direction);
  if (setup.kind == SpanKind::spatial && span.has_tangent && span.length > 0.0) {
    add_skew_terms(substep, first, second, span, row);
  }
  return span;
}

SpanGeometry evaluate_span_frozen(const Substep& substep, const LinkGeometry& first,
                                  const LinkGeometry& second, const SpanReference& reference,
                                  Row& row) {
  const SpanGeometry span = straight_span(substep.point(first.body, reference.first_point),
                                          substep.point(second.body, reference.second_point));
  row.value = reference.rest_length - span.length;
  if (on_one_body(first, second)) return span;
  add_link_force(substep, row, first, span.start, span.direction);
  add_link_force(substep, row, second, span.end, -span.direction);
  return span;
}

}  // namespace sheave
