#pragma once
// A rope with weight between two points: the elastic catenary (H. M. Irvine, Cable Structures, MIT
// Press 1981, section 1.3), with Hooke's law for the tension over the unstretched length.
//
// The unstretched arc length s runs from -L/2 at the start to L/2 at the end. The tension is the
// vector t = (H, V + w s), with the weight w per unstretched length. Its horizontal component H is
// constant, and V is the vertical component in the middle. With e = 1 / EA, the end is at
//
//   x = H L (g / S + e),   z = V L (1 / S + e),   S = w L / (2 tanh p),   g = p / tanh p,
//   S^2 = V^2 + H^2 cosh^2 p,
//
// from the start. S is the mean of the tensions at both ends, which are S -+ V tanh p. The parameter
// p > 0 is half the difference of asinh(v / H) between the ends: 0 for a taut rope. These formulas
// have no differences of nearly equal numbers, so they hold for taut ropes and for hanging ones.
// With e = 0 they are L^2 = z^2 + (x sinh p / p)^2.
//
// The chord tension T = (H x + V z) / c with the chord c is the component of the mean tension along
// the chord. A rope without weight has this tension everywhere.
//
// A rope that would hang below a floor lies on it: cable/lying_rope.h.

#include <algorithm>
#include <limits>

#include "cable/floor_profile.h"

namespace sheave {

/// The ends and the material of a hanging rope.
struct HangingRope {
  double across = 0.0;  ///< x: horizontal distance of the ends [m], >= 0
  double rise = 0.0;    ///< z: height of the end above the start [m]
  double weight = 0.0;  ///< w: weight per unstretched length [N/m], > 0
  double yield = 0.0;   ///< e = 1 / EA [1/N], >= 0; 0: inextensible
  /// Height of the start above a level floor [m]; infinite: there is none.
  double clearance = std::numeric_limits<double>::infinity();
  FloorGrip grip{};  ///< of that floor

  [[nodiscard]] bool has_floor() const {
    return clearance < std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double chord() const;  ///< c: distance of the ends [m]
};

/// The equilibrium of a hanging rope.
struct Catenary {
  double length = 0.0;      ///< L: unstretched length [m]
  double horizontal = 0.0;  ///< H [N], >= 0
  double vertical = 0.0;    ///< V: vertical component of the tension in the middle [N]
  double mean_end = 0.0;    ///< S: mean of the tensions at both ends [N]
  double parameter = 0.0;   ///< p
  double tension = 0.0;     ///< T: chord tension [N]
  /// The rope lies in part on its floor. Then `vertical` is the mean of the vertical components of the
  /// tension at both ends, and there is no `parameter`.
  bool lies = false;
  double start_up = 0.0;  ///< the component at the start of a rope that lies [N]
  double end_up = 0.0;    ///< at its end [N]
  /// Of a rope that lies slack: the part of the tension that was asked for below its own one [N], >= 0.
  double below = 0.0;
  [[nodiscard]] bool is_slack() const { return lies && horizontal == 0.0; }

  /// Vertical component of the tension at the start or at the end, upwards, under the weight `w` per
  /// unstretched length [N].
  [[nodiscard]] double up_at_start(double w) const {
    return lies ? start_up : vertical - 0.5 * w * length;
  }
  [[nodiscard]] double up_at_end(double w) const {
    return lies ? end_up : vertical + 0.5 * w * length;
  }
  /// Unstretched length on the floor [m].
  [[nodiscard]] double floored(double w) const {
    return lies ? std::max(length - (end_up - start_up) / w, 0.0) : 0.0;
  }
  /// Tension at the start or at the end [N].
  [[nodiscard]] double start_tension() const;
  [[nodiscard]] double end_tension() const;
};

/// The excess of a rope with weight over its chord, as a function of the chord tension T, with the
/// ends fixed.
struct Excess {
  double length = 0.0;  ///< E = L (1 + e T) - c [m], >= 0 but on a floor with friction
  double slope = 0.0;   ///< dE / dT [m/N], <= 0; on a floor with friction, <= e L
  /// Component of d(H, V) / dT across the chord, along (-z, x) / c; that along the chord is 1.
  double across = 0.0;
};

/// The catenary of this unstretched length [m], > 0, free or on the floor. An inextensible rope that is not longer than
/// its chord gets the shape of a rope that is longer by 1e-13 of the chord.
[[nodiscard]] Catenary catenary_of_length(const HangingRope& given, double length);

/// The catenary with this chord tension [N]. A hanging rope pulls its ends together with more than
/// w |z| / 2; a tension that no rope of 1e4 chords has is raised to the tension of such a rope.
[[nodiscard]] Catenary catenary_of_tension(const HangingRope& given, double tension);

/// A chord tension that no rope of this unstretched length, longer than its chord, exceeds [N].
[[nodiscard]] double tension_bound(const HangingRope& given, double length);

/// The excess of a catenary between the ends of `given`.
[[nodiscard]] Excess excess_of(const HangingRope& given, const Catenary& catenary);

/// Integral of the height above the start over the unstretched length [m2]; times w, the potential
/// energy of the rope with respect to its start.
[[nodiscard]] double height_integral(const HangingRope& given, const Catenary& catenary);

/// Elastic energy of the rope [J].
[[nodiscard]] double elastic_energy(const HangingRope& rope, const Catenary& catenary);

}  // namespace sheave
