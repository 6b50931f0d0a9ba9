#include "cable/cable_report.h"

#include <algorithm>

#include "cable/cable_system.h"
#include "cable/cut_place.h"
#include "cable/damped_tension.h"
#include "cable/drum_grooves.h"
#include "cable/floor_friction.h"
#include "cable/hanging_rope.h"
#include "cable/rope_inertia.h"
#include "cable/rope_memories.h"
#include "cable/sheaths.h"
#include "cable/simulation.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// Angle over which the stored length is wound [rad]. Layers lie on growing radii
/// (cable/cable_ends.cpp).
double wound_angle(const LinkGeometry& definition, const LinkGeometry& link, double stored_length) {
  if (link.groove) return link.wound;
  if (!(link.layer_pitch > 0.0)) return 2.0 * pi * stored_length / link.perimeter();
  const double grown = std::abs(link.signed_radius) - std::abs(definition.signed_radius);
  return 2.0 * pi * grown / link.layer_pitch;
}

/// The corners of the cable's path from `entry` to `exit` (-1: none), with as many whole turns as
/// the stored length needs.
void find_outline_path(const Substep& now, const LinkGeometry& link, int entry, int exit,
                       double stored_length, std::vector<Vector3>& path) {
  const Outline& curve = link.outline->curve;
  const int count = curve.corner_count();
  constexpr double most_turns = 50.0;  // further turns cannot be seen
  const double longest = std::min(stored_length, most_turns * curve.perimeter());
  // Backwards from the exit; forwards from the entry if the cable ends on the body.
  const bool backwards = exit >= 0;
  const int step = (link.side > 0) == backwards ? count - 1 : 1;
  int corner = backwards ? exit : entry;
  const auto point = [&](int k) { return now.point(link.carrier, link.outline->corners[at(k)]); };
  path.push_back(point(corner));
  double walked = 0.0;
  // A bounded count, because edges of outlines of extreme size may be NaN.
  const int most_corners = static_cast<int>(most_turns + 1.0) * count;
  for (int k = 0; k < most_corners; ++k) {
    const int next = (corner + step) % count;
    const double edge = (curve.corner(next) - curve.corner(corner)).norm();
    const bool arrived = entry >= 0 && exit >= 0 && corner == entry;
    // The tolerance of half an edge covers rounding, and a corner between two contacts.
    if (walked + 0.5 * edge > longest && (arrived || entry < 0 || exit < 0)) break;
    if (walked > longest + curve.perimeter()) break;
    path.push_back(point(next));
    walked += edge;
    corner = next;
  }
  if (backwards) std::reverse(path.begin(), path.end());
}

/// Whether the surface is the points at one distance from a segment.
bool has_segment(const SmoothSurface& surface) {
  return surface.form == SurfaceForm::rounded || surface.form == SurfaceForm::cylinder;
}

SurfaceReport surface_report(const Substep& now, const LinkGeometry& link,
                             const SmoothSurface& surface) {
  return {now.point(link.carrier, surface.center), now.orientation(link.carrier) * surface.axis,
          surface.half_length, surface.radius, surface.form == SurfaceForm::rounded};
}

/// Number of equal parts of a geodesic that follow its bends.
int path_steps(const GeodesicLink& geodesic) {
  constexpr double step_angle = 0.1;  // [rad]
  constexpr double most = 1000.0;
  const SmoothSurface& surface = geodesic.surface;
  double angle = std::abs(geodesic.turned);
  double least = 2.0;
  // Here the bend changes along the way, and the certificate differentiates the path.
  if (surface.form == SurfaceForm::ellipsoid) {
    const double shortest = surface.half_axes.minCoeff();
    angle = std::abs(geodesic.length) * surface.half_axes.maxCoeff() / (shortest * shortest);
    least = 8.0;
  } else if (surface.form == SurfaceForm::torus || surface.form == SurfaceForm::cone) {
    angle =
        std::abs(geodesic.length) / std::min(surface.radius, surface.bend_radius(geodesic.exit));
    least = 8.0;
  }
  return static_cast<int>(std::clamp(std::ceil(angle / step_angle), least, most));
}

