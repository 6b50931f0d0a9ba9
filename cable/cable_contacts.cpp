// Bodies that a cable leaves and touches again (paper, section 4.2).
//
// Leave (merge): the stored length s of a rolling link between the ends falls below 0. At the
// corner of an outline, which stores no cable, the angle by which the cable is bent falls below 0.
// On a smooth body the cable slides off the end (cable/cable_geodesics.cpp). The spans before and
// after the link become one, with the rest length L1 + L2 + s. The negative s belongs to the sum,
// because the cable would become longer without it. A listed link is then lifted; a wrap on a
// wrappable body no longer exists.
//
// Touch (split): a span cuts the outline of a lifted link from the side on which the link's winding
// puts it, or that of a wrappable body from the side on which the span was before
// (cable/wrap_candidate.h); or a span beside it has come from that side to the other. The span
// becomes two spans with an arc between them, from tangent to tangent. The stored length s is the
// arc, with a material the arc / (1 + strain). The two spans share the remaining rest length L - s
// in proportion to their lengths, so both have the strain of the span before, and with a material
// its tension, too. Chord and arc differ in the third order of the angle, so the jump of C is far
// below the motion of a substep.
//
// The groove of a wheel draws a cable that comes from the side into the plane of the wheel, which
// makes the way longer. A taut cable has no such length, and would be stretched at once: a gain of
// energy. So it is caught only if the groove bends it by at most 6 degrees. Otherwise it
// passes beside the groove, and the run warns with `beside_groove`.
//
// A lifted link remembers whether the cable is on the side of its winding. A cable that has been
// carried past the outline to the other side, beyond an end of the span, must come back and be
// clear of the outline before it can touch. Otherwise a long arc would be wound on at once.
//
// Each substep leaves links first, then touches, then leaves links whose neighbour has been
// touched, each in the order along the cable. A link that has been left or touched has no further
// event in the same substep. So there is at most one event per link and substep, and the order of
// the events is the same in every run. A span does not touch the bodies of its own two links.
//
// A search for equilibrium (Substep::at_rest) leaves no link. A wheel that has been touched is
// kept, with a stored length that may be below 0, as if it held the cable on its side. So the cable
// stays on the same sides of the same wheels in all poses of the search.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/rope_memories.h"
#include "engine/index.h"

namespace sheave {
namespace {

const WrapPlane no_plane{Vector3::Zero(), Vector3::Zero()};

/// Whether the groove of a wheel takes up a cable that passes it on the span `whole`, of the rest
/// length `rest`. In the groove the cable has the spans `in` and `out`, and is longer by `longer`.
bool catches(const Vector3& normal, const SpanGeometry& whole, double rest, double longer,
             const SpanGeometry& in, const SpanGeometry& out) {
  // Fleet angles of 3 degrees on both sides, more than winches have. A stretch of 0.14 % at most.
  constexpr double most = 0.1045284632676535;  // sine of 6 degrees
  const double bend = std::abs(dot(normal, out.direction - in.direction));
  return bend <= most || longer <= std::max(rest - whole.length, 0.0);
}

/// The candidate that is the body of a listed smooth link; -1: the link is no such link.
int candidate_of(const CompiledCable& cable, int link) {
  const auto found =
      std::find_if(cable.candidates.begin(), cable.candidates.end(),
                   [&](const WrapCandidate& c) { return c.listed == link - cable.first_link; });
  return found == cable.candidates.end() ? -1 : static_cast<int>(found - cable.candidates.begin());
}

}  // namespace

template <class Visit>
bool CableSystem::for_each_lifted(const CompiledCable& cable, int span, const FeatureState& state,
                                  Visit visit) const {
  // Listed links that have been left have kept their place between the same listed neighbours.
  int link = listed_before(cable, span);
  for (int walked = 1; walked <= cable.listed_links; ++walked) {
    link = link == cable.last_listed_link() ? cable.first_link : link + 1;
    if (state.integers[mode_index(link)] < RunningLink::lifted_mode) break;
    if (visit(link)) return true;
  }
  return false;
}

void CableSystem::record(const BodySet& bodies, double time, const CompiledCable& cable, int link,
                         CableEvent::Kind kind) {
  knows_lengths_ = false;
  const int listed = link - cable.first_link;
  CableEvent event{time, cable.name, listed < cable.listed_links ? listed : -1, kind};
  const int body = links_[at(link)].touched();
  if (body != bodies.count()) event.body = bodies.name(body);
  events_.push_back(std::move(event));
}

void CableSystem::record(const Substep& substep, const CompiledCable& cable, int link,
                         CableEvent::Kind kind) {
  record(substep.bodies, substep.next.time, cable, link, kind);
}

void CableSystem::remember_sides(const Substep& substep, const CompiledCable& cable,
                                 const FeatureState& state) {
  std::fill_n(faces_.begin() + cable.first_link, cable.link_count, 0);
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    std::vector<WrapSide>& sides = sides_[at(k)];
    sides.assign(cable.candidates.size(), WrapSide{});
    if (!spans_[at(k)].active) continue;
    const SpanGeometry span = geometry_of(substep, k);
    for (std::size_t c = 0; c < sides.size(); ++c) {
      sides[c] = wrap_side(substep, cable.candidates[c], span);
    }
    for_each_lifted(cable, k, state, [&](int link) {
      // The cable is on the other side of a link that it has passed.
      const bool passed = state.integers[mode_index(link)] == RunningLink::passed_mode;
      if (passed || candidate_of(cable, link) >= 0) return false;
      const Clearance clear = clearance(substep, definitions_[at(link)], span);
      faces_[at(link)] = clear.between && clear.center_distance > 0.0 ? 1 : 0;
      return false;
    });
  }
}

