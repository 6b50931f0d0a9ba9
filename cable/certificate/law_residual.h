#pragma once
// The law of a rope with a table against the reported tensions of a substep.

#include <vector>

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// Residual of the law of spans that share a tension.
struct LawResidual {
  double off = 0.0;     ///< as a stretch [m]
  double most = 0.0;    ///< largest stretch, or stretch by a tension [m]
  double loss = 0.0;    ///< energy that the law takes in the substep [J]
  double energy = 0.0;  ///< scale of `loss`: energies stored at both ends, and the work between [J]
};

/// `chain`: the spans, joined by links over which cable passes.
[[nodiscard]] LawResidual law_residual(const Evidence& evidence, const CableEvidence& cable,
                                       const std::vector<std::size_t>& chain);

}  // namespace sheave::certify
