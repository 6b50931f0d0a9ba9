// Ends of a cable that change: hybrid links and drums, whose cable may be used up, and attachments
// that feed cable.
//
// A hybrid end is wound as defined, wound the other way, or attached. A wound end becomes attached
// when its stored length s falls below 0. The cable then ends at the point of the rim that lies |s|
// before the tangent point in the direction of the free cable, and the negative s goes into the
// span's rest length, so no cable is lost. An attached end is wound again when the free cable would
// run through the wheel, that is, when the angle between the cable's direction away from the wheel
// and the radius to the attachment exceeds a right angle. The arc between attachment and tangent
// point is then stored.
//
// For a small arc r a the two descriptions of a path differ in length by r a^3 / 6. A row whose
// value jumped by that under a tension T would create the energy T r a^3 / 6: up to 6e-5 J per
// event in paper/hybrid at 240 Hz, which the damping of xpbd hides and `rattle` does not. Lengths
// are therefore kept and arcs adapted: the stored length is the length by which the free cable
// becomes shorter, and the attachment lies where the free cable is |s| shorter than from the
// tangent point. The attachment moves along the rim by r a^3 / 6, in opposite directions at the two
// ends of its winding.
//
// The law holds for small angles. At the end of a cable, the last of it runs off and the rim turns
// with the attachment within one substep, as far as force and speed take it, and rows are linear.
// For a rotation of a large part of a radian the lever arm at the end of the substep is not the one
// during it, an attachment that has gone round would count as one that has gone back, and lengths
// would have to be negative. A load and a light drum always jerk each other at the end of a cable,
// so large rotations are the rule there; they created energy without a bound. A substep with such a
// rotation has failed, and the engine repeats it in parts with smaller rotations
// (engine/substep_driver.h).

#include <algorithm>
#include <cmath>

#include "cable/cable_system.h"
#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {
namespace {

constexpr int wound = 0;       ///< as defined
constexpr int wound_back = 1;  ///< the other way round
constexpr int attached = 2;

/// Largest rotation of a rim in a substep while the cable's end is at a point of it [rad]: its
/// path, h times its speeds at both ends, and its rotation beyond the end of the wound cable. The
/// trapezoidal rule computes the work of a force whose arm turns by an angle a with a relative
/// error of a^2 / 12. The half impulses p of a force before and after the rotation leave kinetic
/// energies p^2 J W J^T / 2 that differ by a^2 of their value. Implicit Euler dissipates a fraction
/// a^2 / 2, and creates no energy as long as it is on the right side of the rotation.
constexpr double most_turn = 0.1;
constexpr double most_turn_of_euler = 0.3;

struct PlaneAxes {
  Vector3 x;
  Vector3 y;
};

/// Axes in the link's plane; the angle of an attachment is counted from x.
PlaneAxes axes_of(const LinkGeometry& link) {
  const Vector3 y = any_perpendicular(link.rim_normal);
  return {y.cross(link.rim_normal), y};
}

/// Turns `link` into the point of the rim at `angle`.
void attach_at(LinkGeometry& link, double radius, double angle) {
  const PlaneAxes axes = axes_of(link);
  link.side = 0;
  link.signed_radius = 0.0;
  link.still = link.still && link.carrier == link.body;
  link.carrier = link.body;
  link.normal = link.rim_normal;
  link.center =
      link.end_center() + radius * (portable::cos(angle) * axes.x + portable::sin(angle) * axes.y);
  link.centered = link.center.isZero(0.0);
}

double radius_with(const LinkGeometry& definition, double stored_length) {
  const double bare = std::abs(definition.signed_radius);
  if (!(definition.layer_pitch > 0.0)) return bare;
  return std::sqrt(bare * bare + definition.layer_pitch * std::max(stored_length, 0.0) / pi);
}

}  // namespace

void CableSystem::refresh(const BodySet& bodies, const FeatureState& own,
                          std::vector<LinkGeometry>& links, std::vector<SpanSetup>& spans) const {
  place_wraps(bodies, own, links);
  connect_spans(own, links, spans);
  refresh_ends(own, links, spans);
}

