#include "cable/cable_report.h"

#include <algorithm>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {
namespace {

/// The angle over which the stored length is wound; layers lie on growing radii (cable/cable_ends.cpp).
double wound_angle(const LinkGeometry& definition, const LinkGeometry& link, double stored_length) {
  if (!(link.layer_pitch > 0.0)) return 2.0 * pi * stored_length / link.perimeter();
  const double grown = std::abs(link.signed_radius) - std::abs(definition.signed_radius);
  return 2.0 * pi * grown / link.layer_pitch;
}

/// Corners from `entry` to `exit`, -1 where there is none, and so many whole turns more that the stored length is used.
std::vector<Vector3> outline_path(const Substep& now, const LinkGeometry& link, int entry, int exit,
                                  double stored_length) {
  const Outline& curve = link.outline->curve;
  const int count = curve.corner_count();
  constexpr double most_turns = 50.0;  // more cannot be seen
  const double longest = std::min(stored_length, most_turns * curve.perimeter());
  // Walked backwards from the exit, or forwards from the entry where the cable ends on the body.
  const bool backwards = exit >= 0;
  const int step = (link.side > 0) == backwards ? count - 1 : 1;
  int corner = backwards ? exit : entry;
  const auto point = [&](int k) { return now.point(link.carrier, link.outline->corners[at(k)]); };
  std::vector<Vector3> path{point(corner)};
  double walked = 0.0;
  while (true) {
    const int next = (corner + step) % count;
    const double edge = (curve.corner(next) - curve.corner(corner)).norm();
    const bool arrived = entry >= 0 && exit >= 0 && corner == entry;
    // Half an edge decides what rounding or a corner between two contacts leaves open.
    if (walked + 0.5 * edge > longest && (arrived || entry < 0 || exit < 0)) break;
    if (walked > longest + curve.perimeter()) break;
    path.push_back(point(next));
    walked += edge;
    corner = next;
  }
  if (backwards) std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace

void CableSystem::append_links(const CompiledCable& cable, const Substep& now,
                               const FeatureState& own, const Geometry& current,
                               std::span<const SpanGeometry> ends, CableReport& report) const {
  for (int i = 0; i < cable.link_count; ++i) {
    const int index = cable.first_link + i;
    const LinkGeometry& link = current.links[at(index)];
    LinkReport entry;
    entry.type = cable.link_types[at(i)];
    entry.body = link.body == now.bodies.count() ? BodyId::world() : BodyId{link.body};
    entry.center = link_center(now, link);
    entry.normal = now.orientation(link.carrier) * link.normal;
    entry.radius = std::abs(link.signed_radius);
    entry.winding = link.side;
    entry.stored_length = own.reals[stored_length_index(index)];
    entry.wrap_angle =
        link.wraps() ? wound_angle(definitions_[at(index)], link, entry.stored_length) : 0.0;
    const double passed = own.reals[slip_index(index)];
    (definitions_[at(index)].feed_speed != 0.0 ? entry.fed : entry.slip) = passed;
    if (own.integers[mode_index(index)] >= lifted_mode) {
      entry.touched = false;
      entry.winding = 0;
      entry.radius = entry.wrap_angle = 0.0;
      entry.entry = entry.exit = entry.center;
      report.links.push_back(entry);
      continue;
    }
    const bool has_incoming = cable.closed || i > 0;
    const bool has_outgoing = cable.closed || i + 1 < cable.link_count;
    const int incoming = i > 0 ? i - 1 : cable.span_count - 1;
    if (has_incoming) entry.entry = entry.exit = report.spans[at(incoming)].end;
    if (has_outgoing) entry.exit = report.spans[at(i)].start;
    if (!has_incoming) entry.entry = entry.exit;
    if (link.outline) {
      const int entry_corner = has_incoming ? ends[at(incoming)].second_corner : -1;
      const int exit_corner = has_outgoing ? ends[at(i)].first_corner : -1;
      entry.path = outline_path(now, link, entry_corner, exit_corner, entry.stored_length);
    }
    report.links.push_back(entry);
  }
}

std::vector<CableReport> CableSystem::report(const BodySet& bodies, const State& state,
                                             const FeatureState& own) const {
  const Substep now(bodies, state, 1.0, 1);
  const Geometry current = geometry_for(own);
  std::vector<CableReport> reports;
  for (const CompiledCable& cable : cables_) {
    CableReport report;
    report.name = cable.name;
    report.closed = cable.closed;
    std::vector<SpanGeometry> ends;
    const bool rigid = compliance_of(cable, 1.0) == 0.0;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const SpanSetup& setup = current.spans[at(k)];
      const SpanGeometry geometry = span_geometry(now, setup, current.links[at(setup.first)],
                                                  current.links[at(setup.second)]);
      if (!setup.active) {
        // The cable has left the link before this span: a point where the span that passes it ends.
        SpanReport none;
        none.start = none.end = report.spans.empty() ? geometry.start : report.spans.back().end;
        ends.push_back(ends.empty() ? geometry : SpanGeometry(ends.back()));
        report.spans.push_back(none);
        continue;
      }
      ends.push_back(geometry);
      SpanReport span;
      span.start = geometry.start;
      span.end = geometry.end;
      span.length = geometry.length;
      span.rest_length = own.reals[rest_length_index(k)];
      span.tension = own.reals[tension_index(k)];
      span.has_tangent = geometry.has_tangent;
      report.total_length += span.rest_length;
      if (rigid && span.rest_length > 0.0) {
        report.max_stretch =
            std::max(report.max_stretch, (span.length - span.rest_length) / span.rest_length);
      }
      report.spans.push_back(span);
    }
    append_links(cable, now, own, current, ends, report);
    double fed = 0.0;
    for (const LinkReport& link : report.links) {
      report.total_length += link.stored_length;
      fed += link.fed;
    }
    report.length_error = (report.total_length - cable.start_length - fed) / cable.start_length;
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace sheave
