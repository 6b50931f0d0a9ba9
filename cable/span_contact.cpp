#include "cable/span_contact.h"

#include <algorithm>
#include <cmath>

#include "cable/link_contact.h"
#include "engine/math/portable.h"

namespace sheave {

LinkCircle circle_of(const Substep& substep, const LinkGeometry& link, int corner) {
  return {center_of(substep, link, corner), substep.orientation(link.carrier) * link.normal,
          link.signed_radius};
}

double normal_angle(const Substep& substep, const LinkGeometry& link, const Vector3& direction) {
  const Vector3 along = substep.orientation(link.carrier).conjugate() * direction;
  // Outward is -side times left of the direction, and left of x is y.
  return portable::atan2(-link.side * link.outline->x.dot(along),
                         link.side * link.outline->y.dot(along));
}

namespace {

/// Whether a piece of the line from `start` along `direction`, both in the outline's plane, lies
/// within its corners.
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
  const Vector3 normal = orientation * link.normal;
  Vector3 left = cross(normal, span.direction);
  const double share = left.norm();
  if (!(share > 0.0)) return {0.0, 0.0, false};
  left /= share;
  const Vector3 corner = center_of(substep, link, touched_corner(substep, link, span.direction, 0));
  const Vector3 center = link_center(substep, link) - span.start;
  // The point of the span that is nearest to the centre as seen along the normal.
  const double along = dot(cross(left, normal), center) / share;
  bool between = along > 0.0 && along < span.length;
  if (link.outline) {
    const auto in_plane = [&](const Vector3& vector) {
      const Vector3 own = orientation.conjugate() * vector;
      return Vector3(link.outline->x.dot(own), link.outline->y.dot(own), 0.0);
    };
    between =
        runs_through(link.outline->curve, in_plane(-center), in_plane(span.direction), span.length);
  }
  // The thickness of the body at the groove is unknown. The code assumes that the body extends by
  // its mean radius to either side.
  const double aside = std::abs(dot(normal, center - dot(span.direction, center) * span.direction));
  between = between && aside <= link.perimeter() / (2.0 * pi);
  return {link.side * dot(left, corner - span.start) - std::abs(link.signed_radius),
          link.side * dot(left, center), between};
}

double arc_between(const Substep& substep, const LinkGeometry& link, const SpanGeometry& incoming,
                   const SpanGeometry& outgoing, double angle) {
  if (link.geodesic) return link.geodesic->length;
  if (!link.outline) return std::abs(link.signed_radius) * angle;
  const double entry = normal_angle(substep, link, incoming.direction);
  const Outline& curve = link.outline->curve;
  return link.side * (curve.distance(outgoing.first_corner, entry + link.side * angle) -
                      curve.distance(incoming.second_corner, entry));
}

double contact_shift(const Substep& substep, const LinkGeometry& link, const SpanGeometry& from,
                     const SpanGeometry& to, bool first) {
  if (!link.wraps() || link.geodesic) return 0.0;
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
    return portable::atan2(cross(incoming.direction, outgoing.direction).norm(),
                           dot(incoming.direction, outgoing.direction));
  }
  return std::max(signed_wrap_angle(substep, link, incoming, outgoing, stored_length), 0.0);
}

double signed_wrap_angle(const Substep& substep, const LinkGeometry& link,
                         const SpanGeometry& incoming, const SpanGeometry& outgoing,
                         double stored_length) {
  if (link.geodesic) return link.geodesic->turned;
  const Vector3 normal = substep.orientation(link.carrier) * link.normal;
  const Vector3 entry =
      contact_normal(substep, link, incoming.second_corner, incoming.end, incoming.direction);
  const Vector3 exit =
      contact_normal(substep, link, outgoing.first_corner, outgoing.start, outgoing.direction);
  const double angle = link.side * angle_between(entry, exit, normal);
  return unwrapped(angle, 2.0 * pi * stored_length / link.perimeter());
}

}  // namespace sheave
