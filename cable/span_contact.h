#pragma once
// How a span and a link lie to each other: sides, angles and the cable between two spans. Internal
// to the cable library.

#include "cable/link.h"
#include "cable/link_geometry.h"
#include "cable/span_geometry.h"
#include "engine/substep.h"

namespace sheave {

/// The link's circle in the world, now; of an outline the circle at `corner`.
[[nodiscard]] LinkCircle circle_of(const Substep& substep, const LinkGeometry& link,
                                   int corner = 0);

/// Place of the link in pictures and reports: the wheel's centre, the point, or the origin of the
/// outline's plane [m].
[[nodiscard]] inline Vector3 link_center(const Substep& substep, const LinkGeometry& link) {
  return substep.point(link.carrier, link.center);
}

/// Angle [rad, (-pi, pi]] of the outline's outward normal where a span along `direction` touches
/// it, about the link's normal from the outline's x axis.
[[nodiscard]] double normal_angle(const Substep& substep, const LinkGeometry& link,
                                  const Vector3& direction);

/// How a span passes an outline that it does not touch.
struct Clearance {
  /// From the outline to the span, on the side where the link's winding puts the cable [m]; < 0:
  /// the span cuts it.
  double distance = 0.0;
  double center_distance = 0.0;  ///< the same from the link's centre
  bool between =
      false;  ///< whether the span passes beside the body, not beyond its ends or far off its plane

  /// Whether the span runs through the outline, by more than rounding.
  [[nodiscard]] bool cuts(const LinkGeometry& link) const {
    return between && distance < -1e-9 * link.perimeter();
  }
};
[[nodiscard]] Clearance clearance(const Substep& substep, const LinkGeometry& link,
                                  const SpanGeometry& span);

/// Cable on the link between two spans [m] whose contacts are `angle` [rad] apart in the cable's
/// direction; for a geodesic its own length.
[[nodiscard]] double arc_between(const Substep& substep, const LinkGeometry& link,
                                 const SpanGeometry& incoming, const SpanGeometry& outgoing,
                                 double angle);

/// Way along the link from the contact of `from` to the contact of `to`, with the link at rest: the
/// shorter way round [m, counter-clockwise]. `first`: the link is the first link of both spans;
/// otherwise it is the second. For a geodesic 0.
[[nodiscard]] double contact_shift(const Substep& substep, const LinkGeometry& link,
                                   const SpanGeometry& from, const SpanGeometry& to, bool first);

/// Angle [rad, >= 0] by which the cable is wrapped round the link between two spans. On a wheel or
/// an outline the directions give the angle up to whole turns, and `stored_length` [m] gives their
/// number. At a pinhole the angle is the deflection.
[[nodiscard]] double wrap_angle(const Substep& substep, const LinkGeometry& link,
                                const SpanGeometry& incoming, const SpanGeometry& outgoing,
                                double stored_length);

/// wrap_angle() of a wheel or outline without the bound: < 0 if the cable is bent away from the
/// link.
[[nodiscard]] double signed_wrap_angle(const Substep& substep, const LinkGeometry& link,
                                       const SpanGeometry& incoming, const SpanGeometry& outgoing,
                                       double stored_length);

}  // namespace sheave
