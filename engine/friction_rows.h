#pragma once
// Dry friction in several directions: two or three rows whose multipliers form one vector l.
//
// The bound b limits the norm of l in every direction (Coulomb). The slips s are the values of the
// rows at the end of a substep. Friction dissipates the most energy that the bound allows (maximum
// dissipation):
//
//   s = 0 and |l| <= b,   or   l = -b s / |s|.
//
// A bound on each row by itself would make the set of allowed l a square or a cube. Friction could
// then hold up to sqrt(3) b, and sliding would be deflected towards the axes of the rows.
//
// A Gauss-Seidel sweep solves the law exactly. With s = W l - z, where W is the effective inverse
// mass of the rows, the sweep takes the m >= 0 for which l = (W + m)^-1 z has the norm b. Solvers
// of all rows at once linearise the law about the slip s' of the last round, along u = s' / |s'|
// and across it:
//
//   l . u = -b,   l . v = -b s . v / |s'|  for v across u:   a row at its bound, and rows that
//                                                            give by |s'| / b per multiplier.
//
// This linearisation is Newton's method (engine/solvers/row_friction.cpp). Where friction sticks,
// or the slip is negligible, the rows across u do not give: the law is continuous there.

#include <span>

#include "engine/row.h"

namespace sheave {

/// The vector l of the head of this file for s = W l - z: `yield` is W [1/kg], symmetric and
/// positive semidefinite, `wanted` is z, `bound` is b >= 0.
[[nodiscard]] Vector3 hold_within(const Matrix3& yield, const Vector3& wanted, double bound);

/// One Gauss-Seidel step for the 2 or 3 rows of one friction. Moves the bodies and changes the
/// first entries of `multipliers`. Returns the length of the correction along the rows [m or rad].
double solve_friction(std::span<const Row> rows, std::span<double> multipliers,
                      std::span<MovingBody> bodies);

}  // namespace sheave
