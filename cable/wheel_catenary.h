#pragma once
// A rope with weight between two wheels: an elastic catenary (cable/catenary.h) that leaves each
// wheel along the tangent of the wheel.
//
// The vertical plane of the span has the coordinates x, level, and z, up. The slope a of the rope is
// the angle of its direction (cos a, sin a), and n(a) = (-sin a, cos a) points to its left. A wheel
// with the centre c and the signed radius r is touched at c + r n(a): r > 0 on its upper side, r < 0
// on its lower side, r = 0 in a point.
//
// The rope sags below the straight common tangent of the wheels, whose slope is a0. So it leaves the
// first wheel at a slope a1 below a0 and reaches the second one at a slope a2 above a0. Against the
// straight tangent it has the additional arcs r1 (a0 - a1) and r2 (a2 - a0), which are negative on
// lower sides. Both slopes are those of the catenary between the tangent points.
//
// Along the rope the potential m = T + T^2 / 2 EA - w z is constant, on the catenary and on the
// additional arcs, where the rope bears the tension T of its height. So the shape is the least of
// elastic energy and weight for the unstretched length between the points of the straight tangent
// (negative arcs continue this energy analytically), and these points feel its derivatives: by the
// length -m, and by the place of a wheel the tension at the tangent point and the weight of the
// additional arc. About the axle both together have the moment r T with the tension T at the point of
// the straight tangent, whatever the slope. A wheel that turns freely therefore has tensions on both
// sides that differ by w times the height.

#include <limits>
#include <optional>

#include "cable/catenary.h"

namespace sheave {

/// Two wheels, or points, with a rope between them. The first centre is the origin.
struct WheelSpan {
  double across = 0.0;         ///< x of the second centre [m]
  double rise = 0.0;           ///< z of the second centre [m]
  double first_radius = 0.0;   ///< r1 [m], signed
  double second_radius = 0.0;  ///< r2 [m], signed
  double slope = 0.0;          ///< a0 [rad], from -pi/2 to pi/2
  double weight = 0.0;         ///< w: weight per unstretched length [N/m], > 0
  double yield = 0.0;          ///< e = 1 / EA [1/N], >= 0; 0: inextensible
  /// Height of the first centre above a level floor [m]; infinite: there is none. The rope on the floor
  /// has the same potential m as the rest (cable/lying_rope.h).
  double clearance = std::numeric_limits<double>::infinity();
  FloorGrip grip{};  ///< of that floor
};

/// The rope on a wheel between the point of the straight tangent and the tangent point.
struct WheelArc {
  double length = 0.0;  ///< unstretched length [m], signed
  double height = 0.0;  ///< integral of the height above the first centre over it [m2]
  double energy = 0.0;  ///< elastic energy [J]
};

/// The equilibrium of a rope between two wheels.
struct WheelCatenary {
  HangingRope rope;             ///< between the tangent points
  Catenary catenary;            ///< of this rope; its length is that between the tangent points
  double first_slope = 0.0;     ///< a1 [rad]
  double second_slope = 0.0;    ///< a2 [rad]
  WheelArc first_arc;           ///< additional arc on the first wheel
  WheelArc second_arc;          ///< additional arc on the second wheel
  double first_tension = 0.0;   ///< at the first point of the straight tangent [N]
  double second_tension = 0.0;  ///< at the second one [N]
  /// False: no slopes fit, as below a wheel that lies on a rope with a tension of less than about
  /// w r. The rope then hangs between the points of the straight tangent.
  bool found = true;

  /// Unstretched length between the points of the straight tangent [m].
  [[nodiscard]] double length() const {
    return first_arc.length + catenary.length + second_arc.length;
  }
};

/// The slope a0 of the straight common tangent [rad]: that of a direction with the parts `level`,
/// >= 0, and `up`.
[[nodiscard]] double slope_of(double level, double up);

/// The rope that lies slack on its floor, with the least length that is slack; none without a floor.
[[nodiscard]] std::optional<WheelCatenary> slack_on_floor(const WheelSpan& span);

/// The rope with this unstretched length [m], > 0, between the points of the straight tangent.
[[nodiscard]] WheelCatenary wheel_catenary_of_length(const WheelSpan& span, double length);

/// The rope with this chord tension [N] between its tangent points; see catenary_of_tension().
[[nodiscard]] WheelCatenary wheel_catenary_of_tension(const WheelSpan& span, double tension);

/// The excess of the rope over the straight tangent of the length `straight` [m], as a function of
/// the chord tension. The slope is that for fixed tangent points, which are stationary up to the
/// curvature of the rope on the wheel.
[[nodiscard]] Excess excess_of(const WheelSpan& span, const WheelCatenary& rope, double straight);

/// Integral of the height above the first centre over the unstretched length [m2].
[[nodiscard]] double height_integral(const WheelSpan& span, const WheelCatenary& rope);

/// Elastic energy of the rope with its additional arcs [J].
[[nodiscard]] double elastic_energy(const WheelCatenary& rope);

}  // namespace sheave
