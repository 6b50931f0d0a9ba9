#pragma once
// Ropes with weight, computed independently of the solvers: the elastic catenary by the tension at
// its start, as a function of which its end is known (H. M. Irvine, Cable Structures, section 1.3).

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// The rope on a floor with friction at the start of a substep, as reported.
struct LaidEvidence {
  /// Tensions along it, from the anchor on; `length` is that from the anchor [m].
  std::vector<SpanReport::Place> places;
  double slope = 0.0;  ///< largest slope of the tension: mu w [N/m]

  /// The integral of the tension over the unstretched length [N m] of a rope that lies up to the length
  /// `length` [m] with the tension `horizontal` [N] there.
  [[nodiscard]] double sum(double length, double horizontal) const;
};

/// The rope of a span on a floor with friction, with this report at the start of a substep; null
/// without friction.
[[nodiscard]] std::shared_ptr<const LaidEvidence> laid_evidence(const CableDef& cable,
                                                                const SpanReport& start,
                                                                const Vector3& gravity);

/// A span of a rope with weight between two points.
struct HungRope {
  Vector3 start = Vector3::Zero();           ///< [m]
  Vector3 end = Vector3::Zero();             ///< [m]
  Vector3 weight = Vector3::Zero();          ///< per unstretched length [N/m]
  double yield = 0.0;                        ///< 1 / EA [1/N]
  std::optional<double> floor;               ///< height of the floor above the origin [m]
  std::shared_ptr<const LaidEvidence> laid;  ///< null: the floor has no friction
};

/// The forces of a span on the bodies at its ends [N].
struct HangingForces {
  Vector3 at_start = Vector3::Zero();
  Vector3 at_end = Vector3::Zero();
};

/// A rope that lies in part on its floor: cable/certificate/lying.cpp.
struct LyingRope {
  HangingForces forces;  ///< tensions at the ends, or at the tangent points of wheels [N]
  double length = 0.0;   ///< unstretched; of a slack rope the least one [m]
  std::array<double, 2> heights{};  ///< of these ends above the floor [m]
  std::array<double, 2> slopes{};   ///< of the rope there, in the way of the span [rad]
  bool slack = false;
};

/// An end in the vertical plane of a span, against the floor: a point, or a wheel.
struct FloorEnd {
  double x = 0.0;       ///< of the point or the centre, along the span [m]
  double height = 0.0;  ///< of the same above the floor [m]
  double radius =
      0.0;  ///< > 0: the rope lies on the upper side of the wheel, < 0: on the lower one
};

/// The rope with this chord tension [N]; none if it does not touch its floor. `level`, `up`: directions
/// of the plane; of `span` only the material counts.
[[nodiscard]] std::optional<LyingRope> lying_rope(const std::array<FloorEnd, 2>& ends,
                                                  const Vector3& level, const Vector3& up,
                                                  const HungRope& span, double tension);

/// The same between points; none without a floor.
[[nodiscard]] std::optional<LyingRope> lying_between_points(const HungRope& span, double tension);

/// The forces of a span with this chord tension [N], > 0. `length` is its unstretched length [m]: a
/// guess, or for a rope that only just hangs, whose tension says little about its length, the length.
[[nodiscard]] HangingForces hanging_forces(const HungRope& span, double tension, double length);

/// The unstretched length [m] of a span with this chord tension [N], > 0.
[[nodiscard]] double hanging_length(const HungRope& span, double tension);

/// Whether a rope of this unstretched length [m] with this chord tension [N] hangs in a fold between
/// ends above each other. Its tension is that of half of the weight between the ends, whatever the
/// length.
[[nodiscard]] bool hangs_in_a_fold(const HungRope& span, double tension, double length);

[[nodiscard]] HungRope rope_of(const Evidence& evidence, const CableDef& cable,
                               const SpanEvidence& span, End when);

/// Tension of the span without the force of its damper [N].
[[nodiscard]] double spring_tension(const Evidence& evidence, const CableDef& cable,
                                    const SpanEvidence& span);

/// Share of the tension in the part of the substep at one of its ends.
[[nodiscard]] double share_of(const Evidence& evidence, End when);

/// Fills the tensions of spans of a rope with weight that passes links freely.
void share_tensions(const Evidence& evidence, CableEvidence& cable);

/// Tension without the force of the damper, at one end of the substep [N].
[[nodiscard]] double tension_at(const Evidence& evidence, const CableDef& cable,
                                const SpanEvidence& span, End when);

/// The same of the span's forces on its ends. With `rattle` the first half of a substep has the forces of
/// its start, and a rope that is slack on its floor there has its least tension only: then < 0.
[[nodiscard]] double acting_tension(const Evidence& evidence, const CableDef& cable,
                                    const SpanEvidence& span, End when);

/// Fills the tensions and the loads of a rope with weight; leaves the loads of other ropes 0.
void find_loads(const Evidence& evidence, CableEvidence& cable);

/// Whether the span ends on a wheel: cable/certificate/hanging_wheels.cpp.
[[nodiscard]] bool ends_on_wheels(const SpanEvidence& span);

/// A span of a rope with weight on wheels, by the tension at its start and by its weight.
struct HungOnWheels {
  HangingForces forces;              ///< tensions at the tangent points [N]
  std::array<double, 2> arcs{};      ///< unstretched lengths of the additional arcs, signed [m]
  std::array<double, 2> tensions{};  ///< at the points of the straight tangent [N]
  double length = 0.0;               ///< between these points, unstretched [m]
  bool slack = false;                ///< on its floor: `length` is the least one
};

/// The span with this chord tension between its tangent points [N], > 0. `length` is a guess of its
/// unstretched length [m].
[[nodiscard]] HungOnWheels hung_on_wheels(const HungRope& rope, const SpanEvidence& span, End when,
                                          double tension, double length);

/// The unstretched length of a span with this chord tension [N], and whether more rope lies loose on
/// its floor.
struct HungLength {
  double length = 0.0;  ///< [m]
  bool slack = false;
};
[[nodiscard]] HungLength hung_length(const HungRope& rope, const SpanEvidence& span, End when,
                                     double tension);

/// Fills the loads of such a span.
void find_wheel_loads(const Evidence& evidence, const CableEvidence& cable, SpanEvidence& span);

}  // namespace sheave::certify