/// Points of the geodesic on a smooth body, at equal distances.
void find_geodesic_path(const Substep& now, const LinkGeometry& link, std::vector<Vector3>& path) {
  const GeodesicLink& geodesic = *link.geodesic;
  const int steps = path_steps(geodesic);
  for (int i = 0; i <= steps; ++i) {
    const SurfaceWay way =
        straightest_way(geodesic.surface, geodesic.entry, geodesic.length * i / steps);
    path.push_back(now.point(link.carrier, way.end.point));
  }
}

/// Makes a report as new, with the memory of its list.
void renew(LinkReport& report) {
  std::vector<Vector3> path = std::move(report.path);
  path.clear();
  report = LinkReport{};
  report.path = std::move(path);
}

/// Length that a rope has gained by yielding, with that on its links [m].
double permanent_stretch(const RopeMemory& law, const CableReport& report) {
  double sum = 0.0;
  for (std::size_t i = 0; i < report.spans.size(); ++i) {
    const double length = report.spans[i].rest_length + report.links[i].stored_length;
    sum += length * law.slack(report.spans[i].remembered);
  }
  for (const WrapReport& wrap : report.wraps) {
    sum += (wrap.span.rest_length + wrap.link.stored_length) * law.slack(wrap.span.remembered);
  }
  return sum;
}

void renew(CableReport& report) {
  CableReport fresh;
  fresh.links.swap(report.links);
  fresh.spans.swap(report.spans);
  fresh.wraps.swap(report.wraps);
  report = std::move(fresh);
}

/// Adds the forces of the inertia of the rope.
void add_inertia(const CableSystem& cables, const State& state, int k, SpanReport& span) {
  const auto [at_start, at_end] = RopeInertia::end_forces(cables, state, k);
  span.start_force += at_start;
  span.end_force += at_end;
}

}  // namespace

/// A state to be reported, with the geometry that belongs to it and its spans.
struct CableSystem::CableView {
  const Substep& now;
  const FeatureState& own;
  const Geometry& current;
  const std::vector<SpanGeometry>& ends;
  SpanTensions tensions;
};

/// The memory of reports, for one state.
struct CableSystem::ReportRoom {
  ReportRoom(const BodySet& bodies, const State& state, const FeatureState& part)
      : now(bodies, state, 1.0, 1), own(&part) {}
  Substep now;
  const FeatureState* own;  ///< the part of the state that the cables have; steps exchange it
  SpanTensions tensions = SpanTensions::multipliers;
  Geometry current{};
  std::vector<SpanGeometry> ends{};
  std::vector<int> incoming{};  ///< per link: the span that ends there, -1: none
};

SpanReport CableSystem::span_report(const CableView& view, int k) const {
  const SpanGeometry& geometry = view.ends[at(k)];
  const std::vector<double>& reals = view.own.reals;
  SpanReport span;
  span.start = geometry.start;
  span.end = geometry.end;
  span.length = geometry.length;
  span.rest_length = reals[rest_length_index(k)];
  span.tension = reals[tension_index(k)];
  span.has_tangent = geometry.has_tangent;
  if (hangs(view.now, k)) {
    const SpanSetup& setup = view.current.spans[at(k)];
    const CompiledCable& cable = cables_[at(setup.cable)];
    FloorProfile room;
    const WheelPlane wheels =
        wheel_plane_of(view.now, cable, setup, view.current.links[at(setup.first)],
                       view.current.links[at(setup.second)], geometry,
                       FloorFriction::grip_in(*this, view.now.gravity, view.own, k, room));
    report_hanging(cable, view.now.gravity, geometry, wheels, view.tensions, span);
    add_inertia(*this, view.now.start, k, span);
    return span;
  }
  span.start_force = span.tension * geometry.direction;
  span.end_force = -span.start_force;
  const CompiledCable& cable = cables_[at(spans_[at(k)].cable)];
  if (cable.memory && span.rest_length > 0.0) {
    span.remembered = cable.memory->after(span.length / span.rest_length - 1.0,
                                          RopeMemories::of(*this, view.own, k));
  }
  if (view.tensions == SpanTensions::multipliers) {
    add_inertia(*this, view.now.start, k, span);
    return span;
  }
  // The quantum of lengths is coarse beside the stretch of a stiff rope.
  const double rest_length =
      span.rest_length + reals[remainder_index(k, 0)] + reals[remainder_index(k, 1)];
  const double compliance = compliance_of(cable, rest_length);
  if (!(compliance > 0.0)) return span;
  const double stretch = span.length - rest_length;
  const double spring = cable.spring_tension(stretch, rest_length, compliance, span.remembered);
  if (!cable.is_damped()) {
    span.tension = std::max(0.0, spring);
  } else {
    const SpanSetup& setup = view.current.spans[at(k)];
    const DampedSpan damped{stretch, spring, cable.damper(rest_length),
                            cable.inverse_stiffness > 0.0};
    span.tension = damped_tension(damped, geometry, view.current.links[at(setup.first)],
                                  view.current.links[at(setup.second)], view.now.start.bodies)
                       .value_or(span.tension);
  }
  span.start_force = span.tension * geometry.direction;
  span.end_force = -span.start_force;
  add_inertia(*this, view.now.start, k, span);
  return span;
}

