#pragma once
// Bodies that a cable can come to touch although its list of links does not name them.
//
// On a smooth body (cable/smooth_surface.h) the cable follows a geodesic (cable/cable_geodesics.cpp), of
// length 0 at first, where the span touches the body. On other shapes a wrap is a rolling link
// that exists as long as the contact. Its plane and its winding have to be found. In a planar scene
// the plane is that of the cable; for a smooth body only if geodesics in that plane exist.
// Otherwise the plane is fixed to the body at first contact: perpendicular to the axis of a prism,
// or to the axis of a box that fits best, at the point where the span comes nearest to the axis;
// for other shapes it is the plane through the span and the body's centre.
//
// The winding puts the body on the side of the span on which it was at the start of the substep.
// The sign of the moment m = u x (c - a) of its centre c about the span a + t u gives the side:
// about a plane's normal n the cable runs counter-clockwise if n . m > 0. (For a smooth body c is
// the point of its core that is nearest to the span.) This also catches a body through which the
// span has passed completely in one substep.

#include <optional>
#include <vector>

#include "cable/link.h"
#include "cable/link_geometry.h"
#include "cable/smooth_surface.h"
#include "cable/span_geometry.h"
#include "engine/substep.h"

namespace sheave {

/// An axis round which a cable can wrap; own frame of the body.
struct WrapAxis {
  Vector3 direction = Vector3::UnitZ();
  double half_length = 0.0;  ///< half of the body's extent along the axis [m]
};

/// The plane of a wrap; own frame of the body.
struct WrapPlane {
  Vector3 center = Vector3::Zero();  ///< [m]
  Vector3 normal = Vector3::UnitZ();
};

/// A wrappable body as a candidate of one cable.
struct WrapCandidate {
  int body = 0;
  int listed = -1;  ///< the body of this surface link of the cable's list; -1: a wrappable body
  Vector3 center = Vector3::Zero();      ///< centre of its shape, own frame [m]
  double reach = 0.0;                    ///< largest distance of its shape from the centre [m]
  std::vector<WrapAxis> axes;            ///< empty: a shape without an axis
  std::optional<SmoothSurface> surface;  ///< of a smooth body that is its only shape, own frame
  /// The wrap's plane is always that of the cable; `link` is the counter-clockwise wrap.
  bool planar = false;
  LinkGeometry link;
};

/// The side of a candidate on which a span lies.
struct WrapSide {
  Vector3 moment = Vector3::Zero();  ///< the moment m above [m]; 0: unknown
  double along = 0.0;                ///< position of the centre along the span, from its start [m]
  double distance = 0.0;             ///< from the centre to the span [m]
  bool between = false;              ///< the centre lies beside the span, not beyond its ends
  Vector3 core = Vector3::Zero();    ///< smooth bodies: the point of the core, own frame [m]
};

/// The surface of one shape of a body, own frame; none if the shape is not smooth. `shape` is its
/// index among the body's shapes.
[[nodiscard]] std::optional<SmoothSurface> smooth_surface(const BodySet& bodies, int body,
                                                          int shape);

/// A surface in the own frame of a body, in the world frame.
[[nodiscard]] SmoothSurface surface_now(const Substep& substep, int body,
                                        const SmoothSurface& surface);

/// The candidate of a surface link of the cable's list, without `listed`.
[[nodiscard]] WrapCandidate listed_candidate(const LinkGeometry& link);

/// The candidate for a wrappable body, without `planar` and `link`.
[[nodiscard]] WrapCandidate wrap_candidate(const BodySet& bodies, int body);

/// `before`, if not null, is the side a moment ago: a torus is then passed at the same place.
[[nodiscard]] WrapSide wrap_side(const Substep& substep, const WrapCandidate& candidate,
                                 const SpanGeometry& span, const WrapSide* before = nullptr);

/// Whether wraps on the candidate are geodesics.
[[nodiscard]] inline bool is_geodesic(const WrapCandidate& candidate) {
  return candidate.surface && !candidate.planar;
}

/// The passage of a span by a smooth candidate.
struct SurfaceTouch {
  double depth = 0.0;  ///< depth of the span below the surface [m]; < 0: no contact
  SurfaceFrame at;     ///< geodesic of length 0 at the contact, own frame of the body

  /// Whether the span is within the body by more than rounding, as for Clearance::cuts().
  [[nodiscard]] bool cuts(const WrapCandidate& candidate) const {
    return depth > 2e-9 * pi * candidate.surface->radius;
  }
};
/// `before` is the side on which the span has been. None if the span passes the candidate beyond
/// its own ends, or beyond those of a cylinder.
[[nodiscard]] std::optional<SurfaceTouch> surface_touch(const Substep& substep,
                                                        const WrapCandidate& candidate,
                                                        const SpanGeometry& span,
                                                        const WrapSide& before);

/// A geodesic on a smooth candidate that starts at `point` at right angles to `across`; `length`
/// [m] is its approximate length.
[[nodiscard]] LinkGeometry geodesic_link(const BodySet& bodies, const WrapCandidate& candidate,
                                         const Vector3& point, const Vector3& across,
                                         double length);

/// Makes a link of which `geodesic->surface` is set start as geodesic_link() says.
void start_geodesic(LinkGeometry& link, const Vector3& point, const Vector3& across, double length);

/// The start of a geodesic as a state keeps it: its point, and the unit vector across it there.
[[nodiscard]] inline WrapPlane start_of(const GeodesicLink& geodesic) {
  return {geodesic.entry.point, geodesic.entry.across()};
}

/// Sets the derived members of a geodesic link (exit, angle, circle for reports) from its entry and
/// its length.
void show_geodesic(LinkGeometry& link);

/// The plane in which the span would be wrapped round the candidate; none if the span passes beyond
/// the ends of the candidate's axis.
[[nodiscard]] std::optional<WrapPlane> wrap_plane(const Substep& substep,
                                                  const WrapCandidate& candidate,
                                                  const SpanGeometry& span);

/// The candidate's section with the plane, as a counter-clockwise link; none if the section has no
/// area.
[[nodiscard]] std::optional<LinkGeometry> wrap_link(const BodySet& bodies,
                                                    const WrapCandidate& candidate,
                                                    const WrapPlane& plane);

}  // namespace sheave
