// Bounds of friction: e^(m a) at links, Coulomb's cone at contacts. A slipping link or contact is
// at its bound and dissipates: cable slides towards the larger tension, and the friction of
// contacts is opposed to their sliding.

#include <algorithm>
#include <cmath>

#include "cable/certificate/checks.h"
#include "cable/certificate/rope_law.h"
#include "engine/math/portable.h"

namespace sheave::certify {
namespace {

using Kind = CertificateItem::Kind;

/// Force of the spring of a span without damping, at one end of the substep [N].
double pull_at(const CableDef& cable, const SpanEvidence& span, End when) {
  const double rest = span.rest_length[at(when)];
  if (!cable.tension_table.empty()) {
    return rest > 0.0 ? RopeLaw(cable).tension(span.length[at(when)] / rest - 1.0) : 0.0;
  }
  const double compliance = cable.axial_stiffness ? std::max(rest, 0.0) / *cable.axial_stiffness
                                                  : cable.compliance.value_or(0.0);
  return compliance > 0.0 ? std::max(span.length[at(when)] - rest, 0.0) / compliance : 0.0;
}

/// Difference between the tension that the bound requires on the side to which cable slides and the
/// actual tension [N]. With `rattle` the force of a spring is the mean of those at both ends. If
/// these lie on different sides of the bound, as when a cable becomes slack, the slip obeyed one of
/// them, so the smallest difference counts.
double missing_pull(const Evidence& evidence, const CableEvidence& cable, const PassEvidence& pass,
                    const SpanEvidence& held, const SpanEvidence& pulling) {
  const double missing = carried(pass, held) - pulling.tension();
  const CableDef& definition = *cable.definition;
  if (!evidence.rattle || !definition.is_elastic() || definition.is_damped()) return missing;
  double least = missing;
  for (const End when : {first_end, last_end}) {
    const double bound = portable::exp(pass.friction * pass.wrap_angle[at(when)]);
    least = std::min(least,
                     bound * pull_at(definition, held, when) - pull_at(definition, pulling, when));
  }
  return least;
}

/// A rope with weight that passes a link freely: the tension behind the link follows from that before
/// it.
void check_weight(const Evidence& evidence, const CableEvidence& cable, const PassEvidence& pass,
                  Findings& findings) {
  const SpanEvidence& span = cable.spans[at(pass.after)];
  // The rope on a wheel has the strain of the start of the substep.
  const double weight = cable.definition->linear_density * evidence.gravity.norm();
  const double on_wheel = weight * span.from.lies[last_end];
  const double rounding = 1e-9 * span.told + evidence.force_rounding + 1e-5 * on_wheel;
  findings.note(
      Kind::friction, "N", std::abs(span.told - span.tension()), span.told, rounding, [&] {
        return "link " + std::to_string(pass.link) + " of \"" + std::string(pass.cable) + "\"";
      });
}

void check_pass(const Evidence& evidence, const CableEvidence& cable, const PassEvidence& pass,
                double largest, Findings& findings) {
  if (cable.spans[at(pass.after)].shares) return check_weight(evidence, cable, pass, findings);
  const double before = cable.spans[at(pass.before)].tension();
  const double after = cable.spans[at(pass.after)].tension();
  const double bound = portable::exp(
      pass.friction * std::max(pass.wrap_angle[first_end], pass.wrap_angle[last_end]));
  // No cable can slide out of a span of constant compliance without rest length.
  const SpanEvidence& giving = cable.spans[at(before < after ? pass.before : pass.after)];
  const bool drained = cable.definition->compliance.value_or(0.0) > 0.0 &&
                       giving.rest_length[first_end] <= 1e-13 * evidence.bodies.scale();
  if (drained) return;
  const double high = std::max(before, after);
  const double low = std::min(before, after);
  // The ratio of tensions has no meaning if they are negligible against the cable's largest tension
  // or against rounding.
  const double scale = std::max({high, 1e-3 * largest, evidence.force_rounding});
  // Only rigid spans share a load that they do not determine.
  const bool rigid = !cable.definition->is_elastic();
  const double rounding = std::max(
      {1e-9 * scale, bound * evidence.force_rounding, rigid ? evidence.shared_rounding : 0.0});
  const auto name = [&] {
    return (pass.link < 0 ? std::string("a wrap") : "link " + std::to_string(pass.link)) +
           " of \"" + std::string(pass.cable) + "\"";
  };
  // A ratchet holds any tension against the way that it blocks, and lets no cable through there.
  const bool locked = pass.blocked != 0 && (after > before) == (pass.blocked > 0);
  if (!locked) {
    findings.note(Kind::friction, "N", std::max(high - bound * low, 0.0), scale, rounding, name);
  }
  if (pass.blocked != 0) {
    findings.note(Kind::length, "m", pass.slip * pass.blocked, cable.free_length,
                  1e-12 * evidence.bodies.scale(), name);
  }
  if (pass.travel == 0.0 || pass.friction == 0.0 || !(scale > 0.0)) return;
  // If cable comes onto or off an arc at both ends, its slip has no single direction.
  if (std::abs(pass.travel) <= 0.5 * std::abs(pass.gained)) return;
  // A slipping link is at its bound: the tension on the side of the slip is larger by the full
  // factor.
  const SpanEvidence& pulling = cable.spans[at(pass.travel > 0.0 ? pass.after : pass.before)];
  const SpanEvidence& held = cable.spans[at(pass.travel > 0.0 ? pass.before : pass.after)];
  const double asked = carried(pass, held);
  const double missing = missing_pull(evidence, cable, pass, held, pulling);
  const double creep = 1e-7 * std::min(cable.free_length, evidence.bodies.scale());
  const double weight = std::abs(pass.travel) / (std::abs(pass.travel) + creep);
  findings.note(Kind::friction, "N", weight * std::max(missing, 0.0), std::max(scale, asked),
                rounding, name);
}

/// The torque of a bearing is within its bound. While the wheel turns it is at the bound, against
/// the rotation: in the first half of a substep by the rotation over the substep, in the second
/// half of `rattle` by the rate at the end.
void check_bearing(const Evidence& evidence, const BearingEvidence& bearing, Findings& findings) {
  const auto name = [&] {
    return "the bearing of " + evidence.body_name(bearing.rotor) + " under \"" +
           std::string(bearing.cable) + "\"";
  };
  const double size = std::max(evidence.size_of(bearing.rotor), bearing.size);
  for (const End when : {first_end, last_end}) {
    const double bound = bearing.bound[at(when)];
    const double torque = bearing.torque[at(when)];
    const double scale = std::max(bound, 1e-3 * bearing.size * evidence.largest_force);
    // Rounds end when bounds have converged to this accuracy.
    const double rounding = 1e-7 * scale + size * evidence.force_rounding;
    findings.note(Kind::friction, "N m", std::max(std::abs(torque) - bound, 0.0), scale, rounding,
                  name);
    const bool by_rate = evidence.rattle && when == last_end;
    const double way = by_rate ? evidence.h * bearing.rate : bearing.turn;
    const double missing = way > 0.0 ? bound + torque : bound - torque;
    const double weight = std::abs(way) / (std::abs(way) + 1e-7);
    findings.note(Kind::friction, "N m", weight * std::max(missing, 0.0), scale, rounding, name);
  }
}

void check_contact(const Evidence& evidence, const ContactEvidence& contact, Findings& findings) {
  if (contact.ground || contact.collider_a == nullptr || contact.collider_b == nullptr) return;
  const ColliderDef& a = *contact.collider_a;
  const ColliderDef& b = *contact.collider_b;
  const double sliding = std::sqrt(a.friction * b.friction);
  const double sticking =
      std::sqrt(a.static_friction.value_or(a.friction) * b.static_friction.value_or(b.friction));
  const double press = contact.press[0] + contact.press[1];
  const Vector3 drag = contact.drag[0] + contact.drag[1];
  const double bound = std::max(sliding, sticking) * press;
  const double scale = std::max(bound, 1e-3 * evidence.largest_force);
  const auto name = [&] {
    return "the contact of " + evidence.body_name(contact.body_a) + " and " +
           evidence.body_name(contact.body_b);
  };
  findings.note(Kind::friction, "N", std::max(drag.norm() - bound, 0.0), scale, 1e-7 * scale, name);
  if (contact.sticks) return;
  // Friction of a sliding contact is opposed to the sliding, by its path. If other contacts bounce,
  // velocities are not those of the paths, so either of the two may count.
  const Moment& now = evidence.moments[last_end];
  const Vector3& at_a = contact.point_a[last_end];
  const Vector3& at_b = contact.point_b[last_end];
  const double crawl =
      evidence.h * evidence.gravity.norm() + 1e-6 * evidence.bodies.scale() / evidence.h;
  const auto forwards_by = [&](const Vector3& velocity) {
    const Vector3 along = velocity - contact.normal * contact.normal.dot(velocity);
    const double speed = along.norm();
    return speed > 0.0 ? std::max(drag.dot(along), 0.0) / (speed + crawl) : 0.0;
  };
  const double forwards =
      std::min(forwards_by(now.velocity(contact.body_a, at_a) - now.velocity(contact.body_b, at_b)),
               forwards_by(contact.slip / evidence.h));
  findings.note(Kind::friction, "N", forwards, scale, 1e-7 * scale, name);
}

}  // namespace

double carried(const PassEvidence& pass, const SpanEvidence& held) {
  double most = 0.0;
  for (const End when : {first_end, last_end}) {
    most += portable::exp(pass.friction * pass.wrap_angle[at(when)]) * held.force[at(when)];
  }
  return most;
}

void check_friction(const Evidence& evidence, Findings& findings) {
  for (const CableEvidence& cable : evidence.cables) {
    if (cable.has_changed || cable.start.cut) continue;
    double largest = 0.0;
    for (const SpanEvidence& span : cable.spans) largest = std::max(largest, span.tension());
    for (const PassEvidence& pass : cable.passes) {
      if (pass.passes) check_pass(evidence, cable, pass, largest, findings);
    }
  }
  for (const BearingEvidence& bearing : evidence.bearings) {
    check_bearing(evidence, bearing, findings);
  }
  for (const ContactEvidence& contact : evidence.contacts) {
    check_contact(evidence, contact, findings);
  }
}

namespace {

bool is_rough(const ContactEvidence& contact) {
  if (contact.collider_a == nullptr || contact.collider_b == nullptr) return false;
  const ColliderDef& a = *contact.collider_a;
  const ColliderDef& b = *contact.collider_b;
  return a.friction * b.friction > 0.0 ||
         a.static_friction.value_or(a.friction) * b.static_friction.value_or(b.friction) > 0.0;
}

}  // namespace

void check_contacts(const Evidence& evidence, Findings& findings) {
  for (const ContactEvidence& contact : evidence.contacts) {
    const double press = contact.press[0] + contact.press[1];
    const auto name = [&] {
      return contact.ground ? evidence.body_name(contact.body_a) + " on the ground"
                            : "the contact of " + evidence.body_name(contact.body_a) + " and " +
                                  evidence.body_name(contact.body_b);
    };
    double size = evidence.bodies.scale();
    for (const int body : {contact.body_a, contact.body_b}) {
      const double own = evidence.size_of(body);
      if (own > 0.0) size = std::min(size, own);
    }
    double compliance = 0.0;
    bool bounces = false;
    bool damped = true;
    for (const ColliderDef* collider : {contact.collider_a, contact.collider_b}) {
      if (collider == nullptr) continue;
      compliance += collider->compliance;
      bounces = bounces || collider->restitution > 0.0;
      damped = damped && collider->restitution < 1.0;
    }
    findings.note(Kind::complementarity, "N", std::max(-press, 0.0), evidence.largest_force, 0.0,
                  name);
    const double gap = contact.gap[last_end];
    const double slop = 1e-9 * evidence.bodies.scale();
    if (compliance > 0.0) {
      const double from = std::min(contact.gap[first_end], 0.0);
      double mean = evidence.rattle ? 0.5 * (from + gap) : gap;
      // A contact with friction presses by the mean of both ends.
      if (evidence.rattle && !is_rough(contact)) mean = -acting_mean(-contact.gap[first_end], -gap);
      // The first half of `rattle` contains no damper, as the damper acts at the end. The damper's
      // part is opposed to the change of the gap; within a substep of `rattle` it is at most that
      // of implicit Euler.
      const double spring = evidence.rattle ? 2.0 * contact.press[first_end] : press;
      const double way = gap - from;
      double left = mean + compliance * spring;
      if (damped && left * way < 0.0) {
        const double most = evidence.rattle ? 0.5 * std::abs(way) : std::abs(left);
        left = std::copysign(std::max(std::abs(left) - most, 0.0), left);
      }
      const double off = spring > 0.0 ? std::abs(left) : std::max(-left, 0.0);
      findings.note(Kind::contact, "m", off, std::max(compliance * press, size), slop, name);
      continue;
    }
    findings.note(Kind::contact, "m", std::max(-gap, 0.0), size, slop, name);
    // A bouncing contact has separated again within the substep.
    if (bounces || !(gap > 0.0) || !(press > 0.0)) continue;
    findings.note(Kind::complementarity, "N", press * std::min(1.0, gap / size),
                  std::max(press, evidence.largest_force), 1e-9 * press, name);
  }
}

}  // namespace sheave::certify
