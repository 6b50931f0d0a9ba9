// Wraps on balls without friction.
//
// Nothing holds a rope sideways on a smooth ball: it lies along the shortest way between the ends
// of its two spans, p1 and p2, which is in the plane of both and the centre c. So the wrap's plane
// is no longer fixed to the body but is found for the positions at hand: n = +-(p1 - c) x (p2 - c),
// with the sign of the winding. Where a span ends on a wheel or another ball its end depends on
// this plane, too; they are found in turn, which makes all of it shorter in each round.
//
// The way, l1 + R a + l2 with the angle a of the wrap, is stationary in what the plane could do, so
// C's gradient remains the direction of either span, at its tangent point: together they press on
// the centre and do not turn the ball. What lies on the ball follows from a alone. The incoming
// span gains what its tangent point tells (cable/span_row.h), and the outgoing one all that is
// left,
//   passed_on = -R (a - a0) - gain of the incoming one;
// the two are one run (cable/cable_runs.cpp), so how they divide it is nothing to the motion. The
// plane at the end of the substep is part of the state.

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "cable/link_contact.h"
#include "engine/index.h"

namespace sheave {

bool CableSystem::has_geodesics() const {
  return std::any_of(links_.begin(), links_.end(),
                     [](const LinkGeometry& link) { return link.geodesic; });
}

/// Visits (link, incoming span, outgoing span) of each.
template <class Visit>
void CableSystem::for_each_geodesic(Visit visit) const {
  for (const CompiledCable& cable : cables_) {
    if (cable.candidates.empty()) continue;
    for (int k = cable.first_span; k < cable.first_span + cable.span_count; ++k) {
      const int link = spans_[at(k)].second;
      if (spans_[at(k)].active && links_[at(link)].geodesic)
        visit(link, k, span_after(cable, link));
    }
  }
}

void CableSystem::begin_geodesics(const Substep& substep) {
  for_each_geodesic([&](int link, int in, int out) {
    geodesic_starts_[at(link)] =
        signed_wrap_angle(substep, links_[at(link)], geometry_of(substep, in),
                          geometry_of(substep, out), stored_arcs_[at(link)]);
    links_[at(link)].passed_on = 0.0;
  });
}

void CableSystem::turn_geodesics(const Substep& substep) {
  constexpr int most_rounds = 50;
  constexpr double settled = 1e-14;  // of a unit vector
  const auto now = [&](int k) {
    const SpanSetup& setup = spans_[at(k)];
    return span_geometry(substep, setup, links_[at(setup.first)], links_[at(setup.second)]);
  };
  double turned = 1.0;
  for (int round = 0; round < most_rounds && turned > settled; ++round) {
    turned = 0.0;
    for_each_geodesic([&](int index, int in, int out) {
      LinkGeometry& link = links_[at(index)];
      const Vector3 center = center_of(substep, link, 0);
      const Vector3 from = now(in).start - center;
      const Vector3 to = now(out).end - center;
      const Quaternion orientation = substep.orientation(link.carrier);
      const Vector3 before = orientation * link.normal;
      Vector3 normal = cross(from, to);
      const double size = normal.norm();
      // Ends on one line with the centre lie in every plane through it.
      if (!(size > 1e-9 * from.norm() * to.norm())) return;
      normal *= (dot(normal, before) < 0.0 ? -1.0 : 1.0) / size;
      turned += (normal - before).squaredNorm();
      link.normal = orientation.conjugate() * normal;
    });
    turned = std::sqrt(turned);
  }
  for_each_geodesic([&](int index, int in, int out) {
    LinkGeometry& link = links_[at(index)];
    const double radius = std::abs(link.signed_radius);
    const SpanGeometry incoming = now(in);
    const double start = geodesic_starts_[at(index)];
    const double angle = signed_wrap_angle(substep, link, incoming, now(out), radius * start);
    const SpanSetup& setup = spans_[at(in)];
    const double gained =
        span_transport(substep, setup, links_[at(setup.first)], link, references_[at(in)], incoming)
            .from_second;
    link.passed_on = -radius * (angle - start) - gained;
  });
}

void CableSystem::keep_geodesics(const Substep& substep, FeatureState& next) {
  bool any = false;
  for_each_geodesic([&](int link, int in, int) {
    const CompiledCable& cable = cables_[at(spans_[at(in)].cable)];
    const std::size_t start =
        plane_index(cable.first_plane + link - cable.first_link - cable.listed_links);
    for (int i = 0; i < 3; ++i) next.reals[start + at(3 + i)] = links_[at(link)].normal[i];
    any = true;
  });
  if (any) follow_course(substep.bodies, next);
}

}  // namespace sheave
