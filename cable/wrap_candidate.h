#pragma once
// Bodies that a cable can come to touch though its list of links does not name them.
//
// A wrap is a rolling link that begins with the contact and ends with it. What has to be found is
// its plane and its winding. In a planar scene the plane is the cable's. Otherwise it is fixed to
// the body when the cable touches: perpendicular to the axis of a cylinder or prism, or to that of
// a box's axes which fits best, where the span comes nearest to the axis; for other forms it is the
// plane of the span and the body's centre. On a ball without friction it goes on being that of the
// spans and the centre (cable/cable_geodesics.cpp). The winding puts the body on the side of the
// span on which it was at the start of the substep, as the sign of the moment m = u x (c - a) of
// its centre c about the span a + t u tells: about a plane's normal n the cable runs
// counter-clockwise if n . m > 0. So a body that the span has gone right through in one substep is
// caught, too.

#include <optional>
#include <vector>

#include "cable/link.h"
#include "cable/link_geometry.h"
#include "cable/span_geometry.h"
#include "engine/substep.h"

namespace sheave {

/// An axis that a body can be wrapped round; own frame of the body.
struct WrapAxis {
  Vector3 direction = Vector3::UnitZ();
  double half_length = 0.0;  ///< of the body along it, to both sides of its centre [m]
};

/// Where a wrap's plane is: own frame of the body.
struct WrapPlane {
  Vector3 center = Vector3::Zero();  ///< [m]
  Vector3 normal = Vector3::UnitZ();
};

/// A wrappable body as one cable sees it.
struct WrapCandidate {
  int body = 0;
  Vector3 center = Vector3::Zero();  ///< of its form, own frame [m]
  double reach = 0.0;                ///< of its form from the centre [m]
  std::vector<WrapAxis> axes;        ///< empty: a form without an axis
  bool ball = false;                 ///< nothing but a sphere
  /// The wrap's plane is the cable's for ever, and `link` the wrap wound counter-clockwise.
  bool planar = false;
  LinkGeometry link;
};

/// On which side of a candidate a span is.
struct WrapSide {
  Vector3 moment = Vector3::Zero();  ///< m of the head of this file [m]; 0: unknown
  double along = 0.0;                ///< of the centre, from the span's start [m]
  double distance = 0.0;             ///< from the centre to the span [m]
  bool between = false;              ///< the centre lies beside the span, not beyond its ends
};

/// The candidate that a wrappable body is, without `planar` and `link`.
[[nodiscard]] WrapCandidate wrap_candidate(const BodySet& bodies, int body);

[[nodiscard]] WrapSide wrap_side(const Substep& substep, const WrapCandidate& candidate,
                                 const SpanGeometry& span);

/// The plane in which the span would be wrapped round the candidate; none if it passes beyond the
/// ends of its axis.
[[nodiscard]] std::optional<WrapPlane> wrap_plane(const Substep& substep,
                                                  const WrapCandidate& candidate,
                                                  const SpanGeometry& span);

/// The candidate's section with the plane as a link wound counter-clockwise; none if they do not
/// meet in an area.
[[nodiscard]] std::optional<LinkGeometry> wrap_link(const BodySet& bodies,
                                                    const WrapCandidate& candidate,
                                                    const WrapPlane& plane);

}  // namespace sheave
