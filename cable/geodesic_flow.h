#pragma once
// Geodesics on a torus or an ellipsoid, integrated together with their neighbours; internal to the
// cable library.
//
// With the outward normal n, the curvature k(t) of the surface along t and the Gaussian curvature K,
//
//   x'' = -k(x') n,   J'' = -K J for two neighbours,   turned' = k(x').
//
// The method is that of Gragg, Bulirsch and Stoer: midpoint rules with 2, 4, ... 16 steps,
// extrapolated to order 16. A step is halved until the last two orders agree to rounding. Each step
// ends on the surface, with a unit tangent. (Hairer, Norsett, Wanner, Solving Ordinary Differential
// Equations I, II.9.)

#include "cable/smooth_surface.h"

namespace sheave {

/// As straightest_way().
[[nodiscard]] SurfaceWay integrated_way(const SmoothSurface& surface, const SurfaceFrame& start,
                                        double length);

}  // namespace sheave
