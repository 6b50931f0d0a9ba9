#pragma once
// A configuration linearised: M q'' + D q' + K q = 0 on the motions that rigid rows leave.
//
// With the unknowns l of a configuration at rest (statics/configuration.h), of small displacements
// q
//
//   K = -d(loads + P^T l)/dq  (l fixed: how forces turn, "geometric stiffness")
//       + P^T A^-1 d(C + A l)/dq  over elastic rows that act
//
// and rigid rows that act allow q = Z z with J Z = 0; there l does what it must, and drops out of
// Z^T (...) Z. The first part is a central difference of forces with two steps, e and 2 e, whose
// errors of the second order cancel: d = (8 (f(e) - f(-e)) - (f(2e) - f(-2e))) / 12 e. What one and
// the other alone say differs by the error of the worse one, which is a bound of that of both and
// is kept (`difference_error`). The steps are shortened for those degrees of freedom where that
// makes the bound smaller: a light pendulum on a large crane. The other part has the rows' own
// gradients J = d(C + A l)/dq, and is exact.
//
// Of a cable of a material with the strain e that passes a wheel: the span's unstretched length L
// changes by dL = -r dtheta / (1 + e) where its cable comes onto the wheel and by r dtheta / (1 + w)
// where it comes off, strained by w there. With T = EA (l / L - 1) and w = e
//   dT = EA / L (dl - (1 + e) dL) = EA / L (dl -+ r dtheta):
// both strains drop out, and what is left is J with the compliance L / EA of the unstretched length.

#include "statics/configuration.h"

namespace sheave {

/// How forces of fixed unknowns change with the displacement.
struct ForceTurn {
  MatrixX forces;      ///< d(loads + P^T l)/dq
  double error = 0.0;  ///< as above, as a share of the largest entry of `forces`
};
/// Leaves the bodies at the configuration's pose. `size`: of the scene [m], BodySet::scale().
[[nodiscard]] ForceTurn turn_of_forces(Configuration& configuration, const VectorX& unknowns,
                                       double size);

/// Matrices along degrees of freedom.
struct Tangent {
  MatrixX mass;                   ///< M [kg, kg m2]
  MatrixX damping;                ///< D [N s/m, N m s]
  MatrixX stiffness;              ///< K [N/m, N m]
  MatrixX constraints;            ///< J of rigid rows that act
  MatrixX motions;                ///< Z, with Z^T M Z = 1
  int rank = 0;                   ///< of `constraints`
  double difference_error = 0.0;  ///< of K, as a share of its largest entry from turning forces
  /// What rounding and differences leave of an eigenvalue of reduced_stiffness() that is 0 [1/s2].
  double rounding = 0.0;
  /// Rows that hold each other and nothing else: of these the forces are not unique.
  [[nodiscard]] int redundant() const { return static_cast<int>(constraints.rows()) - rank; }
  /// Z^T K Z, its symmetric part [1/s2].
  [[nodiscard]] MatrixX reduced_stiffness() const;
  [[nodiscard]] MatrixX reduced_damping() const;  ///< Z^T D Z [1/s]
};

/// `acts`: per unknown whether its row is closed, or stretched.
[[nodiscard]] Tangent make_tangent(const Configuration& configuration,
                                   const ConfigurationRows& rows, const ForceTurn& turn,
                                   const std::vector<char>& acts);

}  // namespace sheave
