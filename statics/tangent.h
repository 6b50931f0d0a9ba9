#pragma once
// A linearised configuration: M q'' + D q' + K q = 0 on the motions that rigid rows allow.
//
// With the unknowns l of a configuration at rest (statics/configuration.h), for small displacements
// q
//
//   K = -d(loads + P^T l)/dq  (l fixed: geometric stiffness)
//       + P^T A^-1 d(C + A l)/dq  over active elastic rows
//
// Active rigid rows allow q = Z z with J Z = 0; their l adapts and drops out of Z^T (...) Z. The
// first part of K is a central difference of forces (statics/difference.h). The other part uses the
// rows' own gradients J = d(C + A l)/dq and is exact, but for approximate rows, whose derivatives
// are differences, too (statics/refined_rows.h). `difference_error` bounds the errors of both.
//
// For a cable with a material and the strain e that passes a wheel, the span's unstretched length L
// changes by dL = -r dtheta / (1 + e) where its cable comes onto the wheel, and by r dtheta / (1 +
// w) where cable with the strain w comes off. With T = EA (l / L - 1) and w = e
//   dT = EA / L (dl - (1 + e) dL) = EA / L (dl -+ r dtheta):
// both strains drop out, which leaves J with the compliance L / EA of the unstretched length.

#include "statics/configuration.h"

namespace sheave {

/// Change of the forces of fixed unknowns with the displacement.
struct ForceTurn {
  MatrixX forces;      ///< d(loads + P^T l)/dq
  double error = 0.0;  ///< error of the difference / largest entry of `forces`, see above
};
/// Leaves the bodies in the configuration's pose. `size`: size of the scene [m], BodySet::scale().
[[nodiscard]] ForceTurn turn_of_forces(Configuration& configuration, const VectorX& unknowns,
                                       double size);

/// Matrices along degrees of freedom.
struct Tangent {
  MatrixX mass;                   ///< M [kg, kg m2]
  MatrixX damping;                ///< D [N s/m, N m s]
  MatrixX stiffness;              ///< K [N/m, N m]
  MatrixX constraints;            ///< J of active rigid rows
  MatrixX motions;                ///< Z, with Z^T M Z = 1
  int rank = 0;                   ///< of `constraints`
  double difference_error = 0.0;  ///< error of K / largest entry of its parts by differences
  /// Error by rounding and differences of an eigenvalue of reduced_stiffness() that is 0 [1/s2].
  double rounding = 0.0;
  /// Number of redundant rows, whose forces are not unique.
  [[nodiscard]] int redundant() const { return static_cast<int>(constraints.rows()) - rank; }
  /// Z^T K Z, its symmetric part [1/s2].
  [[nodiscard]] MatrixX reduced_stiffness() const;
  [[nodiscard]] MatrixX reduced_damping() const;  ///< Z^T D Z [1/s]
};

/// `acts`: per unknown, whether its row is closed or stretched.
[[nodiscard]] Tangent make_tangent(const Configuration& configuration,
                                   const ConfigurationRows& rows, const ForceTurn& turn,
                                   const std::vector<char>& acts);

}  // namespace sheave
