// The order in which a cable runs over its links, as a linked list: each link names the next one
// that the cable touches. Links that it does not touch are not in the list, so inserting and
// removing are local and possible any number of times in a substep. Span k begins at link k; it is
// inactive while the cable does not touch that link.

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/cut_place.h"
#include "cable/floor_friction.h"
#include "cable/rope_memories.h"
#include "engine/index.h"

namespace sheave {

int CableSystem::span_before(const CompiledCable& cable, int link,
                             const std::vector<SpanSetup>& spans) {
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (spans[at(k)].active && spans[at(k)].second == link) return k;
  }
  return -1;
}

int CableSystem::first_active_span(const CompiledCable& cable,
                                   const std::vector<SpanSetup>& spans) {
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (spans[at(k)].active) return k;
  }
  return -1;
}

int CableSystem::next_span(const CompiledCable& cable, int span) const {
  const int next = span_after(cable, spans_[at(span)].second);
  const bool ends = !cable.closed && spans_[at(span)].second == cable.last_listed_link();
  return ends ? cable.first_span : next;
}

void CableSystem::connect_spans(const FeatureState& own, const std::vector<LinkGeometry>& links,
                                std::vector<SpanSetup>& spans) const {
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    const bool whole = own.integers[cut_index(static_cast<int>(c))] == 0;
    if (!cable.course_changes && whole) continue;
    for (int i = 0; i < cable.span_count; ++i) {
      SpanSetup& setup = spans[at(cable.first_span + i)];
      const auto next = static_cast<int>(own.integers[next_index(cable.first_link + i)]);
      setup = span_definitions_[at(cable.first_span + i)];
      setup.active = whole && next >= 0;
      if (!setup.active || setup.second == cable.first_link + next) continue;
      setup.second = cable.first_link + next;
      const LinkGeometry& a = links[at(setup.first)];
      const LinkGeometry& b = links[at(setup.second)];
      const bool planar =
          cable.planar && keeps_plane(cable, i, own) && keeps_plane(cable, next, own);
      // A hybrid end that is a point now may be wound within the substep.
      const bool points = !a.wraps() && !a.hybrid && !b.wraps() && !b.hybrid;
      setup.kind = a.groove || b.groove ? SpanKind::grooved
                   : points             ? SpanKind::straight
                   : planar             ? SpanKind::planar
                                        : SpanKind::spatial;
      setup.normal = cable.normal;
      setup.first_sense = cable.senses[at(i)];
      setup.second_sense = cable.senses[at(next)];
      setup.outlined = a.outline || b.outline;
    }
  }
}

bool CableSystem::keeps_plane(const CompiledCable& cable, int link, const FeatureState& own) const {
  // The listed links of a planar cable stay in its plane.
  if (link < cable.listed_links) return true;
  const std::int64_t wrap = own.integers[wrap_index(cable.first_link + link)];
  return wrap != 0 && cable.candidates[at(static_cast<int>(std::abs(wrap)) - 1)].planar;
}

void CableSystem::place_wraps(const BodySet& bodies, const FeatureState& own,
                              std::vector<LinkGeometry>& links) const {
  for (const CompiledCable& cable : cables_) {
    const auto plane_of = [&](int i) {
      const std::size_t start = plane_index(cable.planes[at(i)]);
      const auto vector = [&](std::size_t k) {
        return Vector3(own.reals[k], own.reals[k + 1], own.reals[k + 2]);
      };
      return WrapPlane{vector(start), vector(start + 3)};
    };
    for (const WrapCandidate& candidate : cable.candidates) {
      if (candidate.listed < 0) continue;
      const WrapPlane plane = plane_of(candidate.listed);
      const int index = cable.first_link + candidate.listed;
      start_geodesic(links[at(index)], plane.center, plane.normal, stored_arc(own, index));
    }
    for (int i = cable.listed_links; i < cable.link_count; ++i) {
      const int index = cable.first_link + i;
      LinkGeometry& link = links[at(index)];
      link = definitions_[at(index)];
      const std::int64_t wrap = own.integers[wrap_index(index)];
      if (wrap == 0) continue;
      const WrapCandidate& candidate = cable.candidates[at(static_cast<int>(std::abs(wrap)) - 1)];
      const WrapPlane plane = plane_of(i);
      if (is_geodesic(candidate)) {
        const double sense = wrap > 0 ? 1.0 : -1.0;
        link = geodesic_link(bodies, candidate, plane.center, sense * plane.normal,
                             stored_arc(own, index));
        link.friction = cable.wrap_friction;
        continue;
      }
      if (candidate.planar) {
        link = candidate.link;
      } else {
        std::optional<LinkGeometry> cut = wrap_link(bodies, candidate, plane);
        if (cut) link = std::move(*cut);
      }
      link.side = wrap > 0 ? 1 : -1;
      link.signed_radius = link.side * std::abs(link.signed_radius);
      link.friction = cable.wrap_friction;
    }
  }
}