void CableSystem::leave_and_touch(const Substep& substep, FeatureState& next) {
  changed_links_.assign(links_.size(), 0);
  for (int c = 0; c < static_cast<int>(cables_.size()); ++c) {
    if (!cables_[at(c)].course_changes || next.integers[cut_index(c)] != 0) continue;
    if (keeps_course(cables_[at(c)], next)) continue;
    left_bodies_.clear();
    if (!substep.at_rest) leave_all(substep, cables_[at(c)], next);
    touch_all(substep, c, next);
    // A touch can take the cable off a neighbour.
    if (!substep.at_rest) leave_all(substep, cables_[at(c)], next);
  }
}

bool CableSystem::keeps_course(const CompiledCable& cable, const FeatureState& next) const {
  // The cheap test reads stored lengths. Outlines need angles, and a material needs strains.
  if (!cable.candidates.empty() || cable.has_outlines || cable.inverse_stiffness > 0.0) {
    return false;
  }
  for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
    if (next.reals[stored_length_index(i)] < 0.0 ||
        next.integers[mode_index(i)] >= RunningLink::lifted_mode) {
      return false;
    }
  }
  return true;
}

void CableSystem::leave_all(const Substep& substep, const CompiledCable& cable,
                            FeatureState& next) {
  const int start = first_active_span(cable, spans_);
  int k = start;
  for (int walked = 0; walked < cable.span_count && k >= 0; ++walked) {
    const int link = spans_[at(k)].second;
    const int following = next_span(cable, k);
    const bool left = links_[at(link)].lifts && changed_links_[at(link)] == 0 &&
                      comes_off(substep, k, link, next) && leave(substep, cable, link, next);
    // The span before a link that has been left now ends at the next one.
    if (!left) k = following;
    if (k == start && !left) break;
  }
}

bool CableSystem::comes_off(const Substep& substep, int span, int link,
                            const FeatureState& next) const {
  const double stored = stored_arc(next, link);
  const LinkGeometry& wheel = links_[at(link)];
  if (wheel.geodesic && wheel.geodesic->slides_off()) return true;
  if (!wheel.outline) return stored < 0.0;
  const SpanSetup& setup = spans_[at(span)];
  const int after = span_after(cables_[at(setup.cable)], link);
  const bool in_space =
      setup.kind == SpanKind::spatial || spans_[at(after)].kind == SpanKind::spatial;
  // On an outline the stored length is a sum of edges, which is rounded.
  constexpr double rounding = 1e-9;
  if (stored < -rounding * wheel.perimeter() && !in_space) return true;
  // Cable bent round one corner has an angle and no stored length. (In space the stored length is
  // not quite that of the edges, either.)
  if (stored > 0.5 * wheel.perimeter()) return false;
  return signed_wrap_angle(substep, wheel, geometry_of(substep, span), geometry_of(substep, after),
                           stored) < 0.0;
}

