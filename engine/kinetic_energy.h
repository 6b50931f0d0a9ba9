#pragma once

#include "engine/substep.h"

namespace sheave {

/// Kinetic energy [J] of body `i` where it is now in the substep, with these velocities of its
/// centre of mass [m/s] and [rad/s]; of a mounted rotor that of its spin, the rest being its
/// carrier's.
[[nodiscard]] double kinetic_energy(const Substep& substep, int i, const Vector3& velocity,
                                    const Vector3& angular_velocity);

}  // namespace sheave