void CableSystem::refresh_ends(const FeatureState& own, std::vector<LinkGeometry>& links,
                               std::vector<SpanSetup>& spans) const {
  for (const int i : changing_links_) {
    const LinkGeometry& definition = definitions_[at(i)];
    LinkGeometry& link = links[at(i)];
    const double radius = radius_with(definition, stored_arc(own, i));
    const auto mode = static_cast<int>(own.integers[mode_index(i)]);
    if (mode == attached) {
      attach_at(link, radius, own.reals[angle_index(i)]);
      continue;
    }
    link.carrier = definition.carrier;
    link.still = definition.still;
    link.center = definition.center;
    link.normal = definition.normal;
    link.side = mode == wound_back ? -definition.side : definition.side;
    link.signed_radius = link.side * radius;
    link.centered = link.center.isZero(0.0);
    if (link.groove) link.wind_groove(link.groove->angle(stored_arc(own, i)));
  }
  for (SpanSetup& setup : spans) {
    setup.first_radius = setup.first_sense * links[at(setup.first)].signed_radius;
    setup.second_radius = setup.second_sense * links[at(setup.second)].signed_radius;
  }
}

void CableSystem::change_ends(const Substep& substep, FeatureState& next) {
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const CompiledCable& cable = cables_[c];
    if (cable.closed || next.integers[cut_index(static_cast<int>(c))] != 0) continue;
    const int last_link = cable.last_listed_link();
    if (definitions_[at(cable.first_link)].hybrid) {
      change_end(substep, cable, cable.first_link, cable.first_span, true, next);
    }
    if (definitions_[at(last_link)].hybrid) {
      // The cable may have left links before this one, so the span is not always the last.
      change_end(substep, cable, last_link, span_before(cable, last_link, spans_), false, next);
    }
  }
}

bool CableSystem::turns_too_far(const Substep& substep) const {
  for (const CompiledCable& cable : cables_) {
    if (cable.closed) continue;
    for (const bool first : {true, false}) {
      const int index = first ? cable.first_link : cable.last_listed_link();
      if (!definitions_[at(index)].hybrid) continue;
      const int span = first ? cable.first_span : span_before(cable, index, spans_);
      if (span >= 0 && spans_[at(span)].active && end_turns_too_far(substep, index, span, first)) {
        return true;
      }
    }
  }
  return false;
}

bool CableSystem::end_turns_too_far(const Substep& substep, int index, int span, bool first) const {
  const LinkGeometry& link = links_[at(index)];
  if (link.body == substep.bodies.count() || is_affine_[at(span)] != 0) return false;
  const double limit = substep.load_share == 1.0 ? most_turn_of_euler : most_turn;
  const Vector3 normal = substep.orientation(link.body) * link.rim_normal;
  const double turn = std::abs(dot(normal, substep.moving[at(link.body)].turn));
  if (!link.wraps()) {
    double most = turn;
    for (const State* state : {&substep.start, static_cast<const State*>(&substep.next)}) {
      const Vector3& speed = state->bodies[at(link.body)].angular_velocity;
      most = std::max(most, substep.h * std::abs(dot(normal, speed)));
    }
    return most > limit;
  }
  const double stored = stored_arcs_[at(index)];
  const double radius = std::abs(link.signed_radius);
  if (stored > radius * (turn + 2.0 * pi)) return false;
  const SpanSetup& setup = spans_[at(span)];
  const SpanTransport transport =
      layered(span)
          ? layered_span(substep, span).transport
          : span_transport(substep, setup, links_[at(setup.first)], links_[at(setup.second)],
                           references_[at(span)], geometry_of(substep, span));
  return (first ? transport.from_first : transport.from_second) - stored > limit * radius;
}

SpanGeometry CableSystem::attached_span(const Substep& substep, int index, int span,
                                        double angle) const {
  SpanSetup setup = spans_[at(span)];
  const bool first = setup.first == index;
  LinkGeometry point = definitions_[at(index)];
  attach_at(point, radius_with(point, 0.0), angle);
  (first ? setup.first_radius : setup.second_radius) = 0.0;
  return span_geometry(substep, setup, first ? point : links_[at(setup.first)],
                       first ? links_[at(setup.second)] : point);
}

