// Wheels that a cable leaves and touches again (paper, section 4.2).
//
// Leave (merge): the stored length of a rolling link between the ends falls below 0. The spans before and after it become
// one, with the rest length L1 + L2 + s; s is negative, and leaving it out would make cable. The link is lifted.
//
// Touch (split): the span that passes a lifted link cuts its outline from the side on which the link's winding puts it.
// The span becomes two with an arc s between them, s being the angle between the tangents; the rest length that remains,
// L - s, is shared in proportion to the lengths, so both spans have the strain, hence the tension, that the
// one had. Chord and arc differ in the third order of the angle, so what C jumps by is far below the motion of a
// substep.
//
// A lifted link remembers whether the cable is on its winding's side: if it has been carried past to the other side, it
// must come back and clear of the outline before it can touch, or it would be wound on all at once.
//
// Leaving comes first, touching after it, each in the order of the links; what has left does not touch in the same
// substep. So there is at most one event per link and substep, and their order is the same in every run.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {

int CableSystem::span_before(const CompiledCable& cable, int link,
                             const std::vector<SpanSetup>& spans) {
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    if (spans[at(k)].active && spans[at(k)].second == link) return k;
  }
  return -1;
}

void CableSystem::connect_spans(const FeatureState& own, const std::vector<LinkGeometry>& links,
                                std::vector<SpanSetup>& spans) const {
  for (const CompiledCable& cable : cables_) {
    if (!cable.lifts) continue;
    const auto lifted = [&](int i) {
      return own.integers[mode_index(cable.first_link + i)] >= lifted_mode;
    };
    for (int i = 0; i < cable.span_count; ++i) {
      const int k = cable.first_span + i;
      SpanSetup& setup = spans[at(k)];
      setup.active = !lifted(i);
      int next = (i + 1) % cable.link_count;
      while (lifted(next)) next = (next + 1) % cable.link_count;
      setup.second = cable.first_link + next;
      const LinkGeometry& a = links[at(setup.first)];
      const LinkGeometry& b = links[at(setup.second)];
      const bool neighbours = next == (i + 1) % cable.link_count;
      if (neighbours) {
        setup = span_definitions_[at(k)];
        setup.active = !lifted(i);
      } else {
        setup.kind = cable.planar ? SpanKind::planar : SpanKind::spatial;
        setup.normal = cable.normal;
        setup.first_sense = cable.senses[at(i)];
        setup.second_sense = cable.senses[at(next)];
        setup.outlined = a.outline || b.outline;
        if (!a.wraps() && !b.wraps()) setup.kind = SpanKind::straight;
      }
    }
  }
}

void CableSystem::leave_and_touch(const Substep& substep, FeatureState& next) {
  for (const CompiledCable& cable : cables_) {
    if (!cable.lifts) continue;
    std::vector<int> left;
    for (int i = 0; i < cable.link_count; ++i) {
      const int link = cable.first_link + i;
      if (!links_[at(link)].lifts || next.integers[mode_index(link)] != 0) continue;
      if (!(next.reals[stored_length_index(link)] < 0.0)) continue;
      if (leave(substep, cable, link, next)) left.push_back(link);
    }
    for (int i = 0; i < cable.link_count; ++i) {
      const int link = cable.first_link + i;
      if (next.integers[mode_index(link)] < lifted_mode) continue;
      if (std::find(left.begin(), left.end(), link) == left.end())
        touch(substep, cable, link, next);
    }
  }
}

double CableSystem::shift_contact(const Substep& substep, const CompiledCable& cable,
                                  const LinkGeometry& link, const SpanGeometry& from,
                                  const SpanGeometry& to, bool first, double& stored_length) {
  const double shift = link.side * contact_shift(substep, link, from, to, first);
  const double wound = std::round((first ? shift : -shift) / cable.quantum) * cable.quantum;
  stored_length += wound;
  return -wound;
}

