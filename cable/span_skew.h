#pragma once
// The row of a span between circles, or a circle and a point, in planes that differ or move, as
// derived in cable/span_row.h for different planes. Internal to the cable library.

#include "cable/span_row.h"

namespace sheave {

/// A link's present circle in the world frame, and the orientation of its carrier.
struct LinkFrame {
  LinkCircle circle;
  Quaternion orientation = Quaternion::Identity();  ///< of the carrier; unused if it is at rest
};
[[nodiscard]] LinkFrame frame_of(const Substep& substep, const LinkGeometry& link);

/// Rotation A - B [rad] of the tangent point at one end about the link's normal, relative to the
/// body, since the start. `outward` is the unit vector from the centre of the end's circle to the
/// tangent point, now; `start_outward` the same at the start, own frame of the carrier.
[[nodiscard]] double relative_turn(const Substep& substep, const LinkGeometry& link,
                                   const LinkFrame& frame, const Vector3& start_outward,
                                   const Vector3& outward);

/// span_transport() and moved_span() for a span of kind `spatial` without outlines.
[[nodiscard]] SpanTransport skew_transport(const Substep& substep, const LinkGeometry& first,
                                           const LinkGeometry& second,
                                           const SpanReference& reference,
                                           const SpanGeometry& span);
[[nodiscard]] SpanGeometry moved_skew_span(const Substep& substep, const LinkGeometry& first,
                                           const LinkGeometry& second,
                                           const SpanReference& reference,
                                           SpanTransport& transport);

}  // namespace sheave
