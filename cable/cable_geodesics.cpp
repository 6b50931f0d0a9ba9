// Wraps on smooth bodies: balls, cylinders, capsules.
//
// A smooth body holds no rope sideways. The rope lies along a geodesic, so its whole path between
// the ends of its two spans is the shortest. The geodesics on several such bodies in a row are
// found together for the present positions (cable/geodesic_chain.h). A span sees the body as a
// point, the end of the geodesic.
//
// The path length l1 + s + l2, with the length s on the body, is stationary against motions of the
// geodesic's ends on the surface. The gradient of C is therefore still the direction of each span
// at its end. Together the spans press on the body, and they have no moment about the axis of a
// bar. If the end of a geodesic with the unit tangent t moves by da on the surface of the body, its
// span changes by t.da, and s by the difference of both ends; motion across the rope changes
// neither. The incoming span therefore gains t.da of the entry, and the outgoing span the rest,
//   passed_on = -(s - s0) - taken_on.
// Without friction both spans are one run (cable/cable_runs.cpp), and the division does not matter.
// Friction acts along the rope only. A rope that sticks to the body gains the lengths above; the
// exponent of friction is that of SurfaceWay::turned.
//
// The start of the geodesic at the end of the substep is part of the state. The cable leaves the
// body (cable/cable_contacts.cpp) where no geodesic exists on its side of the body any more, and
// where the middle of the geodesic is beyond the end of a bar.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/cable_system.h"
#include "cable/geodesic_chain.h"
#include "cable/geodesic_row.h"
#include "cable/link_contact.h"
#include "cable/opening.h"
#include "engine/index.h"

namespace sheave {
namespace {

Vector3 to_own(const Substep& substep, int body, const Vector3& point) {
  return substep.orientation(body).conjugate() * (point - substep.position(body));
}

GeodesicStop stop_at(const Substep& substep, const LinkGeometry& link) {
  const GeodesicLink& geodesic = *link.geodesic;
  const Quaternion orientation = substep.orientation(link.carrier);
  GeodesicStop stop;
  stop.surface = surface_now(substep, link.carrier, geodesic.surface);
  stop.entry = stop.surface.frame(substep.point(link.carrier, geodesic.entry.point),
                                  orientation * geodesic.entry.tangent);
  stop.length = geodesic.length;
  return stop;
}

/// Distance by which a point of the geodesic has moved along it [m]; exact for a turn in a circle.
double way_of(const SurfaceFrame& from, const SurfaceFrame& to) {
  const double cosine = dot(from.tangent, to.tangent);
  const double sine = cross(from.tangent, to.tangent).norm();
  const double share = sine > 0.0 ? angle_of(sine, cosine) / sine : 1.0;
  return 0.5 * share * dot(from.tangent + to.tangent, to.point - from.point);
}

/// The places at which the cable passes its openings, for the present positions.
void settle_openings(const Substep& substep, const CompiledCable& cable,
                     std::vector<LinkGeometry>& links) {
  const int count = cable.listed_links;
  for (const int link : cable.openings) {
    const int place = link - cable.first_link;
    settle_opening(substep, links[at(cable.first_link + (place + count - 1) % count)],
                   links[at(cable.first_link + (place + 1) % count)], links[at(link)]);
  }
}

}  // namespace

/// Visits (cable, link, incoming span, outgoing span) of each.
template <class Visit>
void CableSystem::for_each_geodesic(Visit visit) const {
  for (const CompiledCable& cable : cables_) {
    if (!cable.has_geodesics) continue;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const int link = spans_[at(k)].second;
      if (spans_[at(k)].active && links_[at(link)].geodesic) {
        visit(cable, link, k, span_after(cable, link));
      }
    }
  }
}

void CableSystem::settle_geodesics(const Substep& substep, std::vector<LinkGeometry>& links,
                                   const std::vector<SpanSetup>& spans) const {
  std::vector<LinkGeometry*> row;
  std::vector<char> done;
  for (const CompiledCable& cable : cables_) {
    settle_openings(substep, cable, links);
    if (!cable.has_geodesics) continue;
    const auto smooth = [&](int link) { return links[at(link)].geodesic.has_value(); };
    const auto follow = [&](int first_span) {
      row.clear();
      int k = first_span;
      for (; smooth(spans[at(k)].second); k = span_after(cable, spans[at(k)].second)) {
        const int link = spans[at(k)].second;
        if (done[at(link - cable.first_link)] != 0) break;
        done[at(link - cable.first_link)] = 1;
        row.push_back(&links[at(link)]);
      }
      if (row.empty()) return;
      const SpanSetup& in = spans[at(first_span)];
      settle_row(substep, row,
                 {in, links[at(in.first)], spans[at(k)], links[at(spans[at(k)].second)]});
    };
    done.assign(at(cable.link_count), 0);
    // Rows begin behind a link that is no geodesic; the second pass finds a belt on nothing else.
    for (const bool ring : {false, true}) {
      for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
        if (spans[at(k)].active && smooth(spans[at(k)].first) == ring) follow(k);
      }
    }
  }
}