void CableSystem::report_link(const CableView& view, int index, std::array<int, 2> ways,
                              LinkReport& report) const {
  const auto [incoming, outgoing] = ways;
  const Substep& now = view.now;
  const FeatureState& own = view.own;
  const LinkGeometry& link = view.current.links[at(index)];
  renew(report);
  report.body = now.bodies.id(link.touched());
  report.exit_body = link.sheath ? now.bodies.id(link.exit_body()) : report.body;
  report.center = link_center(now, link);
  report.normal = now.orientation(link.carrier) * link.normal;
  report.radius = std::abs(link.signed_radius);
  report.winding = link.side;
  report.stored_length = own.reals[stored_length_index(index)];
  const LinkGeometry& definition = definitions_[at(index)].wraps() ? definitions_[at(index)] : link;
  const double arc = stored_arc(own, index);
  report.stored_stretch = arc - report.stored_length;
  report.most_strain = stored_strain(own, index).most_strain();
  if (link.wraps()) report.wrap_angle = wound_angle(definition, link, arc);
  if (link.groove) report.groove = DrumGrooves::report(now, link, view.ends, ways);
  const int bearing = bearing_of(index);
  if (bearing >= 0) report.bearing_torque = own.reals[bearing_index(bearing)];
  report.stalled = notes_.stalls[at(index)].now;
  (definitions_[at(index)].feeds ? report.fed : report.slip) = own.reals[slip_index(index)];
  const bool lifted = own.integers[mode_index(index)] >= RunningLink::lifted_mode;
  if (lifted || (incoming < 0 && outgoing < 0)) {
    report.touched = !lifted && !link.wraps();
    if (lifted) report.winding = 0, report.radius = report.wrap_angle = 0.0;
    report.entry = report.exit = report.center;
    return;
  }
  if (incoming >= 0) report.entry = report.exit = view.ends[at(incoming)].end;
  if (outgoing >= 0) report.exit = view.ends[at(outgoing)].start;
  if (incoming < 0) report.entry = report.exit;
  if (link.slides && incoming >= 0 && outgoing >= 0) {
    report.wrap_angle =
        wrap_angle(now, link, view.ends[at(incoming)], view.ends[at(outgoing)], arc);
  }
  if (link.opening) report.surface = surface_report(now, link, *link.opening);
  if (link.sheath) {
    report.wrap_angle = link.sheath->bend;
    report.stored_stretch = link.sheath->length - report.stored_length;
    const cable_parts::SheathWork& sheath = sheaths_[at(sheath_places_[at(index)])];
    const SheathProfile profile(std::span(own.reals).subspan(
        sheath_index(at(sheath_places_[at(index)])), SheathProfile::real_count));
    report.most_strain = sheath.law.yield * profile.most_tension();
    Sheaths::draw(now, link, report.path);
  }
  if (link.geodesic) {
    report.wrap_angle = std::max(link.geodesic->turned, 0.0);
    if (has_segment(link.geodesic->surface)) {
      report.surface = surface_report(now, link, link.geodesic->surface);
    }
    find_geodesic_path(now, link, report.path);
  }
  if (link.outline) {
    const int entry_corner = incoming >= 0 ? view.ends[at(incoming)].second_corner : -1;
    const int exit_corner = outgoing >= 0 ? view.ends[at(outgoing)].first_corner : -1;
    find_outline_path(now, link, entry_corner, exit_corner, arc, report.path);
  }
}

