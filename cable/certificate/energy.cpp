// Energy that no work in the substep explains.
//
// An impulse P changes the kinetic energy by P . (v0 + v1) / 2, exactly. If the balance of momentum
// is closed, energy is lost or gained only where a force does work that it should not do: a rigid
// span whose violation changes, a wheel that moves more or less cable than its rim passes, a
// strained rope whose strain is left behind, a contact that pushes bodies that already separate.
// The dissipation of implicit Euler (m |v1 - v0|^2 / 2, springs, the curvature of paths) follows
// from these forces and the states, so it counts as explained. So do friction, slip, damping and
// the work of drives.
//
// Cable with a material takes its strain and energy onto wheels, and cable that comes off with
// another strain dissipates by creep (cable/cable_material.cpp). Both balances close if the rim has
// moved the length that the strain implies, which is checked.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/bounces.h"
#include "cable/certificate/checks.h"
#include "cable/certificate/joint_energy.h"

namespace sheave::certify {
namespace {

using Kind = CertificateItem::Kind;

class EnergyCheck {
 public:
  EnergyCheck(const Evidence& evidence, Findings& findings) : e_(evidence), findings_(findings) {
    for (int i = 0; i < evidence.bodies.count(); ++i) {
      kinetic_ += kinetic(i);
      const BodyProperties& body = evidence.bodies[i];
      weight_ += body.mass * evidence.gravity.norm();
      flow_ += flow_of(i);
    }
    kinetic_ += rope_energy(evidence);
    const Energy reported = evidence.simulation.world.energy();
    level_ = kinetic_ + std::abs(reported.elastic) + weight_ * evidence.bodies.scale();
    // Losses up to this floor are negligible: a millionth of the energy of the machine, or a
    // thousandth of the energy flow.
    floor_ = std::max(1e-6 * level_, 1e-3 * flow_);
    // Lengths are differences of coordinates of this size. Forces on bodies that are loaded and at
    // rest, without a weight or a motion as scale, work over the rounding of these lengths.
    double reach = evidence.bodies.scale();
    for (const BodyState& body : evidence.end.bodies) {
      reach = std::max(reach, body.position.norm() + evidence.bodies.scale());
    }
    rounding_ = 64.0 * std::numeric_limits<double>::epsilon() * evidence.largest_force * reach;
    findings.note(Kind::energy, "J", std::abs(reported.kinetic - kinetic_),
                  std::max(kinetic_, reported.kinetic), 1e-12 * kinetic_,
                  [] { return std::string("the kinetic energy as it is reported"); });
  }

  void check(const std::vector<double>& leaks) {
    for (int i = 0; i < e_.bodies.count(); ++i) {
      add(leaks[at(i)], flow_of(i), [&] { return e_.body_name(i); });
    }
    for (const CableEvidence& cable : e_.cables) {
      if (cable.has_changed || cable.start.cut) continue;
      for (std::size_t k = 0; k < cable.spans.size(); ++k) check_span(cable, k);
    }
    for (const JointEvidence& joint : e_.joints) {
      if (!joint.broken) check_joint(joint);
    }
    bounced_ = !e_.rattle && std::any_of(e_.contacts.begin(), e_.contacts.end(), bounces);
    for (const ContactEvidence& contact : e_.contacts) check_contact(contact);
    const Bounced bounced = BounceCheck(e_).sum();
    if (bounced.flow > 0.0) {
      add(std::max(bounced.energy, 0.0), bounced.flow, [] { return std::string("the bounces"); });
    }
    findings_.note(Kind::energy, "J", std::abs(sum_),
                   std::max(flow_ + within_joints_ + beside_spans_, floor_), added_ * rounding_,
                   [] { return std::string("all together"); });
  }

 private:
  /// Adds unexplained energy, with the energy that passed there as scale.
  template <class Name>
  void add(double unexplained, double flow, const Name& name) {
    sum_ += unexplained;
    ++added_;
    findings_.note(Kind::energy, "J", std::abs(unexplained), std::max(flow, floor_), rounding_,
                   name);
  }

  /// Energy that passes through a body in the substep [J]: in from some forces and loads, out to
  /// others or into its motion.
  [[nodiscard]] double flow_of(int i) const {
    const BodyProperties& body = e_.bodies[i];
    double power = e_.balances[at(i)].power;
    if (yields(body.mobility)) {
      const BodyState& state = e_.end.bodies[at(i)];
      power += std::abs((body.mass * e_.gravity + e_.load_force(i, last_end)).dot(state.velocity)) +
               std::abs(e_.load_torque(i, last_end).dot(state.angular_velocity));
    }
    return 0.5 * e_.h * power;
  }