void CableSystem::touch_all(const Substep& substep, int cable_index, FeatureState& next) {
  const CompiledCable& cable = cables_[at(cable_index)];
  const int start = first_active_span(cable, spans_);
  int k = start;
  // Every touch makes one span more, so there are at most span_count of them.
  for (int walked = 0; walked <= 2 * cable.span_count && k >= 0; ++walked) {
    if (!touch_on_span(substep, cable_index, k, next)) {
      k = next_span(cable, k);
      if (k == start) break;
    }
  }
}

bool CableSystem::touch_on_span(const Substep& substep, int cable_index, int span,
                                FeatureState& next) {
  const CompiledCable& cable = cables_[at(cable_index)];
  const bool touched = for_each_lifted(cable, span, next, [&](int link) {
    if (changed_links_[at(link)] != 0) return false;
    const int smooth = candidate_of(cable, link);
    return smooth >= 0 ? touch_wrappable(substep, cable_index, span, smooth, next)
                       : touch_listed(substep, cable, span, link, next);
  });
  if (touched) return true;
  for (int c = 0; c < static_cast<int>(cable.candidates.size()); ++c) {
    if (cable.candidates[at(c)].listed < 0 && touch_wrappable(substep, cable_index, span, c, next))
      return true;
  }
  return false;
}

int CableSystem::listed_before(const CompiledCable& cable, int span) const {
  int link = spans_[at(span)].first;
  for (int walked = 0; walked < cable.span_count && link > cable.last_listed_link(); ++walked) {
    link = spans_[at(span_before(cable, link, spans_))].first;
  }
  // A belt can have left all of them, so that each may lie at any span.
  return std::min(link, cable.last_listed_link());
}

double CableSystem::shift_contact(const Substep& substep, const CompiledCable& cable, int link,
                                  const SpanGeometry& from, const SpanGeometry& to, bool first,
                                  double strain, FeatureState& next) const {
  const LinkGeometry& wheel = links_[at(link)];
  const double shift = wheel.side * contact_shift(substep, wheel, from, to, first);
  const double wound = cable.quantised((first ? shift : -shift) / (1.0 + strain));
  next.reals[stored_length_index(link)] += wound;
  fit_strain(link, first ? StoredStrain::End::outgoing : StoredStrain::End::incoming, strain, next);
  return -wound;
}

bool CableSystem::leave(const Substep& substep, const CompiledCable& cable, int link,
                        FeatureState& next) {
  const int before = span_before(cable, link, spans_);
  const int after = span_after(cable, link);
  // A belt on one wheel would be a span from the wheel to itself.
  if (before < 0 || spans_[at(before)].first == spans_[at(after)].second) return false;
  const SpanGeometry in = geometry_of(substep, before);
  const SpanGeometry out = geometry_of(substep, after);
  remember_geodesics();
  double& stored = next.reals[stored_length_index(link)];
  double& rest_before = next.reals[rest_length_index(before)];
  double& rest_after = next.reals[rest_length_index(after)];
  rest_before += rest_after + stored;
  rest_after = stored = 0.0;
  fit_strain(link, StoredStrain::End::outgoing, 0.0, next);
  changed_links_[at(link)] = 1;
  record(substep, cable, link, CableEvent::Kind::leave);
  if (link <= cable.last_listed_link()) {
    next.integers[mode_index(link)] = RunningLink::lifted_mode;
  } else {
    left_bodies_.push_back(links_[at(link)].touched());
    put_plane(cable.planes[at(link - cable.first_link)], no_plane, next);
    next.reals[slip_index(link)] = 0.0;
  }
  slip_[at(link)] = 0;  // it will stick when it touches again
  next.integers[slip_state_index(link)] = 0;
  remove_link(spans_[at(before)].first, link, next);
  follow_course(substep.bodies, next);
  settle_geodesics(substep, links_, spans_);
  const SpanGeometry span = geometry_of(substep, before);
  const int first = spans_[at(before)].first;
  const int second = spans_[at(before)].second;
  const double strain = strain_of(cable, span.length, rest_before);
  rest_before += shift_contact(substep, cable, first, in, span, true, strain, next);
  rest_before += shift_contact(substep, cable, second, out, span, false, strain, next);
  shift_geodesics(substep, cable, next);
  double& tension = next.reals[tension_index(before)];
  tension = std::max(tension, next.reals[tension_index(after)]);
  next.reals[tension_index(after)] = 0.0;
  RopeMemories::merge(*this, before, after, next);
  return true;
}

