// Cutting a cable, at a given time or when a tension exceeds the breaking tension.
//
// Each of the two pieces has a free end, where the tension is 0. Behind a wrap with the friction
// e^(m a) the tension is at most e^(m a) 0 = 0, so neither piece pulls at any body: the cable loses
// its spans, and with them all of its rows. (A wheel without slip is assumed to let the free end
// run off as well.) A breaking cable acts in full until it breaks: the world ends the substep at
// the instant at which the tension exceeds the breaking tension (engine/instants.h).
//
// The stretch of an elastic cable determines its tension at the end of a substep. The multiplier of
// a rigid cable is a mean, and with `xpbd` the cable turns a velocity of half a substep before, so
// its mean in a part of a substep is no tension at all. The tension of the instant is that of a
// trial motion (engine/instant_forces.h). A jerk, when a rigid cable becomes taut or a load is hit,
// has no tension of an instant, but an impulse. The impulse counts as its mean over a whole
// substep, if that is above twice the tension that is left at the end. A smooth motion does not
// have such means: they lie between the tensions at both ends of the substep, but for terms of
// second order.
//
// A cable that is cut at a given time, or by a trigger, is cut between two substeps, of which the
// first ends at that time. A cable that a program cuts is cut before the next substep. A cut at a
// place (cable/cut_place.h) needs no tension. Where the cut is decides the lengths of the pieces, and
// nothing else.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/cut_place.h"
#include "cable/damped_tension.h"
#include "cable/rope_memories.h"
#include "engine/index.h"

namespace sheave {

void CableSystem::cut(const Substep& substep, FeatureState& next) {
  pulls_.resize(cables_.size());
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    const CompiledCable& cable = cables_[at(c)];
    pulls_[at(c)].mean = 0.0;
    if (next.integers[cut_index(c)] != 0) continue;
    if (!std::isfinite(cable.breaking_tension)) continue;
    int most = -1;
    double tension = 0.0;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      if (!spans_[at(k)].active) continue;
      const double own = end_tension(substep, k, next);
      if (most >= 0 && !(own > tension)) continue;
      most = k;
      tension = own;
    }
    if (most < 0) continue;
    if (cable.is_rigid()) {
      pulls_[at(c)].mean = tension;
      pulls_[at(c)].impulse += substep.h * tension;
      if (substep.breakage == Breakage::by_instants) continue;
    } else {
      overload_ = std::max(overload_, tension - cable.breaking_tension);
    }
    if (substep.breakage == Breakage::never || !(tension > cable.breaking_tension)) continue;
    part_at(cable, {most - cable.first_span}, substep.bodies, substep.next.time, next);
  }
}

double CableSystem::end_tension(const Substep& substep, int span, const FeatureState& next) const {
  const CompiledCable& cable = cables_[at(spans_[at(span)].cable)];
  if (cable.linear_density > 0.0) return hanging_[at(span)].most;
  const double rest_length = next.reals[rest_length_index(span)] +
                             next.reals[remainder_index(span, 0)] +
                             next.reals[remainder_index(span, 1)];
  const double compliance = compliance_of(cable, rest_length);
  const double mean = next.reals[tension_index(span)];
  if (!(compliance > 0.0)) return mean;
  const double stretch = ends_[at(span)][1] - rest_length;
  const double spring =
      cable.spring_tension(stretch, rest_length, compliance, RopeMemories::of(*this, next, span));
  if (!cable.is_damped()) return std::max(0.0, spring);
  // The force of `xpbd` is that of the end of its substep.
  if (substep.load_share == 1.0) return mean;
  const DampedSpan damped{stretch, spring, cable.damper(rest_length),
                          cable.inverse_stiffness > 0.0};
  const SpanSetup& setup = spans_[at(span)];
  return damped_tension(damped, geometry_of(substep, span), links_[at(setup.first)],
                        links_[at(setup.second)], substep.next.bodies)
      .value_or(mean);
}

