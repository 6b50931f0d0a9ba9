#pragma once
// The row of a span between circles or points that stay in one plane, as derived in
// cable/span_row.h for coplanar circles. Internal to the cable library. Most spans of most scenes
// are of this kind, so the whole evaluation is inlined into one function.

#include "cable/link_contact.h"

namespace sheave {

/// Adds the terms of a span without a tangent. Its length stays 0, and its direction is
/// perpendicular to the line between the centres. The line turns by motion / distance and moves q
/// times as much cable: q / d times the contribution of the unit force at the tangent points. The
/// difference acts at the centres; it vanishes at d = q, where the tangent ends.
inline void add_turning_terms(const Substep& substep, const SpanSetup& setup,
                              const LinkGeometry& first, const LinkGeometry& second,
                              const SpanGeometry& span, Row& row) {
  const Vector3 first_center = center_of(substep, first, 0);
  const Vector3 second_center = center_of(substep, second, 0);
  const double distance = (second_center - first_center).norm();
  if (!(distance > 0.0)) return;
  const double more = std::abs(setup.second_radius - setup.first_radius) / distance - 1.0;
  add_link_force(substep, row, first, first_center, more * span.direction);
  add_link_force(substep, row, second, second_center, -more * span.direction);
}

[[gnu::always_inline]] inline SpanGeometry planar_geometry(const Substep& substep,
                                                           const SpanSetup& setup,
                                                           const LinkGeometry& first,
                                                           const LinkGeometry& second) {
  return planar_span(center_of(substep, first, 0), setup.first_radius,
                     center_of(substep, second, 0), setup.second_radius, setup.normal);
}

/// span_transport() for such a span.
[[gnu::always_inline]] inline SpanTransport planar_transport(
    const Substep& substep, const SpanSetup& setup, const LinkGeometry& first,
    const LinkGeometry& second, const SpanReference& reference, const SpanGeometry& span) {
  const double turn = unwrapped(
      angle_of(dot(reference.left, span.direction), dot(reference.direction, span.direction)),
      reference.expected_turn);
  SpanTransport transport;
  if (first.wraps()) {
    const double own = turn - dot(setup.normal, substep.moving[at(first.body)].turn);
    transport.from_first = -setup.first_radius * own;
    if (first.layer_pitch > 0.0) transport.from_first += layer_gain(first, own);
  }
  if (second.wraps()) {
    const double own = turn - dot(setup.normal, substep.moving[at(second.body)].turn);
    transport.from_second = setup.second_radius * own;
    if (second.layer_pitch > 0.0) transport.from_second += layer_gain(second, own);
  }
  return transport;
}

/// Adds a unit force along `direction` at an end `point` of the span to the row. `radius` is the
/// signed radius there, with the sign of the force along u. About the centre the force has the arm
/// -q n x u and so the torque q n. There is no other torque if the centre is the centre of mass, or
/// lies on the axle of a wheel that rotates about nothing else.
[[gnu::always_inline]] inline void add_planar_force(const Substep& substep, const SpanSetup& setup,
                                                    const LinkGeometry& link, double radius,
                                                    const Vector3& point, const Vector3& direction,
                                                    Row& row) {
  if (link.mounted || !(link.still || link.centered)) {
    add_link_force(substep, row, link, point, direction);
    return;
  }
  const MovingBody& body = substep.moving[at(link.body)];
  if (!body.translates && !body.rotates && !body.prescribed) return;
  row.add(link.body, direction, radius * setup.normal);
}

/// Adds the force of such a span on its ends to the row.
[[gnu::always_inline]] inline void add_planar_forces(const Substep& substep, const SpanSetup& setup,
                                                     const LinkGeometry& first,
                                                     const LinkGeometry& second,
                                                     const SpanGeometry& span, Row& row) {
  add_planar_force(substep, setup, first, setup.first_radius, span.start, span.direction, row);
  add_planar_force(substep, setup, second, -setup.second_radius, span.end, -span.direction, row);
  if (!span.has_tangent) add_turning_terms(substep, setup, first, second, span, row);
}

}  // namespace sheave
