#include "cable/cable_report.h"

#include <algorithm>

#include "cable/cable_system.h"
#include "engine/index.h"

namespace sheave {
void CableSystem::append_links(const CompiledCable& cable, const Substep& now,
                               const FeatureState& own, CableReport& report) const {
  for (int i = 0; i < cable.link_count; ++i) {
    const int index = cable.first_link + i;
    const LinkGeometry& link = links_[at(index)];
    LinkReport entry;
    entry.type = cable.link_types[at(i)];
    entry.body = link.body == now.bodies.count() ? BodyId::world() : BodyId{link.body};
    entry.center = link_center(now, link);
    entry.normal = now.orientation(link.carrier) * link.normal;
    entry.radius = std::abs(link.signed_radius);
    entry.winding = link.side;
    entry.stored_length = own.reals[stored_length_index(index)];
    entry.wrap_angle = link.wraps() ? 2.0 * pi * entry.stored_length / link.perimeter() : 0.0;
    entry.slip = own.reals[slip_index(index)];
    const bool has_incoming = cable.closed || i > 0;
    const bool has_outgoing = cable.closed || i + 1 < cable.link_count;
    const int incoming = i > 0 ? i - 1 : cable.span_count - 1;
    if (has_incoming) entry.entry = entry.exit = report.spans[at(incoming)].end;
    if (has_outgoing) entry.exit = report.spans[at(i)].start;
    if (!has_incoming) entry.entry = entry.exit;
    report.links.push_back(entry);
  }
}

std::vector<CableReport> CableSystem::report(const BodySet& bodies, const State& state,
                                             const FeatureState& own) const {
  const Substep now(bodies, state, 1.0, 1);
  std::vector<CableReport> reports;
  for (const CompiledCable& cable : cables_) {
    CableReport report;
    report.name = cable.name;
    report.closed = cable.closed;
    const bool rigid = compliance_of(cable, 1.0) == 0.0;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const SpanSetup& setup = spans_[at(k)];
      const SpanGeometry geometry =
          span_geometry(now, setup, links_[at(setup.first)], links_[at(setup.second)]);
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
    append_links(cable, now, own, report);
    for (const LinkReport& link : report.links) report.total_length += link.stored_length;
    report.length_error = (report.total_length - cable.start_length) / cable.start_length;
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace sheave