void CableSystem::report_wraps(const CableView& view, const CompiledCable& cable,
                               CableReport& report) const {
  const int start = cable.candidates.empty() ? -1 : first_active_span(cable, view.current.spans);
  if (start < 0) return report.wraps.clear();
  int after = 0;
  std::size_t count = 0;
  // An open cable has no span before its first; a belt that has left all listed links begins with a
  // wrap.
  int incoming = span_before(cable, view.current.spans[at(start)].first, view.current.spans);
  for (int walked = 0, k = start; walked <= cable.span_count && k >= 0; ++walked) {
    const SpanSetup& setup = view.current.spans[at(k)];
    if (setup.first <= cable.last_listed_link()) {
      after = setup.first - cable.first_link;
    } else if (incoming >= 0) {
      if (count == report.wraps.size()) report.wraps.emplace_back();
      WrapReport& wrap = report.wraps[count++];
      wrap.after = after;
      report_link(view, setup.first, {incoming, k}, wrap.link);
      wrap.link.type = "wrap";
      wrap.span = span_report(view, k);
    }
    incoming = k;
    if (!cable.closed && setup.second == cable.last_listed_link()) break;
    k = span_after(cable, setup.second);
    if (k == start) break;
  }
  report.wraps.resize(count);
}

void CableSystem::measure(const CableView& view, const CompiledCable& cable,
                          CableReport& report) const {
  const bool rigid = compliance_of(cable, 1.0) == 0.0;
  // The stretch of a span that is almost used up has no meaning; its divisor is this fraction of
  // the cable.
  constexpr double shortest = 1e-6;
  const auto add_span = [&](const SpanReport& span) {
    report.total_length += span.rest_length;
    if (report.cut) return;
    const double from = std::max(span.rest_length, shortest * cable.start_length);
    double& largest = rigid ? report.max_stretch : report.max_strain;
    double longer = (span.length - span.rest_length) / from;
    if (span.hangs && !rigid) {
      longer = std::max(span.start_force.norm(), span.end_force.norm()) * cable.inverse_stiffness;
    }
    largest = std::max(largest, longer);
  };
  const auto index = static_cast<int>(&cable - cables_.data());
  const CableControl* set = view.now.start.controls.cables.find(index);
  double fed = set != nullptr ? set->added_length : 0.0;
  for (const SpanReport& span : report.spans) add_span(span);
  for (const LinkReport& link : report.links) {
    report.total_length += link.stored_length;
    fed += link.fed;
  }
  for (const WrapReport& wrap : report.wraps) {
    add_span(wrap.span);
    report.total_length += wrap.link.stored_length;
  }
  if (report.cut) {
    // The wraps of a cut cable are gone; their cable belongs to the listed span before them.
    report.total_length = 0.0;
    const FeatureState& own = view.own;
    for (int i = 0; i < cable.link_count; ++i) {
      report.total_length += own.reals[stored_length_index(cable.first_link + i)];
    }
    for (int i = 0; i < cable.span_count; ++i) {
      report.total_length += own.reals[rest_length_index(cable.first_span + i)];
    }
    const auto place = CutPlace::of(own.integers[cut_index(index)]);
    const double before = place ? length_to(*place, *this, cable, own) : 0.0;
    report.pieces = {before, report.total_length - before};
  }
  report.floor_loss = FloorFriction::loss(*this, view.own, cable);
  report.hysteresis_loss = RopeMemories::loss(*this, view.own, cable);
  if (cable.memory) report.permanent_stretch = permanent_stretch(*cable.memory, report);
  for (int i = cable.first_link; i < cable.first_link + cable.link_count; ++i) {
    const int place = strain_places_[at(i)];
    if (place >= 0) report.creep_loss += view.own.reals[creep_index(place)];
    const int sheath = sheath_places_[at(i)];
    if (sheath >= 0) report.sheath_loss += view.own.reals[sheath_loss_index(at(sheath))];
  }
  report.length_error = cable.length_error(report.total_length, fed);
}

std::vector<CableReport> CableSystem::report(const BodySet& bodies, const State& state,
                                             const FeatureState& own, SpanTensions tensions) const {
  ReportRoom room(bodies, state, own);
  room.tensions = tensions;
  std::vector<CableReport> reports;
  report(room, reports);
  return reports;
}

