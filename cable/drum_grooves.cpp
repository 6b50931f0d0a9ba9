#include "cable/drum_grooves.h"

#include <cmath>

#include "cable/span_groove.h"
#include "engine/index.h"

namespace sheave {

void DrumGrooves::finish(const Substep& substep, const FeatureState& next) {
  for (std::size_t c = 0; c < s_.cables_.size(); ++c) {
    const CompiledCable& cable = s_.cables_[c];
    if (cable.closed || next.integers[s_.cut_index(static_cast<int>(c))] != 0) continue;
    for (const bool first : {true, false}) {
      const int link = first ? cable.first_link : cable.last_listed_link();
      const DrumGroove* groove = s_.definitions_[at(link)].groove.get();
      if (groove == nullptr) continue;
      const double full = groove->full_length();
      if (s_.stored_arcs_[at(link)] <= full && s_.stored_arc(next, link) > full) {
        s_.record(substep, cable, link, CableEvent::Kind::full);
      }
      const int span = first ? cable.first_span : CableSystem::span_before(cable, link, s_.spans_);
      if (std::isfinite(groove->most_fleet_angle) && span >= 0) {
        note_fleet_angle(substep, link, span, first);
      }
    }
  }
}

void DrumGrooves::note_fleet_angle(const Substep& substep, int link, int span, bool leaves) {
  const LinkGeometry& drum = s_.links_[at(link)];
  if (!drum.wraps() || !s_.spans_[at(span)].active) return;
  const double angle = std::abs(fleet_angle(substep, drum, s_.geometry_of(substep, span), leaves));
  if (!(angle > drum.groove->most_fleet_angle)) return;
  ++s_.notes_.edition;
  s_.notes_.fleets[at(link)].note(substep.next.time, angle, drum.body);
}

std::vector<cable_parts::FleetWarning> DrumGrooves::fleet_warnings(const CableSystem& system) {
  std::vector<cable_parts::FleetWarning> warnings;
  if (system.notes_.fleets.empty()) return warnings;
  for (const CompiledCable& cable : system.cables_) {
    for (int i = 0; i < cable.listed_links; ++i) {
      const cable_parts::Departure& most = system.notes_.fleets[at(cable.first_link + i)];
      if (most.observed.substeps == 0) continue;
      const LinkGeometry& drum = system.definitions_[at(cable.first_link + i)];
      warnings.push_back(
          {{cable.name, i, most.body, most.observed.substeps, most.observed.first_time},
           most.most,
           drum.groove->most_fleet_angle});
    }
  }
  return warnings;
}

GrooveReport DrumGrooves::report(const Substep& now, const LinkGeometry& link,
                                 const std::vector<SpanGeometry>& ends, std::array<int, 2> ways) {
  GrooveReport groove;
  groove.wound = link.wraps() ? link.wound : 0.0;
  const DrumGroove::Place place = link.groove->at(groove.wound);
  groove.axial_position = place.axial;
  groove.layer = place.layer + 1;
  groove.drum_radius = link.groove->radius;
  groove.course = link.groove;
  const bool leaves = ways[0] < 0;
  const int span = leaves ? ways[1] : ways[0];
  if (span >= 0) groove.fleet_angle = fleet_angle(now, link, ends[at(span)], leaves);
  return groove;
}

double DrumGrooves::fleet_angle(const Substep& now, const LinkGeometry& link,
                                const SpanGeometry& span, bool leaves) {
  return std::asin(fleet_sine(now, link, span, leaves));
}

}  // namespace sheave
