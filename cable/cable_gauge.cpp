// Measures of cables at the end of a substep, from lengths that the substep has computed anyway.

#include <algorithm>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

bool CableSystem::gauge(const FeatureState& own, std::vector<CableGauge>& gauges) const {
  // The lengths of catenaries tell nothing of their strain.
  if (!knows_lengths_ || weighs_) return false;
  gauges.resize(cables_.size());
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    const bool rigid = cable.compliance == 0.0 && cable.inverse_stiffness == 0.0;
    const bool cut = own.integers[cut_index(static_cast<int>(c))] != 0;
    // The stretch of a span that is almost used up has no meaning; its divisor is this fraction of
    // the cable.
    const double shortest = 1e-6 * cable.start_length;
    CableGauge gauge;
    double fed = cable.added_length;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const double rest_length = own.reals[rest_length_index(k)];
      gauge.total_length += rest_length;
      if (cut || !spans_[at(k)].active) continue;
      const double stretch = ends_[at(k)][1] - rest_length;
      if (rigid) gauge.excess += std::max(stretch, 0.0);
      double& largest = rigid ? gauge.max_stretch : gauge.max_strain;
      largest = std::max(largest, stretch / std::max(rest_length, shortest));
    }
    for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
      gauge.total_length += own.reals[stored_length_index(i)];
      if (definitions_[at(i)].feeds) fed += own.reals[slip_index(i)];
    }
    gauge.length_error = cable.length_error(gauge.total_length, fed);
    gauges[c] = gauge;
  }
  return true;
}

bool CableSystem::all_pull(const FeatureState& own) const {
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    if (spans_[k].active && !(own.reals[tension_index(static_cast<int>(k))] > 0.0)) return false;
  }
  return true;
}

}  // namespace sheave