bool CableSystem::leave(const Substep& substep, const CompiledCable& cable, int link,
                        FeatureState& next) {
  const Geometry now = geometry_for(next);
  const int before = span_before(cable, link, now.spans);
  const int after = cable.first_span + (link - cable.first_link);
  // A belt on one wheel would be a span from the wheel to itself.
  if (before < 0 || now.spans[at(before)].first == now.spans[at(after)].second) return false;
  double& stored = next.reals[stored_length_index(link)];
  double& rest_before = next.reals[rest_length_index(before)];
  double& rest_after = next.reals[rest_length_index(after)];
  rest_before += rest_after + stored;
  rest_after = stored = 0.0;
  next.integers[mode_index(link)] = lifted_mode;
  next.integers[slip_state_index(link)] = 0;  // it will stick when it touches again
  const auto geometry = [&](const Geometry& g, int k) {
    const SpanSetup& setup = g.spans[at(k)];
    return span_geometry(substep, setup, g.links[at(setup.first)], g.links[at(setup.second)]);
  };
  const Geometry joined = geometry_for(next);
  const SpanGeometry span = geometry(joined, before);
  const int outer_first = joined.spans[at(before)].first;
  const int outer_second = joined.spans[at(before)].second;
  rest_before += shift_contact(substep, cable, joined.links[at(outer_first)], geometry(now, before),
                               span, true, next.reals[stored_length_index(outer_first)]);
  rest_before += shift_contact(substep, cable, joined.links[at(outer_second)], geometry(now, after),
                               span, false, next.reals[stored_length_index(outer_second)]);
  next.reals[tension_index(before)] =
      std::max(next.reals[tension_index(before)], next.reals[tension_index(after)]);
  next.reals[tension_index(after)] = 0.0;
  events_.push_back(
      {substep.next.time, cable.name, link - cable.first_link, CableEvent::Kind::leave});
  return true;
}

void CableSystem::touch(const Substep& substep, const CompiledCable& cable, int link,
                        FeatureState& next) {
  const Geometry now = geometry_for(next);
  const LinkGeometry& wheel = definitions_[at(link)];
  int i = link - cable.first_link;
  do i = (i + cable.link_count - 1) % cable.link_count;
  while (next.integers[mode_index(cable.first_link + i)] >= lifted_mode);
  const int before = cable.first_span + i;
  const SpanSetup& joined = now.spans[at(before)];
  const SpanGeometry span =
      span_geometry(substep, joined, now.links[at(joined.first)], now.links[at(joined.second)]);
  const Clearance clear = clearance(substep, wheel, span);
  std::int64_t& mode = next.integers[mode_index(link)];
  if (mode == passed_mode) {
    if (clear.distance >= 0.0) mode = lifted_mode;
    return;
  }
  if (clear.center_distance < 0.0) {
    mode = passed_mode;
    return;
  }
  const double size = wheel.perimeter();
  if (!(clear.distance < -1e-9 * size) || !clear.between) return;

  FeatureState trial = next;
  trial.integers[mode_index(link)] = 0;
  const Geometry split = geometry_for(trial);
  const int after = cable.first_span + (link - cable.first_link);
  const auto geometry = [&](int k) {
    const SpanSetup& setup = split.spans[at(k)];
    return span_geometry(substep, setup, split.links[at(setup.first)],
                         split.links[at(setup.second)]);
  };
  const SpanGeometry in = geometry(before);
  const SpanGeometry out = geometry(after);
  if (!in.has_tangent || !out.has_tangent || !(in.length + out.length > 0.0)) return;
  const double angle = wrap_angle(substep, split.links[at(link)], in, out, 0.0);
  const double arc = arc_between(substep, split.links[at(link)], in, out, angle);
  // From a skew outline's edge the tangents may turn against the winding, although the span cuts it.
  if (arc < 0.0) return;
  double& rest_before = next.reals[rest_length_index(before)];
  // The span's outer ends move along their links, too, as its direction changes.
  const double whole = rest_before +
                       shift_contact(substep, cable, now.links[at(joined.first)], span, in, true,
                                     next.reals[stored_length_index(joined.first)]) +
                       shift_contact(substep, cable, now.links[at(joined.second)], span, out, false,
                                     next.reals[stored_length_index(joined.second)]);
  const auto quantised = [&](double length) {
    return std::round(length / cable.quantum) * cable.quantum;
  };
  const double stored = std::min(quantised(arc), whole);
  const double kept =
      std::min(quantised((whole - stored) * in.length / (in.length + out.length)), whole - stored);
  rest_before = kept;
  next.reals[rest_length_index(after)] = whole - stored - kept;
  next.reals[stored_length_index(link)] = stored;
  next.reals[tension_index(after)] = next.reals[tension_index(before)];
  mode = 0;
  events_.push_back(
      {substep.next.time, cable.name, link - cable.first_link, CableEvent::Kind::touch});
}

}  // namespace sheave
