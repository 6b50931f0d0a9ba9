#include "cable/span_row.h"

#include <algorithm>

#include "cable/link_contact.h"
#include "cable/span_groove.h"
#include "cable/span_planar.h"
#include "cable/span_skew.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

/// Position of the link's centre `time` after the start of the substep [m] if the body keeps the
/// velocities of the start. (Of an outline: of its origin, which is near enough for a guess.)
Vector3 center_after(const Substep& substep, const LinkGeometry& link, double time) {
  if (link.carrier == substep.bodies.count()) return link.center;
  const BodyState& carrier = substep.start.bodies[at(link.carrier)];
  const Vector3 center = carrier.position + time * carrier.velocity;
  if (link.centered) return center;
  return center +
         rotation_by(time * carrier.angular_velocity) * (carrier.orientation * link.center);
}

/// Velocity of the link's centre at the start of the substep (of an outline: of its origin, which
/// is near enough for a guess of the span's turn).
Vector3 start_velocity(const Substep& substep, const LinkGeometry& link) {
  if (link.carrier == substep.bodies.count()) return Vector3::Zero();
  const BodyState& carrier = substep.start.bodies[at(link.carrier)];
  if (link.centered) return carrier.velocity;
  return carrier.velocity +
         cross(carrier.angular_velocity, rotated(carrier.orientation, link.center));
}

/// Rotation of the link's carrier over the substep [rad].
double carrier_rotation(const Substep& substep, const LinkGeometry& link) {
  if (link.carrier == substep.bodies.count() || link.centered) return 0.0;
  return substep.h * substep.start.bodies[at(link.carrier)].angular_velocity.norm();
}

/// Turn of the line between the links' centres over the substep about `normal` [rad], whole turns
/// included, if the bodies keep the velocities of the start. `apart` is that line at the start.
double expected_turn(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                     const Vector3& apart, const Vector3& normal) {
  const double distance_squared = dot(apart, apart);
  if (!(distance_squared > 0.0)) return 0.0;
  const Vector3 velocity = start_velocity(substep, second) - start_velocity(substep, first);
  const double turn = substep.h * dot(normal, cross(apart, velocity)) / distance_squared;
  if (std::abs(turn) < 1.0) return turn;
  // One of them orbits the other, or passes it closely, which cannot turn the line by more than
  // half a turn. So follow the line in steps of less than a radian of rotation.
  constexpr double most_steps = 1e4;
  const double rotation = carrier_rotation(substep, first) + carrier_rotation(substep, second);
  const int steps = 1 + static_cast<int>(std::min(2.0 * rotation, most_steps));
  const auto line = [&](int step) -> Vector3 {
    const double time = substep.h * step / steps;
    return center_after(substep, second, time) - center_after(substep, first, time);
  };
  double sum = 0.0;
  Vector3 from = line(0);
  for (int i = 1; i <= steps; ++i) {
    const Vector3 to = line(i);
    sum += portable::atan2(dot(normal, cross(from, to)), dot(from, to));
    from = to;
  }
  return sum;
}

/// Turn of the link's body about `normal` since the start of the substep [rad].
double body_turn(const Substep& substep, const LinkGeometry& link, const Vector3& normal) {
  return dot(normal, substep.moving[at(link.body)].turn);
}

/// Sum of the edges between two corners minus the change of the span's length when its contact
/// moves from the one to the other [m, with the sign of the way `along`]. The difference is not 0
/// if the span's far end (`far_end`, carrier's own frame) is out of the outline's plane. When the
/// contact changes corner, the span seen along the normal lies along the edge e. With the distance
/// d in the plane from the nearer corner to the far end, and z out of the plane, the span's length
/// changes by sqrt((d + e)^2 + z^2) - sqrt(d^2 + z^2), which is e for z = 0. The stored length
/// counts this change instead of e. Otherwise the row's value would jump and create energy. After
/// windings at different tilts the stored length is therefore not quite the length of the edges.
/// The far end is that of the start of the substep, so the difference depends on the corners only,
/// and the row's gradient stays exact.
double tilt_loss(const LinkGeometry& link, int from, int to, double along, const Vector3& far_end) {
  if (from == to) return 0.0;
  const int count = link.outline->curve.corner_count();
  const int step = along > 0.0 ? 1 : count - 1;
  double loss = 0.0;
  for (int corner = from; corner != to;) {
    const int next = (corner + step) % count;
    const Vector3 a = far_end - link.outline->corners[at(corner)];
    const Vector3 b = far_end - link.outline->corners[at(next)];
    const double z = dot(link.normal, a);
    const double edge = (a - b).norm();
    const double d = std::min((a - z * link.normal).norm(), (b - z * link.normal).norm());
    loss += edge - (portable::hypot(d + edge, z) - portable::hypot(d, z));
    corner = next;
  }
  return along > 0.0 ? loss : -loss;
}

