#include "cable/rope_memories.h"

#include <algorithm>

#include "engine/index.h"

namespace sheave {

double RopeMemories::Stretch::strain() const {
  return rest_length > 0.0 ? std::max(length / rest_length - 1.0, 0.0) : 0.0;
}

template <class Visit>
void RopeMemories::for_each_run(const CompiledCable& cable, Visit visit) const {
  if (cable.shares) return s_.for_each_run(cable, visit);
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (s_.spans_[at(k)].active) visit(CableSystem::Run{k, 1});
  }
}

template <class Length>
RopeMemories::Stretch RopeMemories::stretch_of(const CompiledCable& cable, CableSystem::Run run,
                                               const FeatureState& own, Length length_of) const {
  Stretch sum;
  for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
    sum.length += length_of(k);
    sum.rest_length += own.reals[s_.rest_length_index(k)] + own.reals[s_.remainder_index(k, 0)] +
                       own.reals[s_.remainder_index(k, 1)];
    const int link = s_.spans_[at(k)].second;
    if (s_.strain_places_[at(link)] < 0) continue;
    sum.length += s_.stored_arc(own, link);
    sum.rest_length += own.reals[s_.stored_length_index(link)];
  }
  return sum;
}

void RopeMemories::begin(const Substep& substep, const FeatureState& state) {
  for (const CompiledCable& cable : s_.cables_) {
    if (!cable.memory) continue;
    for_each_run(cable, [&](CableSystem::Run run) {
      const double strain = stretch_of(cable, run, state, [&](int k) {
                              return s_.geometry_of(substep, k).length;
                            }).strain();
      for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
        double m = of(s_, state, k);
        if (!substep.at_rest) m = cable.memory->after(strain, m);
        s_.memories_[at(k)] = {m, strain};
      }
    });
  }
}

void RopeMemories::finish(const Substep& substep, FeatureState& next) const {
  if (substep.at_rest) return;
  for (const CompiledCable& cable : s_.cables_) {
    if (!cable.memory) continue;
    for_each_run(cable, [&](CableSystem::Run run) {
      const Stretch end = stretch_of(cable, run, next, [&](int k) { return s_.ends_[at(k)][1]; });
      const auto [memory, start] = s_.memories_[at(run.first)];
      const double lost = cable.memory->lost(start, end.strain(), memory);
      next.reals[s_.memory_index(s_.memory_places_[at(run.first)]) + 1] += end.rest_length * lost;
      for (int i = 0, k = run.first; i < run.count; ++i, k = s_.next_span(cable, k)) {
        next.reals[s_.memory_index(s_.memory_places_[at(k)])] =
            cable.memory->after(end.strain(), s_.memories_[at(k)][0]);
      }
    });
  }
}

double RopeMemories::of(const CableSystem& system, const FeatureState& own, int span) {
  if (system.memories_.empty()) return 0.0;
  const int place = system.memory_places_[at(span)];
  return place >= 0 ? own.reals[system.memory_index(place)] : 0.0;
}

std::array<double, 2> RopeMemories::kept(const CableSystem& system, const FeatureState& own,
                                         int span) {
  if (system.memories_.empty() || system.memory_places_[at(span)] < 0) return {};
  const std::size_t first = system.memory_index(system.memory_places_[at(span)]);
  return {own.reals[first], own.reals[first + 1]};
}

void RopeMemories::put(const CableSystem& system, const std::array<double, 2>& kept, int span,
                       FeatureState& own) {
  if (system.memories_.empty() || system.memory_places_[at(span)] < 0) return;
  const std::size_t first = system.memory_index(system.memory_places_[at(span)]);
  own.reals[first] = kept[0];
  own.reals[first + 1] = kept[1];
}

double RopeMemories::loss(const CableSystem& system, const FeatureState& own,
                          const CompiledCable& cable) {
  if (!cable.memory) return 0.0;
  double sum = 0.0;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    sum += own.reals[system.memory_index(system.memory_places_[at(k)]) + 1];
  }
  return sum;
}

double RopeMemories::energy(const CableSystem& system, const FeatureState& own, int span,
                            int second, double stretch) {
  const RopeMemory& law = *system.cables_[at(system.spans_[at(span)].cable)].memory;
  const double rest_length = own.reals[system.rest_length_index(span)];
  if (!(rest_length > 0.0)) return 0.0;
  // The rope on the link has the strain of the span.
  const double lies =
      system.strain_places_[at(second)] < 0 ? 0.0 : own.reals[system.stored_length_index(second)];
  return (rest_length + lies) * law.stored(stretch / rest_length, of(system, own, span));
}

void RopeMemories::settle(const CableSystem& system, const BodySet& bodies, const State& state,
                          FeatureState& own) {
  if (system.memories_.empty()) return;
  const Substep now(bodies, state, 1.0, 1);
  CableSystem::Geometry current;
  system.find_geometry(now, own, current);
  for (int k = 0; k < system.span_count(); ++k) {
    const int place = system.memory_places_[at(k)];
    const SpanSetup& setup = current.spans[at(k)];
    const double rest_length = own.reals[system.rest_length_index(k)];
    if (place < 0 || !setup.active || !(rest_length > 0.0)) continue;
    const SpanGeometry span =
        span_geometry(now, setup, current.links[at(setup.first)], current.links[at(setup.second)]);
    double& m = own.reals[system.memory_index(place)];
    m = system.cables_[at(setup.cable)].memory->after(span.length / rest_length - 1.0, m);
  }
}

void RopeMemories::divide(const CableSystem& system, int before, int after, FeatureState& own) {
  if (system.memories_.empty() || system.memory_places_[at(before)] < 0) return;
  own.reals[system.memory_index(system.memory_places_[at(after)])] = of(system, own, before);
}

void RopeMemories::merge(const CableSystem& system, int before, int after, FeatureState& own) {
  if (system.memories_.empty() || system.memory_places_[at(before)] < 0) return;
  const std::size_t kept = system.memory_index(system.memory_places_[at(before)]);
  const std::size_t gone = system.memory_index(system.memory_places_[at(after)]);
  own.reals[kept] = std::max(own.reals[kept], own.reals[gone]);
  own.reals[kept + 1] += own.reals[gone + 1];
  own.reals[gone] = own.reals[gone + 1] = 0.0;
}

}  // namespace sheave
