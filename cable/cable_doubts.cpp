// Conditions in which the model of a cable does not hold: spans without a tangent, wraps that leave
// their plane, bodies that find no place for a wrap.
//
// A span has no tangent where its attachment has come inside the wheel or drum on which the cable
// lies. The motion ends there (cable/cable_arrival.cpp has the rest of it).
//
// A wrap in space on a body with edges lies in the plane in which the cable came onto the body, as
// in a groove. Without a groove the cable would leave that plane where a span leans out of it, or
// where the sum of the forces of both spans has a component normal to it.
//
// On a smooth body the cable can slide sideways, and friction acts along the cable only. The run
// warns if the cable moves sideways over a body with friction.
//
// On a smooth bar the cable slides along the bar, in the end to the bar's end. The run warns as
// soon as any part of the wrap lies beyond the end; that part lies as on a longer bar. The wrap
// leaves the bar when its middle is beyond the end (cable/cable_geodesics.cpp). The run warns also
// if a free span passes through the flat end of a bar, where the model has no rim.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/floor_friction.h"
#include "cable/heavy_spans.h"
#include "cable/knots.h"
#include "cable/link_contact.h"
#include "engine/index.h"

namespace sheave {

void CableSystem::note_missing_tangent(Substep& substep, int span) {
  ++notes_.edition;
  Fallback& missing = notes_.fallbacks[at(span)];
  if (missing.substeps++ == 0) missing.first_time = substep.next.time;
  ++substep.statistics.geometry_fallbacks;
  const SpanSetup& setup = spans_[at(span)];
  const LinkGeometry& first = links_[at(setup.first)];
  const LinkGeometry& second = links_[at(setup.second)];
  const bool wheel_first = first.wraps();
  const LinkGeometry& wheel = wheel_first ? first : second;
  const LinkGeometry& point = wheel_first ? second : first;
  const int link = wheel_first ? setup.first : setup.second;
  if (point.wraps() || point.hybrid || !wheel.wraps() || wheel.outline) return;
  // The end of a cable may lie within a wrappable body; there is a warning for that. An attachment
  // between two spans has come there over the rim.
  const CompiledCable& cable = cables_[at(setup.cable)];
  const int held = wheel_first ? setup.second : setup.first;
  const bool between = std::find(cable.grips.begin(), cable.grips.end(), held) != cable.grips.end();
  if (link > cable.last_listed_link() && !between) return;
  // A kinematic body may be led through a wheel, as by a pointer; there is a warning for that.
  if (point.body < substep.bodies.count() &&
      substep.bodies[point.body].mobility == Mobility::kinematic) {
    return;
  }
  // Beyond this distance the tangent is missing because the span leans out of the wheel's plane.
  // A drum that has wound up its cable stalls with the attachment at its rim, where rounding
  // decides whether there is a tangent. There the attachment must be below the rim, and the stall
  // has told of the end.
  if (!wheel.lifts && drive_work_.locked[at(link)] != 0) return;
  const double beside_squared = wheel.lifts ? 2.0 : 0.98;
  const LinkCircle circle = circle_of(substep, wheel);
  const Vector3 apart = center_of(substep, point, 0) - circle.center;
  const double seen_squared = cross(circle.normal, apart).squaredNorm();
  if (seen_squared < beside_squared * wheel.signed_radius * wheel.signed_radius)
    arrived_ = cable_parts::arrival_on(setup, links_);
}

using cable_parts::is_undetermined;
using cable_parts::undetermined_text;

std::string CableSystem::dead_end(const Substep& substep) const {
  const auto name_of = [&](const CompiledCable& cable, int link) {
    const int body = links_[at(link)].touched();
    return "link " + std::to_string(link - cable.first_link) + " on \"" +
           (body == substep.bodies.count() ? "world" : substep.bodies.name(body)) + "\"";
  };
  if (left_ >= 0) {
    const auto owns = [&](const CompiledCable& c) { return left_ < c.first_link + c.link_count; };
    const CompiledCable& cable = *std::find_if(cables_.begin(), cables_.end(), owns);
    return "cable \"" + cable.name + "\" has left the wheel of " + name_of(cable, left_) +
           ", and a rope with weight stays on its wheels: end the run before that, or leave "
           "\"linear_density\" out, and the cable leaves wheels and comes back";
  }
  for (const cable_parts::KnotWork& knot : knots_) {
    if (!substep.at_rest && is_undetermined(knot)) return undetermined_text(substep.bodies, knot);
  }
  for (std::size_t k = 0; weighs_ && k < spans_.size(); ++k) {
    if (!spans_[k].active || !hanging_[k].runs_out) continue;
    const CompiledCable& cable = cables_[at(spans_[k].cable)];
    const int link = links_[at(spans_[k].first)].passes() ? spans_[k].first : spans_[k].second;
    if (cable.has_floor()) {
      return "cable \"" + cable.name + "\": the rope beside " + name_of(cable, link) +
             " comes to lie slack on its floor, and rope without inertia has no law of motion "
             "there: "
             "make the rope shorter, give a wheel a spin inertia, or end the run before that";
    }
    return "cable \"" + cable.name + "\": its weight pulls the rope through " +
           name_of(cable, link) +
           " without end, because no taut rope balances the spans there: make the rope tighter, "
           "end the run before that, or leave \"linear_density\" out";
  }
  if (const std::string fault = HeavySpans::floor_fault(*this, substep); !fault.empty())
    return fault;
  if (stray_ >= 0) return FloorFriction::stray_fault(*this, stray_);
  if (weighs_) {
    // A control may have turned gravity since the cable was compiled.
    constexpr double rounding = 1e-9;
    const double least = rounding * substep.gravity.norm();
    for (const SpanSetup& setup : spans_) {
      const CompiledCable& cable = cables_[at(setup.cable)];
      const int wheel = links_[at(setup.first)].wraps() ? setup.first : setup.second;
      if (!setup.active || cable.linear_density == 0.0 || !links_[at(wheel)].wraps()) continue;
      if (std::abs(dot(setup.normal, substep.gravity)) <= least) continue;
      return "cable \"" + cable.name +
             "\" has weight, and gravity has left the plane of the wheel of " +
             name_of(cable, wheel) + ": keep gravity in the plane, or leave \"linear_density\" out";
    }
  }
  if (arrived_.cable < 0) return {};
  return sentence_of(arrived_, cables_[at(arrived_.cable)], substep.bodies);
}

namespace {

/// Depth below the rim at which a span passes through a flat end of a cylinder or cone [m]; 0: it
/// does not.
double depth_in_end(const Substep& substep, const WrapCandidate& candidate,
                    const SpanGeometry& span) {
  const SmoothSurface& surface = *candidate.surface;
  const Vector3 axis = substep.orientation(candidate.body) * surface.axis;
  const Vector3 start = span.start - substep.point(candidate.body, surface.center);
  const Vector3 way = span.end - span.start;
  const double rise = dot(axis, way);
  double depth = 0.0;
  for (const double end : {-surface.half_length, surface.half_length}) {
    const double share = rise != 0.0 ? (end - dot(axis, start)) / rise : 0.0;
    if (!(share > 0.0) || !(share < 1.0)) continue;
    const double rim = surface.radius + surface.slope * end;
    depth = std::max(depth, rim - (start + share * way - end * axis).norm());
  }
  return depth;
}

}  // namespace

void CableSystem::note_leans(const Substep& substep, const CompiledCable& cable) {
  constexpr double most = 0.0174524064372835;  // sine of 1 degree
  // Below this resultant the cable hardly touches the body, and its direction is undefined.
  constexpr double least_pull = 1e-3;
  for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
    const int link = spans_[at(k)].second;
    if (!spans_[at(k)].active) continue;
    const auto index = at(spans_[at(k)].cable);
    const auto note_off_end = [&](double beyond, int on) {
      if (!(beyond > 0.0)) return;
      ++notes_.edition;
      notes_.off_ends[index].note(substep.next.time, beyond, on);
    };
    if (const auto& opening = links_[at(link)].opening) {
      note_off_end(opening->beyond_ends(links_[at(link)].center), links_[at(link)].body);
      continue;
    }
    for (const WrapCandidate& candidate : cable.candidates) {
      const bool bar = is_geodesic(candidate) && candidate.surface->has_ends();
      if (!bar || links_[at(spans_[at(k)].first)].touched() == candidate.body ||
          links_[at(link)].touched() == candidate.body) {
        continue;
      }
      const double depth = depth_in_end(substep, candidate, geometry_of(substep, k));
      if (depth > 1e-9 * substep.bodies.scale()) note_off_end(depth, candidate.body);
    }
    if (spans_[at(k)].kind != SpanKind::spatial) continue;
    const int body = links_[at(link)].body;
    if (const auto& geodesic = links_[at(link)].geodesic) {
      const SurfaceFrame& start = geodesic_starts_[at(link)].entry;
      const Vector3 moved = geodesic->entry.point - start.point;
      const double aside = std::abs(dot(moved, start.across()));
      if (links_[at(link)].friction > 0.0 && aside > 1e-9 * substep.bodies.scale() &&
          aside > most * moved.norm()) {
        ++notes_.edition;
        notes_.leans[index].note(substep.next.time, std::min(aside / moved.norm(), 1.0), body);
      }
      if (geodesic->surface.is_hollow(geodesic->entry) ||
          geodesic->surface.is_hollow(geodesic->exit)) {
        ++notes_.edition;
        notes_.hollows[index].note(substep.next.time, geodesic->length, body);
      }
      note_off_end(std::max(geodesic->surface.beyond_ends(geodesic->entry.point),
                            geodesic->surface.beyond_ends(geodesic->exit.point)),
                   body);
      continue;
    }
    if (link <= cable.last_listed_link()) continue;
    const Vector3 in = geometry_of(substep, k).direction;
    const Vector3 out = geometry_of(substep, span_after(cable, link)).direction;
    const Vector3 normal = circle_of(substep, links_[at(link)]).normal;
    double sine = std::max(std::abs(dot(normal, in)), std::abs(dot(normal, out)));
    const Vector3 pull = out - in;
    const double size = pull.norm();
    if (size > least_pull) sine = std::max(sine, std::abs(dot(normal, pull)) / size);
    if (!(sine > most)) continue;
    ++notes_.edition;
    notes_.leans[index].note(substep.next.time, std::min(sine, 1.0), body);
  }
}

