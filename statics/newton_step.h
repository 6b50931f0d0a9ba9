#pragma once
// One linear step towards equilibrium, with the rows found that act.
//
//   [ K + s M   -P^T ] [dq]   [ loads ]      rows that act
//   [ J          A   ] [l ] = [ -C    ]      l at its bound, and its row not violated, where not
//
// K is how forces turn; s M makes a step of implicit Euler of it, from rest, whose length is
// 1 / sqrt(s). With the factors of an LU decomposition where the matrix has its full rank, else the
// solution of the smallest norm: redundant rows share what they bear, and what nothing moves stays.

#include "statics/tangent.h"

namespace sheave {

struct NewtonStep {
  VectorX motion;          ///< dq
  VectorX unknowns;        ///< l [N or N m]
  std::vector<char> acts;  ///< per unknown
  bool slips = false;      ///< some friction is at its bound
  bool finite = false;
};

/// `before`: the unknowns of now. `shift`: s [1/s2], >= 0.
[[nodiscard]] NewtonStep solve_step(const ConfigurationRows& rows, const ForceTurn& turn,
                                    const MatrixX& mass, const VectorX& before, double shift,
                                    double size);

}  // namespace sheave
