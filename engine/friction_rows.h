#pragma once
// Dry friction in several directions: two or three rows whose multipliers are one vector l.
//
// Its bound b is that of the norm, whatever the direction (Coulomb). With the slips s, the values of
// the rows at the end of a substep, friction does what takes most energy (maximum dissipation):
//
//   s = 0 and |l| <= b,   or   l = -b s / |s|.
//
// Bounds of each row by itself would be a square, or a cube, that holds up to sqrt(3) of what it
// may, and that turns the motion towards its own axes.
//
// A sweep solves that exactly: s = W l - z with the W that the rows have in common, and of all m >=
// 0 that one where l = (W + m)^-1 z has the norm b. Solvers of all rows at once linearise the law
// about a slip s' of the last round, along u = s' / |s'| and across it:
//
//   l . u = -b,   l . v = -b s . v / |s'|  for v across u:   a row at its bound, and rows that give
//                                                            by |s'| / b per multiplier.
//
// That is Newton's method (engine/solvers/row_friction.cpp). Where friction holds, or as much slips
// as nothing, rows across u do not give: the law has no jump.

#include <span>

#include "engine/row.h"

namespace sheave {

/// The l of the declaration for s = W l - z: `yield` W [1/kg], symmetric and positive semidefinite,
/// `wanted` z, `bound` b >= 0.
[[nodiscard]] Vector3 hold_within(const Matrix3& yield, const Vector3& wanted, double bound);

/// One step of Gauss-Seidel for the rows of one friction, 2 or 3: moves the bodies, and changes
/// their multipliers, which come first in `multipliers`. Returns how far that has moved them along
/// the rows [m or rad].
double solve_friction(std::span<const Row> rows, std::span<double> multipliers,
                      std::span<MovingBody> bodies);

}  // namespace sheave