void CableSystem::report(ReportRoom& room, std::vector<CableReport>& reports) const {
  const FeatureState& own = *room.own;
  find_geometry(room.now, own, room.current);
  const Geometry& current = room.current;
  room.ends.resize(spans_.size());
  room.incoming.assign(links_.size(), -1);
  for (int k = 0; k < span_count(); ++k) {
    const SpanSetup& setup = current.spans[at(k)];
    if (!setup.active) continue;
    room.incoming[at(setup.second)] = k;
    room.ends[at(k)] = span_geometry(room.now, setup, current.links[at(setup.first)],
                                     current.links[at(setup.second)]);
  }
  const CableView view{room.now, own, current, room.ends, room.tensions};
  reports.resize(cables_.size());
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    CableReport& report = reports[c];
    renew(report);
    report.name = cable.name;
    report.closed = cable.closed;
    report.cut = own.integers[cut_index(static_cast<int>(c))] != 0;
    report.links.resize(at(cable.listed_links));
    report.spans.resize(at(cable.listed_spans));
    for (int i = 0; i < cable.listed_links; ++i) {
      const int link = cable.first_link + i;
      const int k = cable.first_span + i;
      const bool goes_on = i < cable.span_count && current.spans[at(k)].active;
      report_link(view, link, {room.incoming[at(link)], goes_on ? k : -1}, report.links[at(i)]);
      report.links[at(i)].type = cable.link_types[at(i)];
      if (i >= cable.listed_spans) continue;
      SpanReport& span = report.spans[at(i)];
      span = goes_on ? span_report(view, k) : SpanReport{};
      // The cable has left the link: the span is a point at the end of the span that passes the
      // link.
      if (!goes_on)
        span.start = span.end = i > 0 ? report.spans[at(i - 1)].end : report.links[at(i)].center;
    }
    report_wraps(view, cable, report);
    measure(view, cable, report);
  }
}

CableGauge CableReport::gauge() const {
  CableGauge gauge{total_length, length_error, max_stretch, max_strain, 0.0};
  // Only rigid cables report a stretch.
  if (!(max_stretch > 0.0) || cut) return gauge;
  const auto add = [&](const SpanReport& span) {
    gauge.excess += std::max(0.0, span.length - span.rest_length);
  };
  for (const SpanReport& span : spans) add(span);
  for (const WrapReport& wrap : wraps) add(wrap.span);
  return gauge;
}

CableReport CableReport::with_wraps_in_place(std::vector<int>* places) const {
  CableReport whole = *this;
  whole.links.clear();
  whole.spans.clear();
  whole.wraps.clear();
  std::size_t next = 0;
  if (places != nullptr) places->clear();
  for (std::size_t i = 0; i < links.size(); ++i) {
    whole.links.push_back(links[i]);
    if (places != nullptr) places->push_back(static_cast<int>(i));
    if (i < spans.size()) whole.spans.push_back(spans[i]);
    for (; next < wraps.size() && wraps[next].after == static_cast<int>(i); ++next) {
      whole.links.push_back(wraps[next].link);
      whole.spans.push_back(wraps[next].span);
      if (places != nullptr) places->push_back(-1);
    }
  }
  return whole;
}

struct CableReports::Room {
  explicit Room(const Simulation& simulation)
      : definitions(simulation.cable_definitions),
        state(&simulation.world.state()),
        of(simulation.world.bodies(), *state, state->features.back()) {}
  /// The cables of the simulation. No other simulation has this address while the room exists.
  std::shared_ptr<const std::vector<CableDef>> definitions;
  const State* state;
  CableSystem::ReportRoom of;
};

CableReports::CableReports() = default;
CableReports::~CableReports() = default;
CableReports::CableReports(CableReports&&) noexcept = default;
CableReports& CableReports::operator=(CableReports&&) noexcept = default;

void CableReports::read(const Simulation& simulation) {
  const CableSystem* cables = simulation.cables;
  if (cables == nullptr) return reports_.clear();
  const BodySet& bodies = simulation.world.bodies();
  const State& state = simulation.world.state();
  const bool fits = room_ != nullptr && room_->definitions == simulation.cable_definitions &&
                    room_->state == &state && &room_->of.now.bodies == &bodies;
  if (fits) {
    room_->of.own = &state.features.back();
    room_->of.now.restart();
  } else {
    room_ = std::make_unique<Room>(simulation);
  }
  room_->of.tensions = SpanTensions::material;
  cables->report(room_->of, reports_);
}

}  // namespace sheave
