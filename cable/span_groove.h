#pragma once
// Spans to drums with a groove; internal to the cable library.
//
// The groove leads the rope along the axle as the drum winds: the rope leaves at the place z(a) along
// the unit normal n, at the angle a of rope on the drum, which then stores S(a) (cable/drum_groove.h).
// The groove is helical, so without friction it does no work on rope that moves along it: the tension
// times dS/da = R is the same in the groove and in the free span. With the unit direction v of the
// span away from the drum and the moment m of its line about the axle (per unit of tension) the span
// has the power of its torque and of its axial force for the motion da of the contact,
//   m + z' (n.v) = R,   so   m = R - z' sin(fleet angle),   sin(fleet angle) = n.v.
// (Clairaut's law for a helix.) A rope that leaves in the direction of its helix,
// tan(fleet angle) = z' / r, has m = r^2 / R and leaves at the radius m / cos(fleet angle) = r. At
// any other angle the rope climbs a flank of the groove, as in cable/span_geometry.h: it leaves in
// the plane at z, perpendicular to the radius there, at m / cos(fleet angle).
//
// Gradient: the end c + z n + m / cos(fleet angle) e, with the unit vector e perpendicular to n and
// v, moves by da (n x e m / cos(fleet angle) + z' n) and along e, when the contact moves by da in the
// drum's frame. Along v that is m + z' (n.v) = R, by which S changes. So the span's length and its
// rest length change by the same amount, and the row's gradient is +-u at the ends, whatever R(a)
// and z(a) are (envelope theorem, cable/span_row.h). The drum gets the torque m T and the axial force
// T sin(fleet angle).
//
// Both a and the direction are unknown. The direction is solved for at a given a: m hardly depends
// on it, by z' sin(fleet angle) m / l^2, so the present m gives the next direction. Around it, a is
// solved for by the secant method (cable/cable_layers.cpp).

#include <array>

#include "cable/span_row.h"

namespace sheave {

/// The span with the rope at the present places of the grooves.
[[nodiscard]] SpanGeometry grooved_span(const Substep& substep, const LinkGeometry& first,
                                        const LinkGeometry& second, const SpanGuess* guess);

/// Unit vectors from the axles to the ends of the span, in the frames of the links' carriers.
void refer_to_rims(const Substep& substep, const LinkGeometry& first, const LinkGeometry& second,
                   const SpanGeometry& span, SpanReference& reference);

/// Angles by which the drums with a groove at both ends have wound rope on since the start of the
/// substep [rad]; 0 at other links.
[[nodiscard]] std::array<double, 2> wound_turns(const Substep& substep, const LinkGeometry& first,
                                                const LinkGeometry& second,
                                                const SpanReference& reference,
                                                const SpanGeometry& span);

/// span_transport() for such a span.
[[nodiscard]] SpanTransport grooved_transport(const Substep& substep, const LinkGeometry& first,
                                              const LinkGeometry& second,
                                              const SpanReference& reference,
                                              const SpanGeometry& span);

/// Sine of the angle of the span to the plane of the drum, > 0 towards the normal. `leaves`: the
/// drum is the span's first link.
[[nodiscard]] double fleet_sine(const Substep& substep, const LinkGeometry& drum,
                                const SpanGeometry& span, bool leaves);

}  // namespace sheave
