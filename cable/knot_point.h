#pragma once
// Where a knot without mass lies, and how it shares its force among its ropes.
//
// A knot is a point p without mass at which the ends of ropes meet. Its forces balance:
//
//   sum of T_i u_i = 0,   u_i: the unit vector from p along rope i.
//
// Rope i has the free length l_i(p) and the rest length L_i(p); both depend on p alone while the
// bodies stand still. The gradient of l_i - L_i is -u_i, and its second derivative is (1 - u u^T) / r
// with the distance r of p from the point a_i where the span ends (cable/span_row.h). So up to third
// order a rope is one from the point a_i with the rest length R_i = r + L_i - l_i, which may be
// negative, and exactly so if no wheel is there.
//
// Rigid ropes allow a pose of the bodies if a point p has |p - a_i| <= R_i for all i. The row is
//
//   C = -min over p of max over i of (|p - a_i| - R_i) >= 0.
//
// At the minimum the taut ropes have equal excesses, and shares s_i >= 0 with
//
//   sum of s_i u_i = 0,   sum of s_i = 1,   C = sum of s_i (R_i - |p - a_i|).
//
// C is stationary against motions of p, so its gradient by the bodies is the sum of s_i times the
// gradients of the spans: the multiplier T of the row pulls each span with T_i = s_i T. The point is
// the one in the convex hull of the points a_i: with the barycentric coordinates b_i of p,
// sum of b_i (a_i - p) = 0, so s_i is proportional to b_i r_i. On a subset of the ropes the equations
// |p - a_i| = R_i + v leave, by differences of squares, p linear in v, and a quadratic for v. The
// largest v of all subsets whose point lies in the hull of its ends is that of all ropes.
//
// Elastic ropes have the energy E(p) = sum of max(0, |p - a_i| - R_i)^2 / 2 c_i, with the compliances
// c_i. The energy is convex, and the minimum is the balance of forces. The knot then is one spring
//
//   C = -sqrt(2 E c),   c = sum of c_i,   T = -C / c,   s_i = T_i / T:
//
// its energy is C^2 / 2 c = E and its force T times the gradient of C is that of E. Two ropes end to
// end are one rope of both compliances, with their common tension T.
//
// If every rope has length to spare, no force determines p. The knot then lies where the rope with the
// least spare length has most of it, which is the point above. So p is a function of the poses alone, C
// and its gradient do not jump when the knot becomes taut, and the forces on the bodies sum to 0.

#include <span>
#include <vector>

#include "engine/vector.h"

namespace sheave {

/// A rope of a knot, as seen from the knot.
struct KnotArm {
  Vector3 end = Vector3::Zero();  ///< a: where its span ends [m]
  double reach = 0.0;             ///< R: the distance from there at which it is just taut [m]
  double compliance = 0.0;        ///< c [m/N]; 0 of all arms of a knot, or of none
};

/// The knot in one pose of the bodies.
struct KnotPlace {
  Vector3 point = Vector3::Zero();  ///< p [m]
  /// s: tension of each rope over the force of the knot's row, or that with which it becomes taut
  std::vector<double> shares;
  bool taut = false;  ///< no rope has length to spare, but for rounding
};

inline constexpr int most_knot_arms = 4;

/// Finds the place of a knot with one to `most_knot_arms` arms.
void find_knot_place(std::span<const KnotArm> arms, KnotPlace& place);

/// Whether the rigid arms of a taut knot balance with other shares, too: four ropes that are taut in one
/// plane. Two subsets of the arms then have the same excess, and C has no gradient.
[[nodiscard]] bool has_other_shares(std::span<const KnotArm> arms, const KnotPlace& place);

}  // namespace sheave