  [[nodiscard]] double kinetic(int i) const {
    const BodyProperties& body = e_.bodies[i];
    const BodyState& state = e_.end.bodies[at(i)];
    const Vector3& w = state.angular_velocity;
    switch (body.mobility) {
      case Mobility::fixed:
      case Mobility::kinematic:
      case Mobility::knot:
        return 0.0;
      case Mobility::rotor: {
        const double spin = body.mount >= 0
                                ? w.dot(e_.moments[last_end].orientation(body.mount) * body.axis)
                                : w.dot(body.axis);
        return 0.5 * body.axis_inertia * spin * spin;
      }
      case Mobility::free:
      case Mobility::planar:
      case Mobility::slider:
        break;
    }
    const Matrix3 rotation = state.orientation.toRotationMatrix();
    const Vector3 momentum = rotation * (body.inertia * (rotation.transpose() * w));
    return 0.5 * (body.mass * state.velocity.squaredNorm() + w.dot(momentum));
  }

  [[nodiscard]] double flow_through(const SpanEvidence& span) const {
    double speed = 0.0;
    for (const End when : {first_end, last_end}) {
      const Moment& now = e_.moments[at(when)];
      const Vector3& u = span.direction[at(when)];
      speed =
          std::max({speed, std::abs(u.dot(now.velocity(span.from.body, span.from.point[at(when)]))),
                    std::abs(u.dot(now.velocity(span.to.body, span.to.point[at(when)])))});
    }
    return span.tension() * e_.h * speed;
  }

  /// Energy flow of the span if its ends moved along it at their full speeds [J]. The error of
  /// frozen attachments is proportional to the motion of their bodies, not to its component along
  /// the span.
  [[nodiscard]] double flow_beside(const SpanEvidence& span) const {
    double speed = 0.0;
    for (const End when : {first_end, last_end}) {
      const Moment& now = e_.moments[at(when)];
      speed = std::max({speed, now.velocity(span.from.body, span.from.point[at(when)]).norm(),
                        now.velocity(span.to.body, span.to.point[at(when)]).norm()});
    }
    return span.tension() * e_.h * speed;
  }

  /// Attachments that kept their places for the substep are computed again at its end. The spring
  /// then has another length than the one on which the tension acted.
  void check_laid(const CableEvidence& cable, std::size_t k) {
    const SpanEvidence& span = cable.spans[k];
    const CableDef& definition = *cable.definition;
    const double rest_length = span.rest_length[last_end];
    const double compliance = definition.axial_stiffness
                                  ? std::max(rest_length, 0.0) / *definition.axial_stiffness
                                  : definition.compliance.value_or(0.0);
    if (!(compliance > 0.0)) return;
    const auto stored = [&](double stretch) {
      return 0.5 * std::max(stretch, 0.0) * std::max(stretch, 0.0) / compliance;
    };
    const double acted = (span.to.point[last_end] - span.from.point[last_end]).norm();
    const double gained = rest_length - span.rest_length[first_end];
    const double rolled = gained - span.fed - passed_into(cable, static_cast<int>(k));
    // Cable that passes a rim has the same length on it and off it.
    const auto [first, second] = rim_travels(e_, cable, span, rolled);
    const double off = span.length[last_end] - acted - first - second;
    const double laid = span.length[last_end] - rest_length;
    const double flow = flow_beside(span);
    beside_spans_ += flow;
    add(stored(laid) - stored(laid - off), flow, [&] { return span.name(); });
  }

  void check_span(const CableEvidence& cable, std::size_t k) {
    const SpanEvidence& span = cable.spans[k];
    const double tension = span.tension();
    if (!span.has_tangent) return;
    if (cable.frozen) return check_laid(cable, k);
    if (!(tension > 0.0)) return;
    const double gained = span.rest_length[last_end] - span.rest_length[first_end];
    const double passed = span.fed + passed_into(cable, static_cast<int>(k));
    const double rolled = gained - passed;
    double rims = rolled;
    if (!span.from.outlined && !span.to.outlined) {
      const auto [first, second] = rim_travels(e_, cable, span, rolled);
      rims = first + second;
    }
    double unexplained = tension * rims;
    const double rest = span.rest_length[last_end];
    if (cable.definition->has_material()) {
      unexplained = span.from.outlined || span.to.outlined
                        ? 0.0
                        : tension * unrolled(e_, cable, span, rolled);
    } else {
      unexplained -= tension * rolled;
      // When the cable has come to touch a body, the penetration is removed afterwards.
      if (!(cable.definition->compliance.value_or(0.0) > 0.0) && !cable.was_changed) {
        const double excess0 = span.length[first_end] - span.rest_length[first_end];
        const double excess1 = span.length[last_end] - rest;
        // A span that becomes taut has stopped its load: an impact.
        unexplained -= tension * (std::max(excess1, 0.0) - std::max(excess0, 0.0));
      }
    }
    add(unexplained, flow_through(span), [&] { return span.name(); });
  }

