#include "engine/integrators/loads.h"

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

}  // namespace sheave
