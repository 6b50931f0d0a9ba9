#pragma once
// The tension of a damped span at an instant. Internal to the cable library.
//
// The multiplier of a span is the mean force over a substep. The tension T = x / a + b x' at the end
// follows from the state there: the stretch x from the lengths, and its rate x' from the velocities
// of the material points at both ends (cable/span_row.h: other motions of the tangent points change
// the length and the rest length by the same amount).

#include <optional>
#include <span>

#include "cable/link_geometry.h"
#include "cable/span_geometry.h"
#include "engine/state.h"

namespace sheave {

/// The spring and the damper of a span.
struct DampedSpan {
  double stretch = 0.0;   ///< length - rest length [m]
  double spring = 0.0;    ///< force of the spring [N]
  double damping = 0.0;   ///< [N s/m]
  bool material = false;  ///< of a cable with an axial stiffness
};

/// The tension [N, >= 0], at the poses and velocities of `bodies`. Nothing if the state does not
/// determine it: cable passes over an end, is fed there, or winds on with a strain of its own.
[[nodiscard]] std::optional<double> damped_tension(const DampedSpan& damped,
                                                   const SpanGeometry& geometry,
                                                   const LinkGeometry& first,
                                                   const LinkGeometry& second,
                                                   std::span<const BodyState> bodies);

}  // namespace sheave