  /// Length that slid into a span over its links [m].
  static double passed_into(const CableEvidence& cable, int span) {
    double passed = 0.0;
    for (const PassEvidence& pass : cable.passes) {
      if (pass.after == span) passed += pass.came();
      if (pass.before == span) passed -= pass.left();
    }
    return passed;
  }

  void check_joint(const JointEvidence& joint) {
    const JointWork work = work_of(e_, joint);
    // Work of a drive against a lock of the same joint passes through no body.
    within_joints_ += work.flow;
    add(work.unexplained, work.flow, [&] {
      return std::string(joint.definition->type()) + " \"" + joint.definition->name + "\"";
    });
  }

  /// Friction dissipates along the path on which bodies slide over each other, and creates no
  /// energy. With `rattle` that path is not visible in the velocities, which are those at both ends
  /// of a substep.
  void check_rubbing(const ContactEvidence& contact) {
    if (bounced_) return;
    const Vector3 drag = contact.drag[0] + contact.drag[1];
    if (is_zero(drag)) return;
    const Vector3 slip = contact.slip - contact.normal * contact.normal.dot(contact.slip);
    add(std::max(drag.dot(slip), 0.0), drag.norm() * slip.norm(), [&] {
      return "friction between " + e_.body_name(contact.body_a) + " and " +
             e_.body_name(contact.body_b);
    });
  }

  /// The damper of a compliant contact acts at the end of a substep of `rattle`, against the motion
  /// there.
  void check_damper(const ContactEvidence& contact) {
    if (!e_.rattle) return;
    const Moment& now = e_.moments[last_end];
    const double speed =
        contact.normal.dot(now.velocity(contact.body_a, contact.point_a[last_end]) -
                           now.velocity(contact.body_b, contact.point_b[last_end]));
    const double damper = contact.press[last_end] - contact.press[first_end];
    const double press = contact.press[first_end] + contact.press[last_end];
    add(std::max(damper * speed, 0.0) * e_.h, press * std::abs(speed) * e_.h, [&] {
      return "the damper of the contact of " + e_.body_name(contact.body_a) + " and " +
             e_.body_name(contact.body_b);
    });
  }

  void check_contact(const ContactEvidence& contact) {
    check_rubbing(contact);
    double compliance = 0.0;
    for (const ColliderDef* collider : {contact.collider_a, contact.collider_b}) {
      if (collider != nullptr) compliance += collider->compliance;
    }
    if (compliance > 0.0) {
      check_damper(contact);
      return;
    }
    // BounceCheck checks the energy of bounces, from the velocities of all contacts together.
    if (bounces(contact) && !e_.rattle) return;
    const auto speed_at = [&](End when) {
      const Moment& now = e_.moments[at(when)];
      return contact.normal.dot(now.velocity(contact.body_a, contact.point_a[at(when)]) -
                                now.velocity(contact.body_b, contact.point_b[at(when)]));
    };
    const double press = contact.press[0] + contact.press[1];
    const double flow =
        press * e_.h * std::max(std::abs(speed_at(first_end)), std::abs(speed_at(last_end)));
    // Contacts remove 1/50 of a penetration per substep; sinking has taken the energy for that. The
    // depth of the penetration is a figure of its own.
    constexpr double opened_share = 0.02;
    const double opened =
        contact.ground ? 0.0 : opened_share * std::max(-contact.gap[first_end], 0.0);
    const double way = contact.gap[last_end] - contact.gap[first_end] - opened;
    add(std::max(press * way, 0.0), flow, [&] {
      return "the contact of " + e_.body_name(contact.body_a) +
             (contact.ground ? std::string(" and the ground")
                             : " and " + e_.body_name(contact.body_b));
    });
  }

  const Evidence& e_;
  Findings& findings_;
  double kinetic_ = 0.0;
  double weight_ = 0.0;
  double flow_ = 0.0;
  double within_joints_ = 0.0;
  /// energy flow by which spans with frozen attachments are judged [J]
  double beside_spans_ = 0.0;
  double level_ = 0.0;
  double floor_ = 0.0;
  double rounding_ = 0.0;  ///< largest force times the rounding of lengths [J]
  double sum_ = 0.0;
  int added_ = 0;         ///< number of figures in sum_
  bool bounced_ = false;  ///< contacts bounce, so velocities are not those of the paths
};

}  // namespace

void check_energy(const Evidence& evidence, const std::vector<double>& leaks, Findings& findings) {
  EnergyCheck(evidence, findings).check(leaks);
}

}  // namespace sheave::certify
