#pragma once
// The shortest path of a cable over several smooth bodies in a row; internal to the cable library.
//
// The path on each body is a geodesic (cable/smooth_surface.h), given by its entry and its length.
// Free spans are straight. The path is the shortest if no span meets a geodesic at an angle. With
// the frame (t, b, n) of the geodesic at an end, tangent, across and outward, and the vector d of
// the whole span there,
//
//   d.n = 0,   d.b = 0   at the entry and at the exit of each body.
//
// These are four equations for the four changes of a body's geodesic: the position of the entry
// along t and along b, the angle of t, and the length. Newton's method solves the equations of all
// bodies together. The exit moves with the entry as neighbouring geodesics do (SurfaceWay), and a
// span between two bodies couples their equations. The outer end of the first and of the last span,
// on a point or a wheel, is found anew in each round. If Newton's method fails from the given
// start, each body in turn gets its geodesic in closed form, and if it fails from there, a geodesic
// of length 0 where the chord passes the body.
//
// (Finding the bodies in turn is not enough. For two bars side by side the number of rounds is in
// proportion to the ratio of the outer spans to the span between the bars.)

#include <functional>
#include <vector>

#include "cable/smooth_surface.h"

namespace sheave {

/// One body on the path. Entry and length are first an estimate, then the result.
struct GeodesicStop {
  SmoothSurface surface;  ///< world frame
  SurfaceFrame entry;     ///< start of the geodesic
  double length = 0.0;    ///< length of the geodesic [m]
  SurfaceWay way;         ///< the geodesic from the entry on
};

/// The fixed end of a span whose other end is at the given point.
using SpanEnd = std::function<Vector3(const Vector3&)>;

/// Finds the shortest path over the bodies between the outer ends of the first and the last span.
/// For a belt on nothing but these bodies both ends are empty. Returns false if none was found.
[[nodiscard]] bool find_shortest_way(std::vector<GeodesicStop>& stops, const SpanEnd& from,
                                     const SpanEnd& to);

}  // namespace sheave