std::vector<cable_parts::TangentWarning> CableSystem::tangent_warnings() const {
  std::vector<cable_parts::TangentWarning> warnings;
  for (int k = 0; k < span_count(); ++k) {
    const Fallback& fallback = notes_.fallbacks[at(k)];
    if (fallback.substeps == 0) continue;
    const CompiledCable& cable = cables_[at(spans_[at(k)].cable)];
    const int span = k - cable.first_span;
    warnings.push_back({cable.name, span < cable.listed_spans ? span : -1, fallback.substeps,
                        fallback.first_time});
  }
  return warnings;
}

std::vector<cable_parts::WrapWarning> CableSystem::wrap_warnings() const {
  std::vector<cable_parts::WrapWarning> warnings;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    if (notes_.crowded[c].substeps == 0) continue;
    warnings.push_back({cables_[c].name, notes_.crowded[c].substeps, notes_.crowded[c].first_time});
  }
  return warnings;
}

std::vector<cable_parts::LeanWarning> CableSystem::lean_warnings() const {
  std::vector<cable_parts::LeanWarning> warnings;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const cable_parts::Departure& lean = notes_.leans[c];
    if (lean.observed.substeps == 0) continue;
    warnings.push_back({cables_[c].name, lean.body, std::asin(lean.most), lean.observed.substeps,
                        lean.observed.first_time});
  }
  return warnings;
}

std::vector<cable_parts::MisplacedWarning> CableSystem::misplaced_warnings() const {
  std::vector<cable_parts::MisplacedWarning> warnings;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    for (const bool hollow : {false, true}) {
      const cable_parts::Departure& off = hollow ? notes_.hollows[c] : notes_.off_ends[c];
      if (off.observed.substeps == 0) continue;
      warnings.push_back({cables_[c].name, off.body, hollow, off.most, off.observed.substeps,
                          off.observed.first_time});
    }
  }
  return warnings;
}

}  // namespace sheave
