#include "engine/integrators/loads.h"

#include <cmath>

#include <Eigen/LU>

#include "engine/index.h"
#include "engine/math/portable.h"

namespace sheave {

Matrix3 world_inertia(const BodyProperties& body, const Quaternion& orientation, bool inverse) {
  const Matrix3& own = inverse ? body.inverse_inertia : body.inertia;
  return body.isotropic ? own : turned_tensor(orientation, own);
}

Vector3 times_inertia(const BodyProperties& body, const Quaternion& orientation, bool inverse,
                      const Vector3& vector) {
  const Matrix3& own = inverse ? body.inverse_inertia : body.inertia;
  if (body.isotropic) return times(own, vector);
  return rotated(orientation, times(own, rotated(orientation.conjugate(), vector)));
}

Vector3 rotor_momentum(const Substep& substep, const BodyProperties& carrier,
                       const Quaternion& carrier_start, const Quaternion& orientation) {
  Vector3 sum = Vector3::Zero();
  for (const int i : carrier.mounted_rotors) {
    const BodyProperties& rotor = substep.bodies[i];
    const double spin =
        (carrier_start * rotor.axis).dot(substep.start.bodies[at(i)].angular_velocity);
    sum += rotor.axis_inertia * spin * (orientation * rotor.axis);
  }
  return sum;
}

Vector3 force_on(const Substep& substep, int i, std::span<const BodyState> poses) {
  const ControlTable<ForceControl>& forces = substep.start.controls.forces;
  const std::vector<int>& rotors = substep.bodies[i].mounted_rotors;
  Vector3 force = substep.bodies.definition(i).force;
  for (const int rotor : rotors) force += substep.bodies.definition(rotor).force;
  if (!forces.any()) return force;
  if (const ForceControl* set = forces.find(i)) {
    force += set->force_in_world(poses[at(i)].orientation);
  }
  for (const int rotor : rotors) {
    const ForceControl* set = forces.find(rotor);
    if (set != nullptr) force += set->force_in_world(poses[at(rotor)].orientation);
  }
  return force;
}

Vector3 torque_on(const Substep& substep, int i, std::span<const BodyState> poses) {
  const ControlTable<ForceControl>& forces = substep.start.controls.forces;
  const std::vector<int>& rotors = substep.bodies[i].mounted_rotors;
  const Quaternion& orientation = poses[at(i)].orientation;
  Vector3 torque = substep.bodies.definition(i).torque;
  for (const int rotor : rotors) {
    const BodyDef& mounted = substep.bodies.definition(rotor);
    const Vector3 axis = orientation * substep.bodies[rotor].axis;
    torque += (orientation * substep.bodies[rotor].mount_position).cross(mounted.force) +
              mounted.torque - axis * axis.dot(mounted.torque);
  }
  if (!forces.any()) return torque;
  const ForceControl* own = forces.find(i);
  if (own != nullptr && !own->is_central()) torque += own->torque_in_world(orientation);
  for (const int rotor : rotors) {
    const ForceControl* set = forces.find(rotor);
    if (set == nullptr) continue;
    const Vector3 axis = orientation * substep.bodies[rotor].axis;
    const Vector3 force = set->force_in_world(poses[at(rotor)].orientation);
    const Vector3 own_torque = set->torque_in_world(poses[at(rotor)].orientation);
    torque += (orientation * substep.bodies[rotor].mount_position).cross(force) + own_torque -
              axis * axis.dot(own_torque);
  }
  return torque;
}

double work_of_set_forces(const Substep& substep) {
  double work = 0.0;
  for (int i = 0; i < substep.bodies.count(); ++i) {
    const ForceControl* set = substep.start.controls.forces.find(i);
    if (set == nullptr) continue;
    const BodyState& from = substep.start.bodies[at(i)];
    const BodyState& to = substep.next.bodies[at(i)];
    if (set->frame == ForceFrame::world && set->is_central()) {
      work += dot(set->force, to.position - from.position);
      continue;
    }
    const auto point = [&](const BodyState& body) -> Vector3 {
      return body.position + rotated(body.orientation, set->arm);
    };
    const auto torque = [&](const BodyState& body) -> Vector3 {
      return set->frame == ForceFrame::world ? set->torque : rotated(body.orientation, set->torque);
    };
    const Vector3 force =
        0.5 * (set->force_in_world(from.orientation) + set->force_in_world(to.orientation));
    work += dot(force, point(to) - point(from)) +
            0.25 * substep.h *
                dot(torque(from) + torque(to), from.angular_velocity + to.angular_velocity);
  }
  return work;
}

Vector3 allowed_velocity(const BodyProperties& body, const Vector3& velocity) {
  if (body.mobility == Mobility::free) return velocity;
  const Vector3 along = body.axis * body.axis.dot(velocity);
  if (body.mobility == Mobility::slider) return along;
  if (body.mobility == Mobility::planar) return velocity - along;
  return velocity;
}

Decay decay(double rate, double time) {
  if (rate == 0.0) return {1.0, time};
  return {portable::exp(-rate * time), -portable::expm1(-rate * time) / rate};
}

Vector3 damped_rotation(const Substep& substep, int i, const Quaternion& orientation,
                        const Vector3& angular_velocity, double time) {
  const double damping = substep.bodies.definition(i).angular_damping;
  if (damping == 0.0) return angular_velocity;
  const Matrix3 inertia = world_inertia(substep.bodies[i], orientation, false);
  // I dw = -c w dt: (I + c t / 2) w' = (I - c t / 2) w.
  const Matrix3 half = 0.5 * time * damping * Matrix3::Identity();
  return (inertia + half).inverse() * ((inertia - half) * angular_velocity);
}

}  // namespace sheave