void CableSystem::change_end(const Substep& substep, const CompiledCable& cable, int index,
                             int span, bool first, FeatureState& next) {
  const LinkGeometry& definition = definitions_[at(index)];
  double& stored = next.reals[stored_length_index(index)];
  if (next.integers[mode_index(index)] != attached && stored >= 0.0) return;
  double& rest_length = next.reals[rest_length_index(span)];
  std::int64_t& mode = next.integers[mode_index(index)];
  const StoredStrain::End end = first ? StoredStrain::End::outgoing : StoredStrain::End::incoming;
  const PlaneAxes axes = axes_of(definition);
  const Quaternion orientation = substep.orientation(definition.body);
  const Vector3 center = substep.point(definition.body, definition.end_center());
  const double radius = radius_with(definition, stored_arc(next, index));
  const SpanGeometry geometry = geometry_of(substep, span);
  const double strain = strain_of(cable, geometry.length, rest_length);
  if (mode != attached) {
    // The direction from the tangent point along the free cable: along the cable at its first link,
    // against it at its last.
    const double sense = first ? links_[at(index)].side : -links_[at(index)].side;
    const double missing = stored * (1.0 + strain);  // < 0
    const double wanted = geometry.length + missing;
    const Vector3 leaves = first ? geometry.start : geometry.end;
    const Vector3 own = orientation.conjugate() * (leaves - center);
    double angle = portable::atan2(axes.y.dot(own), axes.x.dot(own)) - sense * missing / radius;
    // The free cable becomes shorter by r per radian, except for a relative error a^2 / 2, so each
    // round reduces the error.
    constexpr int rounds = 6;
    for (int round = 0; round < rounds && -missing < radius; ++round) {
      angle += sense * (attached_span(substep, index, span, angle).length - wanted) / radius;
    }
    next.reals[angle_index(index)] = angle;
    mode = attached;
    rest_length += stored;
    stored = 0.0;
    fit_strain(index, end, strain, next);
    record(substep, cable, index, CableEvent::Kind::attach);
    return;
  }
  const Vector3 away = first ? geometry.direction : Vector3(-geometry.direction);
  const Vector3 outward = (first ? geometry.start : geometry.end) - center;
  if (!(dot(away, outward) < 0.0)) return;
  // direction of the shorter way out of the wheel
  const Vector3 turning = cross(orientation * definition.rim_normal, outward);
  const int around = dot(away, turning) >= 0.0 ? 1 : -1;
  LinkGeometry wheel = definition;
  wheel.side = first ? around : -around;
  wheel.signed_radius = wheel.side * radius;
  if (wheel.groove) wheel.wind_groove(0.0);
  SpanSetup setup = spans_[at(span)];
  (first ? setup.first_radius : setup.second_radius) =
      (first ? setup.first_sense : setup.second_sense) * wheel.signed_radius;
  const SpanGeometry tangent =
      span_geometry(substep, setup, first ? wheel : links_[at(setup.first)],
                    first ? links_[at(setup.second)] : wheel);
  if (!tangent.has_tangent) return;
  const double shorter = std::max(geometry.length - tangent.length, 0.0);
  const double taken = std::min(cable.quantised(shorter / (1.0 + strain)), rest_length);
  mode = wheel.side == definition.side ? wound : wound_back;
  stored += taken;
  rest_length -= taken;
  fit_strain(index, end, strain, next);
  record(substep, cable, index, CableEvent::Kind::wind);
}

void CableSystem::feed(const FeatureState& state, double h, int span) {
  const SpanSetup& setup = spans_[at(span)];
  auto& [first, second] = fed_[at(span)];
  first = links_[at(setup.first)].feed_speed * h;
  second = links_[at(setup.second)].feed_speed * h;
  // No more cable can be taken out than there is.
  const double rest_length = std::max(state.reals[rest_length_index(span)], 0.0);
  const std::array wanted{first, second};
  first = std::max(first, -rest_length);
  second = std::max(second, -rest_length - first);
  drive_work_.feed_rates[at(span)] = 0.0;
  for (const std::size_t end : {0U, 1U}) {
    const int link = end == 0 ? setup.first : setup.second;
    if (fed_[at(span)][end] > wanted[end]) {
      drive_work_.stalled[at(link)] = 1;
    } else {
      drive_work_.feed_rates[at(span)] += links_[at(link)].feed_end_speed;
    }
  }
}

}  // namespace sheave
