#pragma once
// Spans of ropes with weight: the parts of their rows, and their reports. cable/cable_weight.cpp has
// the derivation.

#include <array>
#include <optional>

#include "cable/cable_parts.h"
#include "cable/cable_report.h"
#include "cable/catenary.h"
#include "cable/compiled_cable.h"
#include "cable/link_geometry.h"
#include "cable/span_geometry.h"
#include "cable/span_row.h"
#include "cable/wheel_rope.h"
#include "engine/substep.h"

namespace sheave {

/// Weight per unstretched length of a cable [N/m]; 0: none.
[[nodiscard]] double weight_of(const CompiledCable& cable, const Vector3& gravity);

/// The span as a hanging rope; `gravity` [m/s2] is not 0.
[[nodiscard]] HangingRope hanging_rope(const CompiledCable& cable, const Vector3& gravity,
                                       const SpanGeometry& span, const FloorGrip& grip);

/// The plane of a span that ends on wheels; without wheels only that, and the grip, is known. The part
/// of gravity across the plane is left out.
[[nodiscard]] WheelPlane wheel_plane_of(const Substep& substep, const CompiledCable& cable,
                                        const SpanSetup& setup, const LinkGeometry& first,
                                        const LinkGeometry& second, const SpanGeometry& span,
                                        const FloorGrip& grip);

/// A tension [N] at which the law of a span can be linearised: `tension`, but not so small that the
/// rope would have several times the excess for which there is `room` [m].
[[nodiscard]] double usable_tension(const HangingRope& rope, double tension, double room);

/// The chord tension of a span that lies slack on its floor [N].
[[nodiscard]] double least_tension(const HangingRope& rope, const WheelPlane& wheels);

/// A span of a rope with weight at its present ends, under a chord tension.
struct HangingSpan {
  SpanGeometry span;
  HangingRope rope;
  double rest_length = 0.0;         ///< [m]
  double tension = 0.0;             ///< chord tension [N]
  double unknown = 0.0;             ///< tension that the row's multiplier stands for [N]
  Catenary catenary;                ///< with this tension
  Excess excess;                    ///< of this catenary
  WheelPlane wheels;                ///< if it ends on wheels
  WheelCatenary on_wheels;          ///< with this tension, if it ends on wheels
  std::array<double, 2> arcs{};     ///< arcs that have come off its links since the start [m]
  std::array<double, 2> gained{};   ///< unstretched lengths of these arcs [m]
  std::array<double, 2> strains{};  ///< with which rope comes onto its wheels
  std::array<double, 2> above{};    ///< HangingStart::above
  /// On wheels, with a damper: the length whose weight the links bear; end_forces() [m].
  std::optional<double> borne;
  /// On wheels, on a floor, or sharing rope: the row's forces on both links per multiplier, the slopes
  /// of the forces by the unknown tension.
  std::array<EndForce, 2> slopes;
  /// On wheels, or sharing rope: a length of the span at the start of the substep, > 0 [m].
  double scale = 0.0;
  /// The row's force at the start per multiplier: near the derivative of the mean tension by the
  /// unknown tension.
  Vector3 pull = Vector3::Zero();
};

/// Finds the members that follow from the span, the rope and the tension. `along_chord`: in a search for
/// equilibrium.
void find_catenary(const Vector3& gravity, bool along_chord, HangingSpan& hanging);

/// Square of the stretch of a rope with this compliance [m/N] per displacement of its chord, where
/// the excess of its catenary has this slope [m/N].
[[nodiscard]] double stretch_share(double compliance, double excess_slope);

/// Adds the sag to the row of a span without weight: the law at the end of the substep.
void sag_at_end(const HangingSpan& hanging, Row& row);

/// The same for the mean over a substep of length `h` [s]. The row at the start has the value
/// start.value and no compliance. `brought`: stretch of the rope that has come onto the span [m].
void sag_in_mean(const HangingSpan& hanging, const cable_parts::HangingStart& start, double brought,
                 double h, Row& row);

/// Makes the row of a span that shares rope a part of the law of its run, whose first span has the
/// chord tension `first` [N]. `mean`: for the mean over a substep, else at its end.
void share_law(const HangingSpan& hanging, const cable_parts::HangingStart& start, double first,
               bool mean, bool rigid, Row& row);

/// Turns the force of the row from the chord to HangingSpan::pull.
void turn_force(const Substep& substep, const HangingSpan& hanging, const LinkGeometry& first,
                const LinkGeometry& second, Row& row);

/// Makes `row` the load of the span on its ends: the forces that the other row leaves out. `stored`
/// is the rope on its wheels that belongs to the span.
void load_ends(const Substep& substep, const HangingSpan& hanging,
               const std::array<StoredLoad, 2>& stored, const LinkGeometry& first,
               const LinkGeometry& second, Row& row);

/// The catenary of a span: of an elastic rope without damping by its rest length [m], else by its
/// chord tension [N], which the length of a rigid rope tells poorly. A tension of 0 is not known.
[[nodiscard]] Catenary catenary_of(const CompiledCable& cable, const HangingRope& rope,
                                   double rest_length, double tension);

/// The same for a span on wheels.
[[nodiscard]] WheelCatenary catenary_of(const CompiledCable& cable, const WheelPlane& wheels,
                                        double rest_length, double tension);

/// Fills the forces of a report that has the rest length and the tension.
void report_hanging(const CompiledCable& cable, const Vector3& gravity,
                    const SpanGeometry& geometry, const WheelPlane& wheels, SpanTensions tensions,
                    SpanReport& span);

/// Elastic energy of a span with this rest length [J].
[[nodiscard]] double hanging_energy(const CompiledCable& cable, const Vector3& gravity,
                                    const SpanGeometry& span, const WheelPlane& wheels,
                                    double rest_length);

/// Potential energy of the weight of a span with this rest length, against the origin [J].
[[nodiscard]] double hanging_potential(const CompiledCable& cable, const Vector3& gravity,
                                       const SpanGeometry& span, const WheelPlane& wheels,
                                       double rest_length);

}  // namespace sheave
