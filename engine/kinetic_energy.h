#pragma once

#include "engine/substep.h"

namespace sheave {

/// Kinetic energy [J] of body `i` at its present pose in the substep, with these velocities of its
/// centre of mass [m/s] and [rad/s]. The energy of a mounted rotor is that of its spin alone; the
/// carrier's energy includes the rest.
[[nodiscard]] double kinetic_energy(const Substep& substep, int i, const Vector3& velocity,
                                    const Vector3& angular_velocity);

}  // namespace sheave
