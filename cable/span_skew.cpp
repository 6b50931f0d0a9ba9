// Cost of an evaluation: two frames, one round or two of Newton's method from where the span was,
// two angles, and two terms of the row. Everything of one end is collected before it is added, for
// most wheels turn about fixed axles and their frames and forces are a few products.

#include "cable/span_skew.h"

#include "cable/link_contact.h"

namespace sheave {
namespace {

/// The forces that moving tangent points stand for, per unit multiplier: along `first_radial`
/// between the bodies at the span's end, along `second_radial` at its start.
struct SkewForces {
  Vector3 along_first = Vector3::Zero();
  Vector3 along_second = Vector3::Zero();
};

SkewForces skew_forces(const LinkCircle& circle1, const LinkCircle& circle2,
                       const SpanGeometry& span) {
  const double r1 = std::abs(circle1.signed_radius);
  const double r2 = std::abs(circle2.signed_radius);
  // A point is a circle whose tangent point cannot move: k = 0, and 1 on the diagonal of M.
  const Vector3 e1 = r1 > 0.0 ? radial(circle1, span.start) : Vector3(Vector3::Zero());
  const Vector3 e2 = r2 > 0.0 ? radial(circle2, span.end) : Vector3(Vector3::Zero());
  const Vector3 t1 = cross(circle1.normal, e1);
  const Vector3 t2 = cross(circle2.normal, e2);
  const double k1 = circle1.signed_radius - r1 * dot(span.direction, t1);
  const double k2 = r2 * dot(span.direction, t2) - circle2.signed_radius;
  const double m11 = r1 > 0.0 ? dot(t1, span.end - circle1.center) : 1.0;
  const double m12 = r2 * dot(e1, t2);
  const double m21 = r1 * dot(e2, t1);
  const double m22 = r2 > 0.0 ? dot(t2, span.start - circle2.center) : 1.0;
  const double determinant = m11 * m22 - m12 * m21;
  SkewForces forces;
  if (!(std::abs(determinant) > 0.0)) return forces;
  // d(l - L) = -y . g with y = M^-T k, so dC = y . g.
  forces.along_first = (m22 * k1 - m21 * k2) / determinant * e1;
  forces.along_second = (m11 * k2 - m12 * k1) / determinant * e2;
  return forces;
}

/// Adds the force `at_near` at the point `near` of the link's body, and `at_far` at `far`.
void add_forces(const Substep& substep, const LinkGeometry& link, const Vector3& near,
                const Vector3& at_near, const Vector3& far, const Vector3& at_far, Row& row) {
  if (link.mounted) {
    substep.add_force(row, link.body, near, at_near);
    substep.add_force(row, link.body, far, at_far);
    return;
  }
  const MovingBody& body = substep.moving[at(link.body)];
  if (!body.translates && !body.rotates && !body.prescribed) return;
  row.add(link.body, at_near + at_far,
          cross(near - body.position, at_near) + cross(far - body.position, at_far),
          dot(near - body.position, at_near) + dot(far - body.position, at_far));
}

double gain_of(const Substep& substep, const LinkGeometry& link, const LinkFrame& frame,
               const Vector3& start_outward, const Vector3& point, double layer_sense) {
  const double turn =
      relative_turn(substep, link, frame, start_outward, radial(frame.circle, point));
  // `side` makes it a gain of the span at either end.
  return std::abs(link.signed_radius) * turn + link.side * layer_sense * layer_gain(link, turn);
}

SpanTransport transport_between(const Substep& substep, const LinkGeometry& first,
                                const LinkGeometry& second, const LinkFrame& first_frame,
                                const LinkFrame& second_frame, const SpanReference& reference,
                                const SpanGeometry& span) {
  SpanTransport transport;
  if (first.wraps()) {
    transport.from_first = -first.side * gain_of(substep, first, first_frame,
                                                 reference.first_radial, span.start, -1.0);
  }
  if (second.wraps()) {
    transport.from_second = second.side * gain_of(substep, second, second_frame,
                                                  reference.second_radial, span.end, 1.0);
  }
  return transport;
}

}  // namespace

LinkFrame frame_of(const Substep& substep, const LinkGeometry& link) {
  if (link.still) return {{link.center, link.normal, link.signed_radius}, {}};
  const Quaternion orientation = substep.orientation(link.carrier);
  return {{center_of(substep, link, 0), rotated(orientation, link.normal), link.signed_radius},
          orientation};
}

double relative_turn(const Substep& substep, const LinkGeometry& link, const LinkFrame& frame,
                     const Vector3& start_outward, const Vector3& outward) {
  const Vector3& normal = frame.circle.normal;
  const auto turn_of = [&](int body) { return dot(normal, substep.moving[at(body)].turn); };
  if (link.still) return angle_between(start_outward, outward, normal) - turn_of(link.body);
  const double raw = angle_between(rotated(frame.orientation, start_outward), outward, normal);
  const double carrier_turn = turn_of(link.carrier);
  // In the carrier's frame the tangent point moves against the carrier's rotation.
  const double relative_to_carrier = unwrapped(raw, -carrier_turn);
  if (link.carrier == link.body) return relative_to_carrier;
  return relative_to_carrier - (turn_of(link.body) - carrier_turn);
}

void add_skew_span(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                   const LinkCircle& first_circle, const LinkCircle& second_circle,
                   const SpanGeometry& span, Row& row) {
  SkewForces forces;
  if (span.has_tangent && span.length > 0.0) {
    forces = skew_forces(first_circle, second_circle, span);
  }
  add_forces(substep, first, span.start, span.direction + forces.along_second, span.end,
             -forces.along_first, row);
  add_forces(substep, second, span.end, forces.along_first - span.direction, span.start,
             -forces.along_second, row);
}

SpanTransport skew_transport(const Substep& substep, const LinkGeometry& first,
                             const LinkGeometry& second, const SpanReference& reference,
                             const SpanGeometry& span) {
  return transport_between(substep, first, second, frame_of(substep, first),
                           frame_of(substep, second), reference, span);
}

SpanGeometry evaluate_skew_span(const Substep& substep, const LinkGeometry& first,
                                const LinkGeometry& second, const SpanReference& reference,
                                Row& row, SpanTransport& transport) {
  const LinkFrame first_frame = frame_of(substep, first);
  const LinkFrame second_frame = frame_of(substep, second);
  const SpanGeometry span = spatial_span(first_frame.circle, second_frame.circle, &reference.ends);
  transport = transport_between(substep, first, second, first_frame, second_frame, reference, span);
  row.value = reference.rest_length + transport.from_first + transport.from_second - span.length;
  if (!on_one_body(first, second)) {
    add_skew_span(substep, first, second, first_frame.circle, second_frame.circle, span, row);
    tell_turning(span, row);
  }
  return span;
}

}  // namespace sheave