void CableSystem::insert_link(const CompiledCable& cable, int after, int link,
                              FeatureState& own) const {
  std::int64_t& next = own.integers[next_index(after)];
  own.integers[next_index(link)] = next;
  next = link - cable.first_link;
}

void CableSystem::remove_link(int before, int link, FeatureState& own) const {
  own.integers[next_index(before)] = own.integers[next_index(link)];
  own.integers[next_index(link)] = -1;
  own.integers[wrap_index(link)] = 0;
}

void CableSystem::follow_course(const BodySet& bodies, const FeatureState& own) {
  refresh(bodies, own, links_, spans_);
  known_.forget();
  affine_.clear();
  connected_for_ = own.integers;
  planes_.assign(own.reals.begin() + static_cast<std::ptrdiff_t>(plane_index(0)),
                 own.reals.begin() + static_cast<std::ptrdiff_t>(plane_index(planes_in_state)));
}

bool CableSystem::accepts(const FeatureState& state) const {
  for (std::size_t i = 0; i < sheaths_.size(); ++i) {
    const std::span reals =
        std::span(state.reals).subspan(sheath_index(i), SheathProfile::real_count);
    if (!SheathProfile::is_sound(reals, sheaths_[i].law.exponent)) return false;
  }
  if (!FloorFriction::accepts(*this, state)) return false;
  for (int k = 0; k < span_count(); ++k) {
    const auto [memory, loss] = RopeMemories::kept(*this, state, k);
    if (!(memory >= 0.0 && std::isfinite(memory) && std::isfinite(loss))) return false;
  }
  const auto integer = [&](std::size_t index) { return state.integers[index]; };
  for (std::size_t i = stall_index(0); i < state.integers.size(); ++i) {
    if (integer(i) < -1 || integer(i) > 1) return false;
  }
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    const std::int64_t cut = integer(cut_index(static_cast<int>(c)));
    if (!CutPlace::is_code(cut, cable.span_count)) return false;
    // The list must contain every touched link once and lead from the first to the cable's end.
    int on_course = 0;
    int first = -1;
    const auto candidates = static_cast<std::int64_t>(cable.candidates.size());
    for (int i = 0; i < cable.link_count; ++i) {
      const int link = cable.first_link + i;
      const std::int64_t next = integer(next_index(link));
      const std::int64_t wrap = integer(wrap_index(link));
      const std::int64_t mode = integer(mode_index(link));
      const std::int64_t slip = integer(slip_state_index(link));
      const bool last = !cable.closed && link == cable.last_listed_link();
      if (next < -1 || next >= cable.link_count || (last && next >= 0)) return false;
      if (mode < 0 || mode > RunningLink::passed_mode || slip < -1 || slip > 1) return false;
      if (wrap < -candidates || wrap > candidates) return false;
      const bool place = i >= cable.listed_links;
      if (place ? (wrap != 0) != (next >= 0) : wrap != 0) return false;
      if (!place && !last && (mode >= RunningLink::lifted_mode) != (next < 0)) return false;
      if (mode >= RunningLink::lifted_mode && !definitions_[at(link)].lifts) return false;
      if (next < 0 && !last) continue;
      ++on_course;
      if (first < 0) first = i;
    }
    int walked = 1;
    int link = first;
    for (; walked < on_course; ++walked) {
      link = static_cast<int>(integer(next_index(cable.first_link + link)));
      if (link < 0 || link == first) return false;
    }
    if (first < 0 || integer(next_index(cable.first_link + link)) != (cable.closed ? first : -1)) {
      return false;
    }
  }
  return true;
}

bool CableSystem::follows(const FeatureState& own) const {
  return own.integers == connected_for_ &&
         std::equal(planes_.begin(), planes_.end(),
                    own.reals.begin() + static_cast<std::ptrdiff_t>(plane_index(0)));
}

}  // namespace sheave
