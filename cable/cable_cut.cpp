// Cutting a cable, at a given time or when a tension exceeds the breaking tension.
//
// Each of the two pieces has a free end, where the tension is 0. Behind a wrap with the friction
// e^(m a) the tension is at most e^(m a) 0 = 0, so neither piece pulls at any body: the cable
// loses its spans, and with them all of its rows. (A wheel without slip is assumed to let the
// free end run off as well.) A breaking cable acts in full until the end of the substep in which it
// breaks: the tension that counts is the mean over that substep. A cable that is cut at a given
// time, or by a trigger, is cut between two substeps, of which the first ends at that time
// (engine/instants.h). A cable that a program cuts is cut before the next substep.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

void CableSystem::cut(const Substep& substep, FeatureState& next) {
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    const CompiledCable& cable = cables_[at(c)];
    if (next.integers[cut_index(c)] != 0) continue;
    const int most = strongest_span(cable, next);
    if (most < 0) continue;
    if (!(next.reals[tension_index(most)] > cable.breaking_tension)) continue;
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

bool CableSystem::has_instants() const {
  return std::any_of(cables_.begin(), cables_.end(),
                     [](const CompiledCable& cable) { return std::isfinite(cable.cut_time); });
}

double CableSystem::next_instant(const FeatureState& own) const {
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    if (own.integers[cut_index(static_cast<int>(c))] != 0) continue;
    first = std::min(first, cables_[c].cut_time);
  }
  return first;
}

bool CableSystem::act_at(const BodySet& bodies, double time, double until, FeatureState& own) {
  bool acts = false;
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    const CompiledCable& cable = cables_[at(c)];
    if (own.integers[cut_index(c)] != 0 || !(cable.cut_time < until)) continue;
    if (course_changes_ && !follows(own)) follow_course(bodies, own);
    const int most = strongest_span(cable, own);
    if (most < 0) continue;
    part_at(cable, most, bodies, time, own);
    acts = true;
  }
  return acts;
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