[[gnu::always_inline]] inline SpanGeometry span_between(
    const Substep& substep, const SpanSetup& setup, const LinkGeometry& first,
    const LinkGeometry& second, int first_corner, int second_corner, const SpanGuess* guess) {
  switch (setup.kind) {
    case SpanKind::straight:
      return straight_span(center_of(substep, first, 0), center_of(substep, second, 0));
    case SpanKind::planar:
      return planar_span(center_of(substep, first, first_corner), setup.first_radius,
                         center_of(substep, second, second_corner), setup.second_radius,
                         setup.normal);
    case SpanKind::spatial:
      break;
    case SpanKind::grooved:
      return grooved_span(substep, first, second, guess);
  }
  SpanGeometry span = spatial_span(end_circle(substep, first, first_corner, true),
                                   end_circle(substep, second, second_corner, false), guess);
  span.has_tangent = span.has_tangent && is_settled(first) && is_settled(second);
  return span;
}

/// Finds the corners: each round turns the span about one end until it no longer cuts the other
/// outline. Between convex outlines in one plane that do not overlap every turn goes the same way
/// for the same end, so each corner is passed once at most and the rounds are bounded by the number
/// of corners; if they are used up, the outlines overlap. In skew planes there may be no pair of
/// corners that suits both views (for 0.3 % of random polygons tilted by up to 0.3 rad about each
/// axis, 3 % at 1 rad); then the last pair stands and counts as no tangent.
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
    span = span_between(substep, setup, first, second, first_corner, second_corner, nullptr);
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

[[gnu::always_inline]] inline SpanGeometry span_geometry_now(const Substep& substep,
                                                             const SpanSetup& setup,
                                                             const LinkGeometry& first,
                                                             const LinkGeometry& second,
                                                             const SpanGuess* guess) {
  if (setup.outlined) return outlined_span(substep, setup, first, second);
  return span_between(substep, setup, first, second, 0, 0, guess);
}

}  // namespace

SpanGeometry span_geometry(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second,
                           const SpanGuess* guess) {
  return span_geometry_now(substep, setup, first, second, guess);
}

