#include "cable/certificate/pushes.h"

#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/certificate/coupled_joints.h"
#include "cable/certificate/joint_frames.h"
#include "cable/certificate/losses.h"
#include "cable/links/opening.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/links/surface.h"
#include "engine/math/portable.h"

namespace sheave::certify {

SpanPushes pushes_of(const SpanEvidence& span, End when) {
  const Vector3 pull = span.force[at(when)] * span.direction[at(when)];
  return {SpanPush{span.from.body, span.from.point[at(when)], pull},
          SpanPush{span.to.body, span.to.point[at(when)], -pull},
          SpanPush{span.from.body, span.loaded_from[at(when)], span.load_from[at(when)]},
          SpanPush{span.to.body, span.loaded_to[at(when)], span.load_to[at(when)]}};
}

JointPushes pushes_of(const Evidence& evidence, const JointEvidence& joint, End when) {
  JointPushes result;
  const JointReport& report = joint.acting[at(when)];
  if (is_zero(report.force) && is_zero(report.torque)) return result;
  const Moment& now = evidence.moments[at(when)];
  const JointFrame frame = frame_of(evidence.bodies, joint);
  if (frame.kind.of_joints) return coupled_pushes(evidence, joint, when);
  const Vector3 at_b = frame.anchor_b(now);
  if (!frame.kind.coupling) {
    result.push_back({frame.body_b, at_b, report.force, report.torque});
    // Locks of points act at their own anchors; sliding locks act at B's anchor on both bodies.
    const bool own_point = frame.kind.meets;
    const Vector3 at_a = own_point ? frame.anchor_a(now) : at_b;
    result.push_back({frame.body_a, at_a, -report.force, -report.torque});
    return result;
  }
  // The factor of the coupling follows from its effort on body_b, and virtual work gives the rest:
  // with C = c_b - ratio c_a, body_a gets -ratio times the factor about its axis, and the carrier
  // gets the opposite of both.
  const Quaternion carried = frame.turned_by(now, frame.carrier);
  const Vector3 axis_a = carried * frame.axis_a;
  const Vector3 axis_b = carried * frame.axis_b;
  const bool gear = joint.definition->type() == "gear";
  const double factor = gear ? report.torque.dot(axis_b) : report.force.dot(axis_b);
  const Vector3 torque_a = -frame.ratio * factor * axis_a;
  const bool has_tilted =
      gear && (report.torque - factor * axis_b).norm() > 1e-9 * std::abs(factor);
  if (gear) {
    result.push_back({frame.body_b, now.center(frame.body_b), Vector3::Zero(), report.torque});
    result.push_back({frame.carrier, now.center(frame.carrier), Vector3::Zero(),
                      -report.torque - torque_a, has_tilted});
  } else {
    result.push_back({frame.body_b, at_b, report.force, report.torque});
    result.push_back({frame.carrier, at_b, -report.force, -report.torque - torque_a});
  }
  result.push_back({frame.body_a, now.center(frame.body_a), Vector3::Zero(), torque_a, has_tilted});
  return result;
}

namespace {

/// Wrap angle of the cable between its spans at a link [rad].
double angle_at(const Evidence& evidence, const SpanEvidence& in, const SpanEvidence& out,
                const LinkReport& link, End when) {
  const Vector3& u = in.direction[at(when)];
  const Vector3& v = out.direction[at(when)];
  // check_surfaces() compares the angle on a smooth body with the length on it
  // (cable/certificate/surfaces.cpp).
  if (link.surface || lies_on_curved_body(evidence, link)) return link.wrap_angle;
  if (link.winding == 0) return portable::atan2(u.cross(v).norm(), u.dot(v));
  Vector3 from = u;
  Vector3 to = v;
  if (link.radius > 0.0) {
    from = in.to.point[at(when)] - link.center;
    to = out.from.point[at(when)] - link.center;
  }
  const Vector3 normal = link.winding * link.normal;
  const double angle =
      portable::atan2(normal.dot(from.cross(to)), from.dot(to) - normal.dot(from) * normal.dot(to));
  // The reported wrap angle gives the number of whole turns.
  return std::max(0.0, angle + 2.0 * pi * std::round((link.wrap_angle - angle) / (2.0 * pi)));
}

/// Losses of a listed wheel; none for all other links.
LossEvidence listed_losses(const CableEvidence& cable, int link) {
  if (link < 0) return {};
  const auto* rolling = dynamic_cast<const RollingLink*>(cable.definition->links[at(link)].get());
  return rolling != nullptr ? losses_of(*rolling) : LossEvidence();
}

/// T1 / T2 of a wheel without inertia at a steady speed, by bisection: the torques of the tensions,
/// of the bent rope and of the pin, T2 - T1 = rope (T1 + T2) + pin |T1 u1 + T2 u2|, where u1 and u2
/// enclose pi - angle.
double steady_ratio(double rope, double pin, double angle) {
  const auto missing = [&](double ratio) {
    const double across = portable::sin(0.5 * angle);
    const double load = std::sqrt((1.0 - ratio) * (1.0 - ratio) + 4.0 * ratio * across * across);
    return 1.0 - ratio - rope * (1.0 + ratio) - pin * load;
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (missing(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

void describe_pass(const Evidence& evidence, const CableEvidence& cable, const LinkReport& first,
                   const LinkReport& second, PassEvidence& pass) {
  const int body = evidence.bodies.index(first.body);
  const bool wheel = first.winding != 0;
  pass.massless = wheel && body < evidence.bodies.count() && evidence.bodies[body].massless();
  pass.passes = pass.massless;
  if (pass.link < 0) {
    pass.passes = true;
    pass.friction = cable.definition->wrap_friction;
  } else {
    const LinkDef& link = *cable.definition->links[at(pass.link)];
    if (const auto* hole = dynamic_cast<const PinholeLink*>(&link)) {
      pass.passes = true;
      pass.friction = hole->friction;
      pass.blocked = blocked_way(hole->passes);
    }
    if (link.type() == OpeningLink::type_name) pass.passes = true;
    if (const auto* surface = dynamic_cast<const SurfaceLink*>(&link)) {
      pass.passes = true;
      pass.friction = surface->friction;
    }
    const auto* rolling = dynamic_cast<const RollingLink*>(&link);
    if (rolling != nullptr && rolling->friction) {
      pass.passes = true;
      pass.friction = *rolling->friction;
      pass.blocked = blocked_way(rolling->passes);
    }
  }
  const LinkControl* set =
      pass.link < 0 ? nullptr : evidence.start.controls.links.find(cable.first_link + pass.link);
  if (set != nullptr && !std::isnan(set->friction)) pass.friction = set->friction;
  if (pass.massless) pass.friction = 0.0;
  const LossEvidence losses = pass.massless ? listed_losses(cable, pass.link) : LossEvidence();
  const SpanEvidence& in = cable.spans[at(pass.before)];
  const SpanEvidence& out = cable.spans[at(pass.after)];
  if (losses.any()) {
    // The exponent of the capstan with the same ratio, at both ends of the substep.
    pass.friction = 1.0;
    for (const End when : {first_end, last_end}) {
      const LinkReport& link = when == first_end ? first : second;
      const double angle = losses.pin > 0.0 ? angle_at(evidence, in, out, link, when) : pi;
      pass.wrap_angle[at(when)] =
          -std::log(steady_ratio(losses.rope, losses.pin / link.radius, angle));
    }
    return;
  }
  pass.wrap_angle = {angle_at(evidence, in, out, first, first_end),
                     angle_at(evidence, in, out, second, last_end)};
}

}  // namespace sheave::certify
