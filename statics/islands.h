#pragma once
// Islands: parts of a machine that no row and no stiffness couples. Internal to statics.

#include <vector>

#include "statics/configuration.h"

namespace sheave {

/// One island of a machine.
struct Island {
  std::vector<int> freedoms;  ///< degrees of freedom, ascending
  std::vector<int> unknowns;  ///< indices into ConfigurationRows::unknowns, ascending
};

/// All islands. Unknowns whose rows have no degree of freedom belong to the first one. `stiffness`: per
/// pair of degrees of freedom; entries that are not 0 couple.
[[nodiscard]] std::vector<Island> islands_of(const ConfigurationRows& rows,
                                             const MatrixX& stiffness);

/// The rows of an island alone, with indices among its own unknowns.
[[nodiscard]] ConfigurationRows rows_of(const Island& island, const ConfigurationRows& rows);

}  // namespace sheave
