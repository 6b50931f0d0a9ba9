// Evidence of ground contacts and of contacts between bodies in the last substep.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cable/certificate/evidence.h"
#include "cable/certificate/pushes.h"
#include "engine/dynamics/mounted_drive.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/sphere.h"
#include "engine/solvers/direct.h"
#include "engine/substep.h"

namespace sheave::certify {
namespace {

/// Position at the end of the surface point that touches the floor at `start` [m, world]. For a
/// corner it is the same material point. On a round surface it is the contact, which does not turn
/// with the body.
Vector3 place_at_end(const Evidence& evidence, int body, const PlacedShape& placed,
                     const Vector3& start, const Vector3& normal) {
  const std::array<Moment, 2>& moments = evidence.moments;
  const auto carried = [&](const Vector3& place) {
    return moments[last_end].point(body, moments[first_end].own_point(body, place));
  };
  const Shape* shape = placed.shape.get();
  const auto* ball = dynamic_cast<const Sphere*>(shape);
  const auto* rod = dynamic_cast<const Capsule*>(shape);
  if (ball != nullptr || rod != nullptr) {
    const Vector3 below = -(ball != nullptr ? ball->radius : rod->radius) * normal;
    return carried(start - below) + below;
  }
  if (dynamic_cast<const Cylinder*>(shape) == nullptr) return carried(start);
  // The rotation between the two moments without its twist about the axis.
  const Quaternion first = moments[first_end].orientation(body);
  const Vector3 axis = first * (placed.orientation * Vector3::UnitZ());
  const Vector3 center =
      moments[first_end].point(body, placed.position - evidence.bodies[body].center_of_mass);
  const Vector3 core = center + axis * axis.dot(start - center);
  const Quaternion turn = moments[last_end].orientation(body) * first.conjugate();
  const double along = turn.vec().dot(axis);
  Quaternion twist(turn.w(), along * axis.x(), along * axis.y(), along * axis.z());
  // A rotation by half a turn has no defined twist.
  if (twist.norm() < 1e-9) return carried(start);
  twist.normalize();
  return carried(core) + turn * (twist.conjugate() * (start - core));
}

}  // namespace

void Evidence::collect_ground(const LastSubstep& last, std::size_t feature) {
  const auto late = last.late_forces.size() > feature
                        ? std::span<const double>(last.late_forces[feature])
                        : std::span<const double>();
  const auto press = parts(end.features[feature].reals, rattle, late);
  const Vector3 normal = model.ground->normal.normalized();
  std::size_t next = 0;
  std::vector<Vector3> points;
  for (int i = 0; i < bodies.count(); ++i) {
    const Mobility mobility = bodies[i].mobility;
    if (mobility != Mobility::free && mobility != Mobility::planar &&
        mobility != Mobility::slider && bodies[i].mount < 0) {
      continue;
    }
    for (const PlacedShape& placed : bodies.definition(i).shapes) {
      points.clear();
      const Quaternion to_world = moments[first_end].orientation(i) * placed.orientation;
      placed.shape->append_contact_points(to_world.conjugate() * (-normal), points);
      for (const Vector3& point : points) {
        const Vector3 own = placed.position + placed.orientation * point - bodies[i].center_of_mass;
        const std::size_t k = next++;
        ContactEvidence contact;
        contact.ground = true;
        contact.body_a = i;
        contact.body_b = bodies.count();
        contact.normal = normal;
        for (const End when : {first_end, last_end}) {
          const Vector3 touching = moments[first_end].point(i, own);
          contact.point_a[at(when)] =
              when == first_end ? touching : place_at_end(*this, i, placed, touching, normal);
          contact.gap[at(when)] = normal.dot(contact.point_a[at(when)] - model.ground->point);
          contact.point_b[at(when)] = contact.point_a[at(when)] - contact.gap[at(when)] * normal;
          contact.press[at(when)] = press[at(when)][k];
          contact.drag[at(when)].setZero();
        }
        if (contact.gap[last_end] < 0.0 || press[0][k] != 0.0 || press[1][k] != 0.0) {
          contacts.push_back(contact);
        }
      }
    }
  }
}

void Evidence::collect_contacts(const LastSubstep& last, std::size_t feature) {
  const std::vector<ContactReport> reports = simulation.world.contacts();
  const auto late = last.late_forces.size() > feature
                        ? std::span<const double>(last.late_forces[feature])
                        : std::span<const double>();
  const bool halves = rattle && late.size() == 4 * reports.size();
  const auto collider_of = [&](int body) -> const ColliderDef* {
    for (const ColliderDef& collider : model.colliders) {
      if (bodies.index(collider.body) == body) return &collider;
    }
    return nullptr;
  };
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const ContactReport& report = reports[i];
    ContactEvidence contact;
    contact.body_a = bodies.index(report.body_a);
    contact.body_b = bodies.index(report.body_b);
    contact.normal = report.normal;
    contact.sticks = report.sticks;
    contact.collider_a = collider_of(contact.body_a);
    contact.collider_b = collider_of(contact.body_b);
    const Vector3 end_a = moments[last_end].point(contact.body_a, report.core_a);
    const Vector3 end_b = moments[last_end].point(contact.body_b, report.core_b);
    const double radius_a = report.normal.dot(end_a - report.point);
    const double radius_b = report.normal.dot(end_a - end_b) - radius_a - report.gap;
    for (const End when : {first_end, last_end}) {
      const Vector3 core_a = moments[at(when)].point(contact.body_a, report.core_a);
      const Vector3 core_b = moments[at(when)].point(contact.body_b, report.core_b);
      contact.point_a[at(when)] = core_a - radius_a * report.normal;
      contact.point_b[at(when)] = core_b + radius_b * report.normal;
      contact.gap[at(when)] =
          report.normal.dot(contact.point_a[at(when)] - contact.point_b[at(when)]);
    }
    // The lowest point of a round surface does not move with the material.
    const Vector3 rolled = radius_a * turn_of(contact.body_a) + radius_b * turn_of(contact.body_b);
    contact.slip = contact.point_a[last_end] - contact.point_a[first_end] -
                   (contact.point_b[last_end] - contact.point_b[first_end]) -
                   rolled.cross(contact.normal);
    contact.press = {0.0, report.normal_force};
    contact.drag = {Vector3::Zero(), report.friction_force};
    if (halves) {
      contact.press[last_end] = late[4 * i];
      contact.drag[last_end] = Vector3(late[4 * i + 1], late[4 * i + 2], late[4 * i + 3]);
      contact.press[first_end] = report.normal_force - contact.press[last_end];
      contact.drag[first_end] = report.friction_force - contact.drag[last_end];
    }
    contacts.push_back(contact);
  }
}

