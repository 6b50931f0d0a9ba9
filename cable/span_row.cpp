#include "cable/span_row.h"

#include <Eigen/LU>

#include "engine/index.h"

namespace sheave {
namespace {

/// Centre of the link now; bodies that hold it at their centre of mass need no rotation.
inline Vector3 center_of(const Substep& substep, const LinkGeometry& link) {
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

/// Velocity of the link's centre at the start of the substep.
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

/// Rotation A - B of the tangent point at one end, relative to the body, since the start.
double relative_turn(const Substep& substep, const LinkGeometry& link, const Vector3& start_radial,
                     const Vector3& point) {
  const MovingBody& carrier = substep.moving[at(link.carrier)];
  const Quaternion orientation = substep.orientation(link.carrier);
  const Vector3 normal = orientation * link.normal;
  const Vector3 center = center_of(substep, link);
  const Vector3 now = orientation.conjugate() * (point - center);
  const double raw = angle_between(start_radial, now / std::abs(link.signed_radius), link.normal);
  const double carrier_turn = normal.dot(carrier.turn);
  // In the carrier's frame the tangent point moves against the carrier's rotation.
  const double relative_to_carrier = unwrapped(raw, -carrier_turn);
  if (!link.mounted) return relative_to_carrier;
  return relative_to_carrier - (normal.dot(substep.moving[at(link.body)].turn) - carrier_turn);
}

/// The forces along e1 and e2 that the moving tangent points of skew planes add to the row.
void add_skew_terms(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                    const SpanGeometry& span, Row& row) {
  const LinkCircle circle1 = circle_of(substep, first);
  const LinkCircle circle2 = circle_of(substep, second);
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

LinkCircle circle_of(const Substep& substep, const LinkGeometry& link) {
  return {center_of(substep, link), substep.orientation(link.carrier) * link.normal,
          link.signed_radius};
}

inline SpanGeometry span_geometry_now(const Substep& substep, const SpanSetup& setup,
                                      const LinkGeometry& first, const LinkGeometry& second) {
  switch (setup.kind) {
    case SpanKind::straight:
      return straight_span(center_of(substep, first), center_of(substep, second));
    case SpanKind::planar:
      return planar_span(center_of(substep, first), setup.first_radius, center_of(substep, second),
                         setup.second_radius, setup.normal);
    case SpanKind::spatial:
      break;
  }
  return spatial_span(circle_of(substep, first), circle_of(substep, second));
}

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
  const SpanGeometry span = span_geometry(substep, setup, first, second);
  if (setup.kind == SpanKind::planar) {
    reference.direction = span.direction;
    const Vector3 apart = center_of(substep, second) - center_of(substep, first);
    const Vector3 velocity = start_velocity(substep, second) - start_velocity(substep, first);
    const double distance_squared = dot(apart, apart);
    if (distance_squared > 0.0) {
      reference.expected_turn =
          substep.h * dot(setup.normal, cross(apart, velocity)) / distance_squared;
    }
    return reference;
  }
  const auto own_radial = [&](const LinkGeometry& link, const Vector3& point) -> Vector3 {
    if (link.signed_radius == 0.0) return Vector3::Zero();
    return substep.orientation(link.carrier).conjugate() * radial(circle_of(substep, link), point);
  };
  reference.first_radial = own_radial(first, span.start);
  reference.second_radial = own_radial(second, span.end);
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
      transport.from_first = -setup.first_radius * (turn - body_turn(first));
      transport.from_second = setup.second_radius * (turn - body_turn(second));
      break;
    }
    case SpanKind::spatial:
      if (first.signed_radius != 0.0) {
        transport.from_first =
            -first.signed_radius *
            relative_turn(substep, first, reference.first_radial, geometry.start);
      }
      if (second.signed_radius != 0.0) {
        transport.from_second =
            second.signed_radius *
            relative_turn(substep, second, reference.second_radial, geometry.end);
      }
      break;
  }
  return transport;
}

SpanGeometry evaluate_span(const Substep& substep, const SpanSetup& setup,
                           const LinkGeometry& first, const LinkGeometry& second,
                           const SpanReference& reference, Row& row) {
  const SpanGeometry span = span_geometry_now(substep, setup, first, second);
  const SpanTransport transport = span_transport(substep, setup, first, second, reference, span);
  row.value = reference.rest_length + transport.from_first + transport.from_second - span.length;
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
  add_link_force(substep, row, first, span.start, span.direction);
  add_link_force(substep, row, second, span.end, -span.direction);
  return span;
}

}  // namespace sheave
