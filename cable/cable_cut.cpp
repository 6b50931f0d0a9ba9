// Cutting a cable, at a given time or when a tension passes what it bears.
//
// Each of the two pieces has a free end, where the tension is 0. Whatever a piece is wrapped round,
// no more than e^(m a) 0 = 0 can hold behind it, so neither piece pulls at anything any more: the
// spans are gone, and with them all of the cable's rows. (A wheel without slip is taken to let the
// free end run off as well.) A breaking cable acts in full until the end of the substep in which it
// breaks: the tension that counts is the mean over that substep. One that is cut at a given time is
// cut at the end of the substep that is nearest to it, and one that is cut by hand, or by a trigger,
// before the next substep.

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

void CableSystem::cut(const Substep& substep, FeatureState& next) {
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    const CompiledCable& cable = cables_[at(c)];
    if (next.integers[cut_index(c)] != 0) continue;
    const int most = strongest_span(cable, next);
    if (most < 0) continue;
    // Half a substep: whether times add up to it must not depend on rounding.
    const bool due = substep.next.time > cable.cut_time - 0.5 * substep.h;
    const bool breaks = next.reals[tension_index(most)] > cable.breaking_tension;
    if (!due && !breaks) continue;
    part_at(cable, most, substep.bodies, substep.next.time, next);
  }
}

int CableSystem::strongest_span(const CompiledCable& cable, const FeatureState& own) const {
  int most = -1;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!spans_[at(k)].active) continue;
    if (most < 0 || own.reals[tension_index(k)] > own.reals[tension_index(most)]) most = k;
  }
  return most;
}

void CableSystem::part_at(const CompiledCable& cable, int span, const BodySet& bodies, double time,
                          FeatureState& own) {
  own.integers[cut_index(static_cast<int>(&cable - cables_.data()))] = 1 + span - cable.first_span;
  record(bodies, time, cable, spans_[at(span)].first, CableEvent::Kind::cut);
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    own.reals[tension_index(k)] = 0.0;
  }
}

bool CableSystem::part(int cable, const BodySet& bodies, double time, FeatureState& own) {
  if (own.integers[cut_index(cable)] != 0) return false;
  if (course_changes_ && !follows(own)) follow_course(bodies, own);
  const CompiledCable& compiled = cables_[at(cable)];
  const int most = strongest_span(compiled, own);
  if (most < 0 || !(own.reals[tension_index(most)] > 0.0)) return false;
  part_at(compiled, most, bodies, time, own);
  return true;
}

}  // namespace sheave
