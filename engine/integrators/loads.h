#pragma once
// What moves bodies without constraints; for the integrators.

#include "engine/substep.h"

namespace sheave {

/// World inertia [kg m2] of a free body with this orientation, or its inverse.
[[nodiscard]] Matrix3 world_inertia(const BodyProperties& body, const Quaternion& orientation,
                                    bool inverse);

/// Angular momentum [kg m2/s] of the rotors mounted on a body with this orientation, with the spins that they had at the
/// start of the substep.
[[nodiscard]] Vector3 rotor_momentum(const Substep& substep, const BodyProperties& carrier,
                                     const Quaternion& carrier_start,
                                     const Quaternion& orientation);

/// Constant forces [N] and torques [N m] on a body, about its centre of mass.
struct Load {
  Vector3 force;
  Vector3 torque;
};

/// What acts on body `i` itself and what its mounted rotors pass on to it when it has this orientation: their forces,
/// which act at their centres, and their torques but for the part about the axle, which spins the rotor.
[[nodiscard]] Load load_on(const Substep& substep, int i, const Quaternion& orientation);

/// `velocity` without what rounding on tilted axes leaks into directions the mobility excludes; the leak would add up
/// over the substeps.
[[nodiscard]] Vector3 allowed_velocity(const BodyProperties& body, const Vector3& velocity);

}  // namespace sheave