void Evidence::apply_contacts() {
  // A contact that was open at the start has not acted there, and relieves those of its bodies.
  const double open = DirectSolver::closed * bodies.scale();
  std::vector<char> relieved(at(bodies.count() + 1), 0);
  for (const ContactEvidence& contact : contacts) {
    // The first part is a difference of two reported forces.
    const double least = 1e-12 * (contact.press[first_end] + contact.press[last_end]);
    if (!(contact.gap[first_end] > open) || !(contact.press[first_end] > least)) continue;
    for (int body : {contact.body_a, contact.body_b}) {
      while (body >= 0 && body < bodies.count()) {
        const BodyProperties& own = bodies[body];
        if (yields(own.mobility) && !own.prescribed()) relieved[at(body)] = 1;
        body = own.mount;
      }
    }
  }
  const auto is_relieved = [&](int body) {
    const int mount = body < bodies.count() ? bodies[body].mount : -1;
    return relieved[at(body)] != 0 || (mount >= 0 && relieved[at(mount)] != 0);
  };
  for (const ContactEvidence& contact : contacts) {
    const bool anew =
        contact.gap[first_end] > open || is_relieved(contact.body_a) || is_relieved(contact.body_b);
    for (const End when : {first_end, last_end}) {
      const Vector3 force = contact.press[at(when)] * contact.normal + contact.drag[at(when)];
      const End place = anew ? last_end : when;
      push(when, place, contact.body_a, contact.point_a[at(place)], force);
      push(when, place, contact.body_b, contact.point_b[at(place)], -force);
    }
  }
}

}  // namespace sheave::certify