bool CableSystem::watches(const Controls& controls) const {
  for (std::size_t c = 0; c < defined_.size(); ++c) {
    const CableControl* const set = controls.cables.find(static_cast<int>(c));
    const bool is_set = set != nullptr && !std::isnan(set->breaking_tension);
    if (std::isfinite(is_set ? set->breaking_tension : defined_[c].breaking_tension)) return true;
  }
  return false;
}

void CableSystem::expect(const Expected* /*part*/) {
  overload_ = -std::numeric_limits<double>::infinity();
  pulls_.assign(cables_.size(), {});
}

double CableSystem::margin(const Substep& /*substep*/, const FeatureState& /*own*/) const {
  return overload_;
}

bool CableSystem::asks_for_forces(const FeatureState& own) const {
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    if (!cable.is_rigid() || !std::isfinite(cable.breaking_tension)) continue;
    if (own.integers[cut_index(static_cast<int>(c))] == 0) return true;
  }
  return false;
}

void CableSystem::append_forces(std::vector<double>& forces) const {
  for (const cable_parts::BreakingPull& pull : pulls_) forces.push_back(pull.mean);
}

void CableSystem::tell_forces(std::span<const double> forces, double length) {
  for (std::size_t c = 0; c < pulls_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    cable_parts::BreakingPull& pull = pulls_[c];
    pull.now = c < forces.size() ? forces[c] : pull.mean;
    const double jerk = pull.impulse / length;
    if (jerk > std::max(cable.breaking_tension, 2.0 * pull.now)) pull.now = jerk;
    if (!cable.is_rigid() || !std::isfinite(cable.breaking_tension)) continue;
    overload_ = std::max(overload_, pull.now - cable.breaking_tension);
  }
}

bool CableSystem::arise(const BodySet& bodies, double time, FeatureState& own) {
  bool parts = false;
  for (std::size_t c = 0; c < pulls_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    if (!cable.is_rigid() || own.integers[cut_index(static_cast<int>(c))] != 0) continue;
    if (!(pulls_[c].now > cable.breaking_tension)) continue;
    if (course_changes_ && !follows(own)) follow_course(bodies, own);
    const int most = strongest_span(cable, own);
    if (most < 0) continue;
    part_at(cable, {most - cable.first_span}, bodies, time, own);
    parts = true;
  }
  return parts;
}

std::unique_ptr<ConstraintBatch> CableSystem::copy() const {
  std::unique_ptr<CableSystem> other(new CableSystem(*this));
  other->events_.clear();
  return other;
}

int CableSystem::strongest_span(const CompiledCable& cable, const FeatureState& own) const {
  int most = -1;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (!spans_[at(k)].active) continue;
    if (most < 0 || own.reals[tension_index(k)] > own.reals[tension_index(most)]) most = k;
  }
  return most;
}

void CableSystem::part_at(const CompiledCable& cable, const CutPlace& place, const BodySet& bodies,
                          double time, FeatureState& own) {
  own.integers[cut_index(static_cast<int>(&cable - cables_.data()))] = place.code();
  const int span = cable.first_span + place.span;
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
    part_at(cable, {most - cable.first_span}, bodies, time, own);
    acts = true;
  }
  return acts;
}

bool CableSystem::part(int cable, const BodySet& bodies, double time, FeatureState& own,
                       const CutPlace* place) {
  if (own.integers[cut_index(cable)] != 0) return false;
  if (course_changes_ && !follows(own)) follow_course(bodies, own);
  const CompiledCable& compiled = cables_[at(cable)];
  if (place != nullptr) {
    part_at(compiled, *place, bodies, time, own);
    return true;
  }
  const int most = strongest_span(compiled, own);
  if (most < 0 || !(own.reals[tension_index(most)] > 0.0)) return false;
  part_at(compiled, {most - compiled.first_span}, bodies, time, own);
  return true;
}

}  // namespace sheave
