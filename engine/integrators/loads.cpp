#include "engine/integrators/loads.h"

#include <cmath>

#include <Eigen/LU>

#include "engine/index.h"

namespace sheave {

Matrix3 world_inertia(const BodyProperties& body, const Quaternion& orientation, bool inverse) {
  const Matrix3& own = inverse ? body.inverse_inertia : body.inertia;
  if (body.isotropic) return own;
  const Matrix3 rotation = orientation.toRotationMatrix();
  return rotation * own * rotation.transpose();
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

Load load_on(const Substep& substep, int i, const Quaternion& orientation) {
  const BodyDef& own = substep.bodies.definition(i);
  Load load{own.force, own.torque};
  for (const int rotor : substep.bodies[i].mounted_rotors) {
    const BodyDef& mounted = substep.bodies.definition(rotor);
    const Vector3 axis = orientation * substep.bodies[rotor].axis;
    load.force += mounted.force;
    load.torque += (orientation * substep.bodies[rotor].mount_position).cross(mounted.force) +
                   mounted.torque - axis * axis.dot(mounted.torque);
  }
  return load;
}

Vector3 allowed_velocity(const BodyProperties& body, const Vector3& velocity) {
  const Vector3 along = body.axis * body.axis.dot(velocity);
  if (body.mobility == Mobility::slider) return along;
  if (body.mobility == Mobility::planar) return velocity - along;
  return velocity;
}

Decay decay(double rate, double time) {
  if (rate == 0.0) return {1.0, time};
  return {std::exp(-rate * time), -std::expm1(-rate * time) / rate};
}

Vector3 damped_rotation(const BodyDef& body, const Matrix3& inertia,
                        const Vector3& angular_velocity, double time) {
  if (body.angular_damping == 0.0) return angular_velocity;
  // I dw = -c w dt: (I + c t / 2) w' = (I - c t / 2) w.
  const Matrix3 half = 0.5 * time * body.angular_damping * Matrix3::Identity();
  return (inertia + half).inverse() * ((inertia - half) * angular_velocity);
}

}  // namespace sheave
