// Cost of an evaluation: two frames, one round or two of Newton's method from the span's last
// position, two angles, and two terms of the row.

#include "cable/span_skew.h"

#include "cable/link_contact.h"

namespace sheave {
namespace {

double gain_of(const Substep& substep, const LinkGeometry& link, const LinkFrame& frame,
               const Vector3& start_outward, const Vector3& point, const Vector3& direction,
               double layer_sense) {
  const double turn =
      relative_turn(substep, link, frame, start_outward, radial(frame.circle, point, direction));
  // The factor `side` gives the gain of the span at either end.
  return std::abs(link.signed_radius) * turn + link.side * layer_sense * layer_gain(link, turn);
}

SpanTransport transport_between(const Substep& substep, const LinkGeometry& first,
                                const LinkGeometry& second, const LinkFrame& first_frame,
                                const LinkFrame& second_frame, const SpanReference& reference,
                                const SpanGeometry& span) {
  SpanTransport transport;
  if (first.geodesic) {
    transport.from_first = first.geodesic->passed_on;
  } else if (first.wraps()) {
    transport.from_first =
        -first.side * gain_of(substep, first, first_frame, reference.first_radial, span.start,
                              span.direction, -1.0);
  }
  if (second.geodesic) {
    transport.from_second = second.geodesic->taken_on;
  } else if (second.wraps()) {
    transport.from_second =
        second.side * gain_of(substep, second, second_frame, reference.second_radial, span.end,
                              span.direction, 1.0);
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

SpanTransport skew_transport(const Substep& substep, const LinkGeometry& first,
                             const LinkGeometry& second, const SpanReference& reference,
                             const SpanGeometry& span) {
  return transport_between(substep, first, second, frame_of(substep, first),
                           frame_of(substep, second), reference, span);
}

SpanGeometry moved_skew_span(const Substep& substep, const LinkGeometry& first,
                             const LinkGeometry& second, const SpanReference& reference,
                             SpanTransport& transport) {
  const LinkFrame first_frame = frame_of(substep, first);
  const LinkFrame second_frame = frame_of(substep, second);
  SpanGeometry span = spatial_span(
      has_two_ends(first) ? end_circle(substep, first, 0, true) : first_frame.circle,
      has_two_ends(second) ? end_circle(substep, second, 0, false) : second_frame.circle,
      &reference.ends);
  span.has_tangent = span.has_tangent && is_settled(first) && is_settled(second);
  transport = transport_between(substep, first, second, first_frame, second_frame, reference, span);
  return span;
}

}  // namespace sheave
