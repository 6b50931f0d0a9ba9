// Change of energy by bounces, exactly.
//
// Impulses P of contacts, which act at the end of a substep of `xpbd`, change the kinetic energy by
// P . (v- + v+) / 2, where v+ are the velocities at the end and v- = v+ - W P those without the
// impulses: the earlier work of friction and other forces does not belong to the bounce. In
// addition, the velocity v- has not led the bodies to their end positions. With the acceleration a
// by all forces except contacts, the displacement d = x1 - x0 - h v-, also out of penetrations,
// costs the energy -m a . d along the normals of the contacts. (Friction prevents displacements
// perpendicular to the normals.) Newton's law of the normal velocities together with friction never
// creates energy, but energy that friction takes may turn a body so that its normal force does
// work.
//
// Velocities of `xpbd` are means over a substep, a h / 2 behind those at its end. With these
// velocities energy is kept in free fall: (v- + v+) / 2 has a h / 2 more. A body that leaves a
// surface at w < a h and is put back on it within the substep gains m w (a h - w) / 2, at most m
// a^2 h^2 / 8, because so short a bounce has no height. `rattle`, whose substeps with impacts are
// done by the rule of `xpbd`, has the velocities of the end. Such a substep falls by h^2 a, twice
// the exact h^2 a / 2. The lost energy m a^2 h^2 / 2 does not belong to the bounces.

#include "cable/certificate/bounces.h"

#include <algorithm>
#include <cmath>

