#include "cable/span_groove.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/link_contact.h"
#include "cable/span_skew.h"

namespace sheave {
namespace {

/// The signed moment of a span about the axle of its link, from its direction `away` from the link.
double moment_of(const LinkGeometry& link, const Vector3& normal, const Vector3& away) {
  return link.signed_radius - link.side * link.axial_slope * dot(normal, away);
}

/// Unit vector from the axle to the end of the span; without a wheel 0.
Vector3 outward_of(const LinkFrame& frame, const LinkGeometry& link, const Vector3& end) {
  if (!link.wraps()) return Vector3::Zero();
  const Vector3 arm = end - frame.circle.center;
  const Vector3 outward = arm - dot(frame.circle.normal, arm) * frame.circle.normal;
  return outward / outward.norm();
}

/// Rotation of the end of the span about the link's normal, relative to its body [rad].
double turn_of(const Substep& substep, const LinkGeometry& link, const Vector3& start_outward,
               const Vector3& end) {
  const LinkFrame frame = frame_of(substep, link);
  return relative_turn(substep, link, frame, start_outward, outward_of(frame, link, end));
}

/// Rest length that the span has gained over the link. `sense`: -1 at its first link, 1 at its
/// second.
double gain_of(const Substep& substep, const LinkGeometry& link, const Vector3& start_outward,
               const Vector3& end, double sense) {
  if (!link.wraps()) return 0.0;
  const double turn = turn_of(substep, link, start_outward, end);
  if (link.groove) return -link.groove->length(link.wound, -sense * link.side * turn);
  return sense * (link.signed_radius * turn) + layer_gain(link, turn);
}

}  // namespace

SpanGeometry grooved_span(const Substep& substep, const LinkGeometry& first,
                          const LinkGeometry& second, const SpanGuess* guess) {
  LinkCircle start = end_circle(substep, first, 0, true);
  LinkCircle end = end_circle(substep, second, 0, false);
  // The rounds contract by z' sin(fleet angle) m / l^2, below 1/10 for a rope that is longer than a
  // tenth of the radius.
  constexpr int most_rounds = 60;
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  SpanGeometry span = spatial_span(start, end, guess);
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0.0;
    const auto follow = [&](const LinkGeometry& link, const Vector3& away, LinkCircle& circle) {
      if (!link.groove || !link.wraps()) return;
      const double moment = moment_of(link, circle.normal, away);
      change = std::max(change, std::abs(moment - circle.signed_radius) / std::abs(moment));
      circle.signed_radius = moment;
    };
    follow(first, span.direction, start);
    follow(second, -span.direction, end);
    if (!(change > rounding)) return span;
    const SpanGuess last{span.start, span.end};
    span = spatial_span(start, end, &last);
  }
  span.has_tangent = false;
  return span;
}

void refer_to_rims(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                   const SpanGeometry& span, SpanReference& reference) {
  const auto own = [&](const LinkGeometry& link, const Vector3& end) -> Vector3 {
    return substep.orientation(link.carrier).conjugate() *
           outward_of(frame_of(substep, link), link, end);
  };
  reference.first_radial = own(first, span.start);
  reference.second_radial = own(second, span.end);
}

std::array<double, 2> wound_turns(const Substep& substep, const LinkGeometry& first,
                                  const LinkGeometry& second, const SpanReference& reference,
                                  const SpanGeometry& span) {
  std::array<double, 2> turns{};
  if (first.groove && first.wraps()) {
    turns[0] = first.side * turn_of(substep, first, reference.first_radial, span.start);
  }
  if (second.groove && second.wraps()) {
    turns[1] = -second.side * turn_of(substep, second, reference.second_radial, span.end);
  }
  return turns;
}

SpanTransport grooved_transport(const Substep& substep, const LinkGeometry& first,
                                const LinkGeometry& second, const SpanReference& reference,
                                const SpanGeometry& span) {
  return {gain_of(substep, first, reference.first_radial, span.start, -1.0),
          gain_of(substep, second, reference.second_radial, span.end, 1.0)};
}

double fleet_sine(const Substep& substep, const LinkGeometry& drum, const SpanGeometry& span,
                  bool leaves) {
  const Vector3 normal = rotated(substep.orientation(drum.carrier), drum.normal);
  return (leaves ? 1.0 : -1.0) * dot(normal, span.direction);
}

}  // namespace sheave
