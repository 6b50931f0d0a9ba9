#pragma once
// Loads on bodies, and the motion without constraints; for the integrators.

#include "engine/substep.h"

namespace sheave {

/// World inertia [kg m2] of a free body with this orientation, or its inverse.
[[nodiscard]] Matrix3 world_inertia(const BodyProperties& body, const Quaternion& orientation,
                                    bool inverse);

/// The product of that tensor and `vector`: the angular momentum of an angular velocity, or with
/// `inverse` the angular velocity of an angular momentum. Cheaper than the tensor itself.
[[nodiscard]] Vector3 times_inertia(const BodyProperties& body, const Quaternion& orientation,
                                    bool inverse, const Vector3& vector);

/// Angular momentum [kg m2/s] of the rotors mounted on a body with this orientation, with their
/// spins of the start of the substep.
[[nodiscard]] Vector3 rotor_momentum(const Substep& substep, const BodyProperties& carrier,
                                     const Quaternion& carrier_start,
                                     const Quaternion& orientation);

/// Constant forces and forces set by controls [N] on body `i` and on the rotors mounted on it, if
/// all bodies have these poses.
[[nodiscard]] Vector3 force_on(const Substep& substep, int i, std::span<const BodyState> poses);
/// Likewise torques about its centre of mass [N m]. A constant force on a rotor acts at the rotor's
/// centre, a force set by a control at its arm. The component of a rotor's torque about its axle is
/// left out, because it spins the rotor.
[[nodiscard]] Vector3 torque_on(const Substep& substep, int i, std::span<const BodyState> poses);

/// Work of the forces and torques that controls set, in the substep that leads to substep.next [J].
[[nodiscard]] double work_of_set_forces(const Substep& substep);

/// `velocity` without components that the mobility excludes. Rounding on tilted axes causes such
/// components, and they would grow over the substeps.
[[nodiscard]] Vector3 allowed_velocity(const BodyProperties& body, const Vector3& velocity);

/// The effect of drag on a velocity during some time: v -> keep v + gain a under a constant
/// acceleration a [1, s]. The solution is exact, so the velocity of a falling body does not depend
/// on the step. The inverse masses of Substep::moving contain drag as the factor gain / time.
struct Decay {
  double keep = 1.0;
  double gain = 0.0;
};
/// `rate` is the drag's coefficient over the mass, or over the moment of inertia [1/s].
[[nodiscard]] Decay decay(double rate, double time);

/// The same for the angular velocity of a free body with unequal moments of inertia, without
/// torque: implicit midpoint rule, of second order and stable for any drag.
[[nodiscard]] Vector3 damped_rotation(const Substep& substep, int i, const Quaternion& orientation,
                                      const Vector3& angular_velocity, double time);

}  // namespace sheave
