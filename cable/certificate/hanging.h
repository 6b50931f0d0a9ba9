#pragma once
// Ropes with weight, computed independently of the solvers: the elastic catenary by the tension at
// its start, as a function of which its end is known (H. M. Irvine, Cable Structures, section 1.3).

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// A span of a rope with weight between two points.
struct HungRope {
  Vector3 start = Vector3::Zero();   ///< [m]
  Vector3 end = Vector3::Zero();     ///< [m]
  Vector3 weight = Vector3::Zero();  ///< per unstretched length [N/m]
  double yield = 0.0;                ///< 1 / EA [1/N]
};

/// The forces of a span on the bodies at its ends [N].
struct HangingForces {
  Vector3 at_start = Vector3::Zero();
  Vector3 at_end = Vector3::Zero();
};

/// The forces of a span with this chord tension [N], > 0. `length` is its unstretched length [m]: a
/// guess, or for a rope that only just hangs, whose tension says little about its length, the length.
[[nodiscard]] HangingForces hanging_forces(const HungRope& span, double tension, double length);

/// The unstretched length [m] of a span with this chord tension [N], > 0.
[[nodiscard]] double hanging_length(const HungRope& span, double tension);

[[nodiscard]] HungRope rope_of(const Evidence& evidence, const CableDef& cable,
                               const SpanEvidence& span, End when);

/// Tension of the span without the force of its damper [N].
[[nodiscard]] double spring_tension(const Evidence& evidence, const CableDef& cable,
                                    const SpanEvidence& span);

/// Fills the loads of a span of a rope with weight; leaves those of other ropes 0.
void find_loads(const Evidence& evidence, const CableDef& cable, SpanEvidence& span);

}  // namespace sheave::certify