namespace sheave::certify {

bool bounces(const ContactEvidence& contact) {
  const auto rebounds = [](const ColliderDef* collider) {
    return collider != nullptr && collider->restitution > 0.0;
  };
  const auto gives = [](const ColliderDef* collider) {
    return collider != nullptr && collider->compliance > 0.0;
  };
  return (rebounds(contact.collider_a) || rebounds(contact.collider_b)) &&
         !gives(contact.collider_a) && !gives(contact.collider_b);
}

BounceCheck::BounceCheck(const Evidence& evidence) : e_(evidence) {
  if (e_.rattle || std::none_of(e_.contacts.begin(), e_.contacts.end(), bounces)) return;
  changes_.resize(at(e_.bodies.count()) + 1);
  for (const ContactEvidence& contact : e_.contacts) {
    const Vector3 impulse =
        e_.h * (contact.press[last_end] * contact.normal + contact.drag[last_end]);
    push(contact.body_a, contact.point_a[last_end], impulse);
    push(contact.body_b, contact.point_b[last_end], -impulse);
    if (!bounces(contact)) continue;
    for (const int body : {contact.body_a, contact.body_b}) span(leader(body), contact.normal);
  }
  for (int i = 0; i < e_.bodies.count(); ++i) yield(i);
}

int BounceCheck::leader(int body) const {
  const int mount = e_.bodies[body].mount;
  return mount >= 0 ? mount : body;
}

void BounceCheck::push(int body, const Vector3& point, const Vector3& impulse) {
  if (body == e_.bodies.count()) return;
  const Moment& now = e_.moments[last_end];
  const int mount = e_.bodies[body].mount;
  Vector3 spin = Vector3::Zero();
  if (mount >= 0) {
    // The bearing transmits everything except the torque about the axle.
    const Vector3 axle = now.orientation(mount) * e_.bodies[body].axis;
    spin = axle * axle.dot((point - now.center(body)).cross(impulse));
    changes_[at(body)].angular += spin;
  }
  Change& led = changes_[at(leader(body))];
  led.linear += impulse;
  led.angular += (point - now.center(leader(body))).cross(impulse) - spin;
}

void BounceCheck::span(int body, const Vector3& normal) {
  Change& change = changes_[at(body)];
  Vector3 rest = normal;
  for (int k = 0; k < change.normal_count; ++k) {
    rest -= change.normals[at(k)] * change.normals[at(k)].dot(rest);
  }
  if (change.normal_count == 3 || !(rest.norm() > 1e-6)) return;
  change.normals[at(change.normal_count++)] = rest.normalized();
}

void BounceCheck::yield(int body) {
  const BodyProperties& properties = e_.bodies[body];
  Change& change = changes_[at(body)];
  const Vector3 along = properties.axis * properties.axis.dot(change.linear);
  const Matrix3 rotation = e_.moments[last_end].orientation(body).toRotationMatrix();
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();
  switch (properties.mobility) {
    case Mobility::fixed:
    case Mobility::kinematic:
    case Mobility::knot:
      break;
    case Mobility::free:
      linear = change.linear / properties.mass;
      angular = rotation * (properties.inverse_inertia * (rotation.transpose() * change.angular));
      break;
    case Mobility::planar:
      linear = (change.linear - along) / properties.mass;
      angular = properties.axis * properties.axis.dot(change.angular) / properties.axis_inertia;
      break;
    case Mobility::slider:
      linear = along / properties.mass;
      break;
    case Mobility::rotor: {
      if (!(properties.axis_inertia > 0.0) || properties.prescribed()) break;
      const bool mounted = properties.mount >= 0;
      const Vector3 axle =
          mounted ? Vector3(e_.moments[last_end].orientation(properties.mount) * properties.axis)
                  : properties.axis;
      angular = axle * axle.dot(change.angular) / properties.axis_inertia;
      break;
    }
  }
  change.linear = linear;
  change.angular = angular;
}

Vector3 BounceCheck::without(int body, const Vector3& point) const {
  const Moment& now = e_.moments[last_end];
  Vector3 velocity = now.velocity(body, point);
  if (body == e_.bodies.count()) return velocity;
  const Change& led = changes_[at(leader(body))];
  velocity -= led.linear + led.angular.cross(point - now.center(leader(body)));
  if (leader(body) == body) return velocity;
  // A mounted rotor shares its carrier's rotation except the part about the axle.
  const Vector3 axle = now.orientation(leader(body)) * e_.bodies[body].axis;
  const Vector3 spun = changes_[at(body)].angular - axle * axle.dot(led.angular);
  return velocity - spun.cross(point - now.center(body));
}

Vector3 BounceCheck::acceleration(int body) const {
  const BodyProperties& properties = e_.bodies[body];
  const bool moves = properties.mobility == Mobility::free ||
                     properties.mobility == Mobility::planar ||
                     properties.mobility == Mobility::slider;
  if (!moves) return Vector3::Zero();
  const Vector3 change = e_.end.bodies[at(body)].velocity - e_.start.bodies[at(body)].velocity;
  return (change - changes_[at(body)].linear) / e_.h;
}

Bounced BounceCheck::sum() const {
  Bounced bounced;
  if (changes_.empty()) return bounced;
  const bool means = e_.model.step.integrator == IntegratorKind::xpbd;
  for (const ContactEvidence& contact : e_.contacts) {
    const double push = e_.h * contact.press[last_end];
    if (!bounces(contact) || !(push > 0.0)) continue;
    const Vector3& at_a = contact.point_a[last_end];
    const Vector3& at_b = contact.point_b[last_end];
    const Moment& now = e_.moments[last_end];
    const Vector3 parting = now.velocity(contact.body_a, at_a) - now.velocity(contact.body_b, at_b);
    const Vector3 meeting = without(contact.body_a, at_a) - without(contact.body_b, at_b);
    const double after = contact.normal.dot(parting);
    const double before = contact.normal.dot(meeting);
    double worked = 0.5 * push * (before + after);
    for (const auto& [body, sense] : {std::pair{contact.body_a, 1.0}, {contact.body_b, -1.0}}) {
      if (body == e_.bodies.count()) continue;
      const double a = sense * contact.normal.dot(acceleration(leader(body)));
      worked -= (means ? 0.5 : 1.0) * e_.h * a * push;
    }
    // Friction may turn a body so that the normal force works on it, by at most the energy that
    // friction takes.
    const double rubbed = 0.5 * e_.h * contact.drag[last_end].dot(meeting + parting);
    bounced.energy += worked > 0.0 ? std::max(worked + std::min(rubbed, 0.0), 0.0) : worked;
    bounced.flow += push * std::max(std::abs(before), std::abs(after));
  }
  for (int i = 0; i < e_.bodies.count(); ++i) bounced.energy += fallen_beside(i, means);
  return bounced;
}

double BounceCheck::fallen_beside(int body, bool means) const {
  const Change& change = changes_[at(body)];
  const BodyState& to = e_.end.bodies[at(body)];
  const Vector3 beside = e_.h * to.velocity - (to.position - e_.start.bodies[at(body)].position);
  const Vector3 a = acceleration(body);
  double work = 0.0;
  for (int k = 0; k < change.normal_count; ++k) {
    const double fall = change.normals[at(k)].dot(a);
    work += fall * change.normals[at(k)].dot(beside);
    work -= (means ? 0.125 : 0.5) * fall * fall * e_.h * e_.h;
  }
  return e_.bodies[body].mass * work;
}

}  // namespace sheave::certify