bool CableSystem::touch_listed(const Substep& substep, const CompiledCable& cable, int span,
                               int link, FeatureState& next) {
  const LinkGeometry& wheel = definitions_[at(link)];
  const Clearance clear = clearance(substep, wheel, geometry_of(substep, span));
  // If wraps divide the cable beside the link, only the span that passes the link counts.
  const bool only_span = spans_[at(span)].first <= cable.last_listed_link() &&
                         spans_[at(span)].second <= cable.last_listed_link();
  if (!only_span && !clear.between) return false;
  std::int64_t& mode = next.integers[mode_index(link)];
  if (mode == RunningLink::passed_mode) {
    if (clear.distance >= 0.0) mode = RunningLink::lifted_mode;
    return false;
  }
  const bool past = clear.center_distance < 0.0;
  const bool swept = past && clear.between && faces_[at(link)] != 0;
  if (past && !swept) {
    mode = RunningLink::passed_mode;
    return false;
  }
  if (!swept && !clear.cuts(wheel)) return false;
  mode = 0;
  if (split(substep, cable, span, link, next)) return true;
  mode = RunningLink::lifted_mode;
  return false;
}

bool CableSystem::touch_wrappable(const Substep& substep, int cable_index, int span,
                                  int candidate_index, FeatureState& next) {
  const CompiledCable& cable = cables_[at(cable_index)];
  const WrapCandidate& candidate = cable.candidates[at(candidate_index)];
  const WrapSide before = sides_[at(span)][at(candidate_index)];
  const bool listed = candidate.listed >= 0;
  const int body = candidate.body;
  const bool beside = links_[at(spans_[at(span)].first)].touched() == body ||
                      links_[at(spans_[at(span)].second)].touched() == body;
  // A cable may run from a point of a body over a listed surface of the same body.
  if ((beside && !listed) || before.moment.isZero(0.0) ||
      std::find(left_bodies_.begin(), left_bodies_.end(), body) != left_bodies_.end()) {
    return false;
  }
  const SpanGeometry line = geometry_of(substep, span);
  const WrapSide now = wrap_side(substep, candidate, line, &before);
  const bool swept = before.between && now.between && dot(before.moment, now.moment) < 0.0;
  if (now.distance > candidate.reach && !swept) return false;

  std::optional<WrapPlane> plane;
  int side = 1;
  if (is_geodesic(candidate)) {
    const auto touch = surface_touch(substep, candidate, line, before);
    if (!touch || !touch->cuts(candidate)) return false;
    plane = WrapPlane{touch->at.point, touch->at.across()};
  } else {
    std::optional<LinkGeometry> section;
    if (candidate.planar) {
      section = candidate.link;
    } else if ((plane = wrap_plane(substep, candidate, line))) {
      section = wrap_link(substep.bodies, candidate, *plane);
    }
    if (!section) return false;
    const Vector3 normal = substep.orientation(section->carrier) * section->normal;
    side = section->side = dot(normal, before.moment) > 0.0 ? 1 : -1;
    section->signed_radius = section->side * std::abs(section->signed_radius);
    if (!swept && !clearance(substep, *section, line).cuts(*section)) return false;
  }

  int place = cable.first_link + (listed ? candidate.listed : cable.listed_links);
  const int end = cable.first_link + cable.link_count;
  while (!listed && place < end && next.integers[wrap_index(place)] != 0) ++place;
  if (place == end) {
    Fallback& crowded = notes_.crowded[at(cable_index)];
    ++notes_.edition;
    if (crowded.substeps++ == 0) crowded.first_time = substep.next.time;
    return false;
  }
  const int own_plane = cable.planes[at(place - cable.first_link)];
  std::int64_t& contact = next.integers[listed ? mode_index(place) : wrap_index(place)];
  const std::int64_t none = contact;
  contact = listed ? 0 : side > 0 ? candidate_index + 1 : -candidate_index - 1;
  if (plane) put_plane(own_plane, *plane, next);
  sides_[at(span_after(cable, place))] = sides_[at(span)];
  if (split(substep, cable, span, place, next)) return true;
  contact = none;
  // An unused place leaves no trace in the state.
  if (plane) put_plane(own_plane, no_plane, next);
  return false;
}

