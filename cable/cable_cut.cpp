// Cutting a cable, at a given time or when a tension passes what it bears.
//
// Each of the two pieces has a free end, where the tension is 0. Whatever a piece is wrapped round,
// no more than e^(m a) 0 = 0 can hold behind it, so neither piece pulls at anything any more: the
// spans are gone, and with them all of the cable's rows. (A wheel without slip is taken to let the
// free end run off as well.) A breaking cable acts in full until the end of the substep in which it
// breaks: the tension that counts is the mean over that substep.

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

void CableSystem::cut(const Substep& substep, FeatureState& next) {
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    const CompiledCable& cable = cables_[at(c)];
    std::int64_t& cut_span = next.integers[cut_index(c)];
    if (cut_span != 0) continue;
    int most = -1;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      if (!spans_[at(k)].active) continue;
      if (most < 0 || next.reals[tension_index(k)] > next.reals[tension_index(most)]) most = k;
    }
    // Half a substep: whether times add up to it must not depend on rounding.
    const bool due = substep.next.time > cable.cut_time - 0.5 * substep.h;
    const bool breaks = next.reals[tension_index(most)] > cable.breaking_tension;
    if (!due && !breaks) continue;
    cut_span = 1 + most - cable.first_span;
    record(substep, cable, spans_[at(most)].first, CableEvent::Kind::cut);
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      next.reals[tension_index(k)] = 0.0;
    }
  }
}

}  // namespace sheave
