#pragma once
// Spans of ropes with weight: the parts of their rows, and their reports. cable/cable_weight.cpp has
// the derivation.

#include "cable/cable_parts.h"
#include "cable/cable_report.h"
#include "cable/catenary.h"
#include "cable/compiled_cable.h"
#include "cable/link_geometry.h"
#include "cable/span_geometry.h"
#include "engine/substep.h"

namespace sheave {

/// Weight per unstretched length of a cable [N/m]; 0: none.
[[nodiscard]] double weight_of(const CompiledCable& cable, const Vector3& gravity);

/// The span as a hanging rope; `gravity` [m/s2] is not 0.
[[nodiscard]] HangingRope hanging_rope(const CompiledCable& cable, const Vector3& gravity,
                                       const SpanGeometry& span);
/// The same with a density [kg/m] and 1 / EA [1/N].
[[nodiscard]] HangingRope hanging_rope(double density, double yield, const Vector3& gravity,
                                       const SpanGeometry& span);

/// A tension [N] at which the law of a span can be linearised: `tension`, but not so small that the
/// rope would have several times the excess for which there is `room` [m].
[[nodiscard]] double usable_tension(const HangingRope& rope, double tension, double room);

/// A span of a rope with weight at its present ends, under a chord tension.
struct HangingSpan {
  SpanGeometry span;
  HangingRope rope;
  double rest_length = 0.0;  ///< [m]
  double tension = 0.0;      ///< chord tension [N]
  Catenary catenary;         ///< with this tension
  Excess excess;             ///< of this catenary
  /// The row's force at the start per multiplier: near the derivative of the mean tension by the chord
  /// tension.
  Vector3 pull = Vector3::Zero();
};

/// Finds the members that follow from the span, the rope and the tension.
void find_catenary(const Vector3& gravity, HangingSpan& hanging);

/// Adds the sag to the row of a span without weight: the law at the end of the substep.
void sag_at_end(const HangingSpan& hanging, Row& row);

/// The same for the mean over a substep of length `h` [s]. The row at the start has the value
/// start.value and no compliance.
void sag_in_mean(const HangingSpan& hanging, const cable_parts::HangingStart& start, double h,
                 Row& row);

/// Turns the force of the row from the chord to HangingSpan::pull.
void turn_force(const Substep& substep, const HangingSpan& hanging, const LinkGeometry& first,
                const LinkGeometry& second, Row& row);

/// Makes `row` the load of the span on its ends: the forces that the other row leaves out.
void load_ends(const Substep& substep, const HangingSpan& hanging, const LinkGeometry& first,
               const LinkGeometry& second, Row& row);

/// The catenary of a span: of an elastic rope without damping by its rest length [m], else by its
/// chord tension [N], which the length of a rigid rope tells poorly. A tension of 0 is not known.
[[nodiscard]] Catenary catenary_of(const CompiledCable& cable, const HangingRope& rope,
                                   double rest_length, double tension);

/// Fills the forces of a report that has the rest length and the tension.
void report_hanging(const CompiledCable& cable, const Vector3& gravity,
                    const SpanGeometry& geometry, SpanTensions tensions, SpanReport& span);

}  // namespace sheave
