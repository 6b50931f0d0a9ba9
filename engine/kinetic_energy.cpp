#include "engine/kinetic_energy.h"

#include "engine/index.h"

namespace sheave {

double kinetic_energy(const Substep& substep, int i, const Vector3& velocity,
                      const Vector3& angular_velocity) {
  const BodyProperties& body = substep.bodies[i];
  const MovingBody& moving = substep.moving[at(i)];
  double twice = moving.translates ? body.mass * velocity.squaredNorm() : 0.0;
  if (!moving.rotates) return 0.5 * twice;
  if (body.mobility == Mobility::free) {
    const Vector3 own = moving.orientation.conjugate() * angular_velocity;
    return 0.5 * (twice + own.dot(body.inertia * own));
  }
  const Vector3 axis =
      body.mount >= 0 ? Vector3(substep.moving[at(body.mount)].orientation * body.axis) : body.axis;
  const double spin = axis.dot(angular_velocity);
  twice += body.axis_inertia * spin * spin;
  return 0.5 * twice;
}

}  // namespace sheave
