#pragma once
// One linear step towards equilibrium, with the active set of rows.
//
//   [ K + s M   -P^T ] [dq]   [ loads ]      active rows
//   [ J          A   ] [l ] = [ -C    ]      inactive rows: l at its bound, row not violated
//
// K is the geometric stiffness of the forces. s M turns the step into one of implicit Euler from
// rest, of the length 1 / sqrt(s). The matrix is solved by an LU decomposition if it has full rank,
// otherwise for the solution of smallest norm: redundant rows share their load, and free motions
// stay at 0. Islands of the machine have active sets of their own.
//
// Friction in several directions has a common bound b on its vector. Its rows are turned so that the
// first one is along the force, with the bound sqrt(b^2 - l^2) for the force l across it, and friction
// holds across. Where the force has another direction in the end, they are turned again. Friction that
// slides is opposite to its slip s, so the rows across give by |s| / b.

#include "statics/tangent.h"

namespace sheave {

struct NewtonStep {
  VectorX motion;          ///< dq
  VectorX unknowns;        ///< l [N or N m]
  std::vector<char> acts;  ///< per unknown
  bool slips = false;      ///< some friction is at its bound
  bool finite = false;
  int solutions =
      0;  ///< number of linear systems that were solved, of the island with most of them
};

/// `before`: the present unknowns. `shift`: s [1/s2], >= 0.
[[nodiscard]] NewtonStep solve_step(const ConfigurationRows& rows, const ForceTurn& turn,
                                    const MatrixX& mass, const VectorX& before, double shift,
                                    double size);

}  // namespace sheave