SpanReference span_reference(const Substep& substep, const SpanSetup& setup,
                             const LinkGeometry& first, const LinkGeometry& second,
                             double rest_length, const SpanGeometry* known) {
  SpanReference reference;
  reference.rest_length = rest_length;
  if (setup.kind == SpanKind::straight) return reference;
  const SpanGeometry span =
      known != nullptr ? *known : span_geometry_now(substep, setup, first, second, nullptr);
  reference.ends = {span.start, span.end};
  if (setup.outlined) {
    reference.first_corner = span.first_corner;
    reference.second_corner = span.second_corner;
    if (first.outline) reference.first_angle = normal_angle(substep, first, span.direction);
    if (second.outline) reference.second_angle = normal_angle(substep, second, span.direction);
  }
  if (setup.kind == SpanKind::planar) {
    reference.direction = span.direction;
    reference.left = cross(setup.normal, span.direction);
    const Vector3 apart = center_of(substep, second, span.second_corner) -
                          center_of(substep, first, span.first_corner);
    reference.expected_turn = expected_turn(substep, first, second, apart, setup.normal);
    return reference;
  }
  if (setup.kind == SpanKind::grooved) {
    refer_to_rims(substep, first, second, span, reference);
    return reference;
  }
  const auto own_radial = [&](const LinkGeometry& link, int corner,
                              const Vector3& point) -> Vector3 {
    if (!link.wraps() || link.geodesic) return Vector3::Zero();
    return substep.orientation(link.carrier).conjugate() *
           contact_normal(substep, link, corner, point, span.direction);
  };
  const auto own_point = [&](const LinkGeometry& link, const Vector3& point) -> Vector3 {
    return substep.orientation(link.carrier).conjugate() * (point - substep.position(link.carrier));
  };
  if (first.outline) reference.first_far = own_point(first, span.end);
  if (second.outline) reference.second_far = own_point(second, span.start);
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
      if (!setup.outlined) {
        return planar_transport(substep, setup, first, second, reference, geometry);
      }
      const double turn =
          unwrapped(angle_between(reference.direction, geometry.direction, setup.normal),
                    reference.expected_turn);
      const double first_turn = turn - body_turn(substep, first, setup.normal);
      const double second_turn = turn - body_turn(substep, second, setup.normal);
      // The outline counts about its own normal, which may be opposite to the span's.
      transport.from_first =
          -first.side * way_along(first, setup.first_sense * first_turn, reference.first_corner,
                                  reference.first_angle, geometry.first_corner);
      transport.from_second =
          second.side * way_along(second, setup.second_sense * second_turn, reference.second_corner,
                                  reference.second_angle, geometry.second_corner);
      break;
    }
    case SpanKind::spatial: {
      if (!setup.outlined) return skew_transport(substep, first, second, reference, geometry);
      const auto way = [&](const LinkGeometry& link, const Vector3& start_radial, int start_corner,
                           double start_angle, int corner, const Vector3& point,
                           const Vector3& far_end) {
        const Vector3 outward = contact_normal(substep, link, corner, point, geometry.direction);
        const double turn =
            relative_turn(substep, link, frame_of(substep, link), start_radial, outward);
        // The factor `side` gives the gain of the span at either end.
        const double gain = &link == &first ? -layer_gain(link, turn) : layer_gain(link, turn);
        const double along = way_along(link, turn, start_corner, start_angle, corner);
        const double loss =
            link.outline ? tilt_loss(link, start_corner, corner, along, far_end) : 0.0;
        return along - loss + link.side * gain;
      };
      if (first.geodesic) {
        transport.from_first = first.geodesic->passed_on;
      } else if (first.wraps()) {
        transport.from_first =
            -first.side * way(first, reference.first_radial, reference.first_corner,
                              reference.first_angle, geometry.first_corner, geometry.start,
                              reference.first_far);
      }
      if (second.geodesic) {
        transport.from_second = second.geodesic->taken_on;
      } else if (second.wraps()) {
        transport.from_second =
            second.side * way(second, reference.second_radial, reference.second_corner,
                              reference.second_angle, geometry.second_corner, geometry.end,
                              reference.second_far);
      }
      break;
    }
    case SpanKind::grooved:
      return grooved_transport(substep, first, second, reference, geometry);
  }
  return transport;
}

SpanGeometry moved_span(const Substep& substep, const SpanSetup& setup, const LinkGeometry& first,
                        const LinkGeometry& second, const SpanReference& reference,
                        SpanTransport& transport) {
  if (!setup.outlined && setup.kind == SpanKind::spatial) {
    return moved_skew_span(substep, first, second, reference, transport);
  }
  if (!setup.outlined && setup.kind == SpanKind::planar) {
    const SpanGeometry span = planar_geometry(substep, setup, first, second);
    transport = planar_transport(substep, setup, first, second, reference, span);
    return span;
  }
  const SpanGeometry span = span_geometry_now(substep, setup, first, second, nullptr);
  transport = span_transport(substep, setup, first, second, reference, span);
  return span;
}

SpanGeometry evaluate_span(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second,
                           const SpanReference& reference, Row& row, SpanTransport& transport) {
  const SpanGeometry span = moved_span(substep, setup, first, second, reference, transport);
  row.value = reference.rest_length + transport.from_first + transport.from_second - span.length;
  if (setup.kind == SpanKind::spatial) {
    if (leaves_one_body(first, second)) return span;
    add_exit_force(substep, row, first, span.start, span.direction);
    add_link_force(substep, row, second, span.end, -span.direction);
  } else if (on_one_body(first, second)) {
    return span;
  } else if (setup.kind == SpanKind::planar && !setup.outlined) {
    add_planar_forces(substep, setup, first, second, span, row);
  } else {
    add_link_force(substep, row, first, span.start, span.direction);
    add_link_force(substep, row, second, span.end, -span.direction);
  }
  tell_turning(span, row);
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
  tell_turning(span, row);
  return span;
}

}  // namespace sheave
