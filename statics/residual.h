#pragma once
// Residuals of an equilibrium: forces that nothing balances, friction beyond its bound, and lengths.
// Internal to statics.

#include <algorithm>
#include <vector>

#include "statics/configuration.h"

namespace sheave {

struct Residual {
  double force = 0.0;   ///< relative to the largest force in the scene
  double length = 0.0;  ///< relative to the size of the scene
  [[nodiscard]] double worst() const { return std::max(force, length); }
};

/// The units of residuals.
struct ResidualScales {
  const MatrixX& mass;  ///< of the degrees of freedom [kg, kg m2]
  double size = 0.0;    ///< of the scene [m]
};

/// `acts`: per unknown, whether its row must be closed. The scale of forces is the largest one in the
/// scene. Forces of rigid rows count up to a hundred times the loads and the forces of springs, because
/// rows that contradict each other can have forces without bound.
[[nodiscard]] Residual residual_of(const ConfigurationRows& rows, const VectorX& unknowns,
                                   const std::vector<char>& acts, const ResidualScales& scales);

}  // namespace sheave