void CableSystem::put_plane(int place, const WrapPlane& plane, FeatureState& own) const {
  const std::size_t start = plane_index(place);
  for (int i = 0; i < 3; ++i) {
    own.reals[start + at(i)] = plane.center[i];
    own.reals[start + at(3 + i)] = plane.normal[i];
  }
}

bool CableSystem::split(const Substep& substep, const CompiledCable& cable, int span, int link,
                        FeatureState& next) {
  const SpanGeometry whole = geometry_of(substep, span);
  remember_geodesics();
  const int first = spans_[at(span)].first;
  const int second = spans_[at(span)].second;
  const int after = span_after(cable, link);
  insert_link(cable, first, link, next);
  follow_course(substep.bodies, next);
  settle_geodesics(substep, links_, spans_);
  const SpanGeometry in = geometry_of(substep, span);
  const SpanGeometry out = geometry_of(substep, after);
  const LinkGeometry& wheel = links_[at(link)];
  const bool tangents = in.has_tangent && out.has_tangent && in.length + out.length > 0.0;
  const double turn = tangents ? signed_wrap_angle(substep, wheel, in, out, 0.0) : 0.0;
  const double angle = std::max(turn, 0.0);
  const double way = tangents ? arc_between(substep, wheel, in, out, angle) : 0.0;
  // The line may cut the wheel where the span does not reach, and from a skew outline's edge the
  // tangents may turn against the winding although the span cuts it.
  const bool beside = wheel.outline ? way < 0.0 : turn < 0.0;
  const bool off = wheel.geodesic && wheel.geodesic->slides_off();
  const bool grooved = link <= cable.last_listed_link() && !wheel.outline && !wheel.geodesic;
  const bool aside =
      grooved && tangents &&
      !catches(circle_of(substep, wheel).normal, whole, next.reals[rest_length_index(span)],
               in.length + way + out.length - whole.length, in, out);
  if (aside) {
    ++notes_.edition;
    Fallback& observed = notes_.besides[at(link)].observed;
    if (observed.substeps++ == 0) observed.first_time = substep.next.time;
  }
  if (!tangents || beside || off || aside || (link > cable.last_listed_link() && !(angle > 0.0))) {
    remove_link(first, link, next);
    follow_course(substep.bodies, next);
    settle_geodesics(substep, links_, spans_);
    return false;
  }
  double& rest_before = next.reals[rest_length_index(span)];
  const double strain = strain_of(cable, whole.length, rest_before);
  const double arc = cable.quantised(way / (1.0 + strain));
  // The span's outer ends move along their links, too, as its direction changes.
  const double available = rest_before +
                           shift_contact(substep, cable, first, whole, in, true, strain, next) +
                           shift_contact(substep, cable, second, whole, out, false, strain, next);
  const double stored = std::min(arc, available);
  const double share = in.length / (in.length + out.length);
  const double kept = std::min(cable.quantised((available - stored) * share), available - stored);
  rest_before = kept;
  next.reals[rest_length_index(after)] = available - stored - kept;
  next.reals[stored_length_index(link)] = stored;
  fit_strain(link, StoredStrain::End::outgoing, strain, next);
  shift_geodesics(substep, cable, next);
  next.reals[tension_index(after)] = next.reals[tension_index(span)];
  RopeMemories::divide(*this, span, after, next);
  changed_links_[at(link)] = 1;
  record(substep, cable, link, CableEvent::Kind::touch);
  return true;
}

}  // namespace sheave