void settle_row(const Substep& substep, std::span<LinkGeometry* const> row, const RowEnds& ends) {
  std::vector<GeodesicStop> stops;
  for (const LinkGeometry* link : row) stops.push_back(stop_at(substep, *link));
  // An end of a geodesic, where an outer span begins or ends, counts as a point of the world.
  LinkGeometry point;
  point.body = point.carrier = substep.bodies.count();
  point.still = true;
  SpanEnd from;
  SpanEnd to;
  if (!ends.first.geodesic) {
    from = [&](const Vector3& end) {
      point.center = end;
      return span_geometry(substep, ends.in, ends.first, point).start;
    };
    to = [&](const Vector3& start) {
      point.center = start;
      return span_geometry(substep, ends.out, point, ends.last).end;
    };
  }
  const bool settled = find_shortest_way(stops, from, to);
  for (std::size_t j = 0; j < row.size(); ++j) {
    LinkGeometry& link = *row[j];
    GeodesicLink& geodesic = *link.geodesic;
    geodesic.settled = settled;
    if (!settled) continue;
    const Vector3 tangent = substep.orientation(link.carrier).conjugate() * stops[j].entry.tangent;
    geodesic.entry =
        geodesic.surface.frame(to_own(substep, link.carrier, stops[j].entry.point), tangent);
    geodesic.length = stops[j].length;
    show_geodesic(link);
  }
}

void CableSystem::begin_geodesics(const Substep& substep) {
  settle_geodesics(substep, links_, spans_);
  for_each_geodesic([&](const CompiledCable&, int link, int, int) {
    geodesic_starts_[at(link)] = *links_[at(link)].geodesic;
  });
}

void CableSystem::turn_geodesics(const Substep& substep) {
  settle_geodesics(substep, links_, spans_);
  for_each_geodesic([&](const CompiledCable&, int link, int, int) {
    GeodesicLink& now = *links_[at(link)].geodesic;
    const GeodesicLink& start = geodesic_starts_[at(link)];
    now.taken_on = way_of(start.entry, now.entry);
    now.passed_on = -(now.length - start.length) - now.taken_on;
  });
}

void CableSystem::keep_geodesics(FeatureState& next) const {
  for_each_geodesic([&](const CompiledCable& cable, int link, int, int) {
    std::int64_t& wrap = next.integers[wrap_index(link)];
    wrap = std::abs(wrap);
    put_plane(cable.planes[at(link - cable.first_link)], start_of(*links_[at(link)].geodesic),
              next);
  });
}

void CableSystem::remember_geodesics() {
  geodesic_lengths_.assign(links_.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_geodesic([&](const CompiledCable&, int link, int, int) {
    geodesic_lengths_[at(link)] = links_[at(link)].geodesic->length;
  });
}

void CableSystem::shift_geodesics(const Substep& substep, const CompiledCable& cable,
                                  FeatureState& next) {
  for_each_geodesic([&](const CompiledCable& own, int link, int in, int out) {
    const double longer = links_[at(link)].geodesic->length - geodesic_lengths_[at(link)];
    if (&own != &cable || std::isnan(longer)) return;
    // The span with more cable gives it: the other span may be too short.
    const int from =
        next.reals[rest_length_index(in)] < next.reals[rest_length_index(out)] ? out : in;
    double& rest_length = next.reals[rest_length_index(from)];
    const double strain = strain_of(cable, geometry_of(substep, from).length, rest_length);
    const double taken = cable.quantised(longer / (1.0 + strain));
    rest_length -= taken;
    next.reals[stored_length_index(link)] += taken;
    fit_strain(link, from == in ? StoredStrain::End::incoming : StoredStrain::End::outgoing, strain,
               next);
  });
  keep_geodesics(next);
}

}  // namespace sheave
