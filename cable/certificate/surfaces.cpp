// Geodesics over smooth bodies, checked by properties that need no search.
//
// The cable meets and leaves the body in the surface, at its points. On a surface of revolution a
// geodesic keeps its moment about the axis, radius x cosine of its angle to the parallels
// (Clairaut), so both spans have equal moments: the rope does not turn a body without friction
// about its axis. On a ball this holds about all axes, and on a cylinder the slope along the axis
// is constant, too. There the angle between the ends gives the length, up to whole turns, and the
// angle by which the direction turns. Cones, tori and ellipsoids are in curved_body.cpp.
//
// An opening is checked like a contact. The cable passes the inside or the surface. The
// cable turns at the surface only, in the plane of the normal, and presses on the body from
// outside.

#include <algorithm>
#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/certificate/curved_body.h"
#include "cable/links/opening.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

/// A geodesic and its two spans at the end of a substep.
struct Way {
  const LinkReport& link;
  const SurfaceReport& surface;
  Vector3 in;  ///< unit vectors along the spans
  Vector3 out;
};

Outward outward_at(const SurfaceReport& surface, const Vector3& point) {
  double height = surface.axis.dot(point - surface.center);
  if (surface.round_ends) height = std::clamp(height, -surface.half_length, surface.half_length);
  const Vector3 arm = point - surface.center - height * surface.axis;
  const double distance = arm.norm();
  return {arm / distance, std::abs(distance - surface.radius)};
}

double off_surface(const Way& way) {
  const Outward entry = outward_at(way.surface, way.link.entry);
  const Outward exit = outward_at(way.surface, way.link.exit);
  const double radius = way.surface.radius;
  return std::max({entry.off, exit.off, radius * std::abs(entry.normal.dot(way.in)),
                   radius * std::abs(exit.normal.dot(way.out))});
}

double off_moment(const Way& way) {
  const SurfaceReport& surface = way.surface;
  const Vector3 change = (way.link.exit - surface.center).cross(way.out) -
                         (way.link.entry - surface.center).cross(way.in);
  if (surface.round_ends && surface.half_length == 0.0) return change.norm();
  const double rise = surface.round_ends ? 0.0 : surface.axis.dot(way.out - way.in);
  return std::max(std::abs(surface.axis.dot(change)), surface.radius * std::abs(rise));
}

/// Error of the length on a ball or a cylinder [m].
double off_length(const Way& way) {
  const SurfaceReport& surface = way.surface;
  const Vector3 first = outward_at(surface, way.link.entry).normal;
  const Vector3 last = outward_at(surface, way.link.exit).normal;
  const bool ball = surface.round_ends;
  const Vector3 about = ball ? Vector3(first.cross(way.in)) : surface.axis;
  const double level = about.dot(first.cross(way.in));  // cosine to the parallels, with the sense
  const double angle = portable::atan2(about.dot(first.cross(last)), first.dot(last));
  const double whole = 2.0 * pi * surface.radius / std::abs(level);
  const double lies = way.link.stored_length + way.link.stored_stretch;
  const double off = std::remainder(lies - surface.radius * angle / level, whole);
  const double turned = lies * level * level / surface.radius;
  return std::max(std::abs(off), surface.radius * std::abs(turned - way.link.wrap_angle));
}

double off_opening(const Way& way) {
  const SurfaceReport& surface = way.surface;
  const Vector3 arm = way.link.entry - surface.center;
  const Vector3 across =
      surface.round_ends ? arm : Vector3(arm - surface.axis.dot(arm) * surface.axis);
  const double gap = surface.radius - across.norm();
  const Vector3 turn = way.out - way.in;
  const Vector3 normal = across.norm() > 0.0 ? Vector3(across.normalized()) : turn.normalized();
  const double pressed = normal.dot(turn);
  const double aside = surface.radius * (turn - pressed * normal).norm();
  const double complementary =
      pressed > 0.0 ? std::min(surface.radius * pressed, gap) : -surface.radius * pressed;
  return std::max({-gap, aside, complementary, (way.link.exit - way.link.entry).norm()});
}

double off_way(const Way& way) {
  if (way.link.type == OpeningLink::type_name) return off_opening(way);
  const double off = std::max(off_surface(way), off_moment(way));
  const bool closed_form = !way.surface.round_ends || way.surface.half_length == 0.0;
  return closed_form ? std::max(off, off_length(way)) : off;
}

}  // namespace

void check_surfaces(const Evidence& evidence, const CableEvidence& cable, Findings& findings) {
  if (cable.end.cut) return;
  const CableReport end = cable.end.with_wraps_in_place();
  const std::size_t spans = end.spans.size();
  const double size = std::min(cable.end.total_length, evidence.bodies.scale());
  const double rounding = 1e-11 * (evidence.bodies.scale() + cable.end.total_length);
  for (std::size_t i = 0; i < end.links.size(); ++i) {
    const LinkReport& link = end.links[i];
    const std::optional<CurvedBody> curved = curved_body(evidence, link);
    if ((!link.surface && !curved) || !link.touched || (i == 0 && !cable.end.closed) || i >= spans)
      continue;
    // Spans behind links that the cable has left have no length.
    std::size_t before = i > 0 ? i - 1 : spans - 1;
    while (before != i && !end.links[before].touched) before = before > 0 ? before - 1 : spans - 1;
    const SpanReport& in = end.spans[before];
    const SpanReport& out = end.spans[i];
    if (!in.has_tangent || !out.has_tangent || !(in.length > 0.0) || !(out.length > 0.0)) continue;
    const Vector3 before_it = (in.end - in.start) / in.length;
    const Vector3 behind_it = (out.end - out.start) / out.length;
    const double off = curved ? off_curved_body(*curved, link, before_it, behind_it)
                              : off_way({link, *link.surface, before_it, behind_it});
    findings.note(CertificateItem::Kind::span, "m", off, size, rounding, [&] {
      return "\"" + std::string(cable.name) + "\" on " +
             evidence.body_name(link.body.is_world() ? evidence.bodies.count() : link.body.index);
    });
  }
}

}  // namespace sheave::certify
