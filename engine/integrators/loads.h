#pragma once
// What moves bodies without constraints; for the integrators.

#include "engine/substep.h"

namespace sheave {

/// World inertia [kg m2] of a free body with this orientation, or its inverse.
[[nodiscard]] Matrix3 world_inertia(const BodyProperties& body, const Quaternion& orientation,
                                    bool inverse);

/// What that makes of a vector: of an angular velocity the angular momentum, or the inverse. Cheaper
/// than by the matrix.
[[nodiscard]] Vector3 times_inertia(const BodyProperties& body, const Quaternion& orientation,
                                    bool inverse, const Vector3& vector);

/// Angular momentum [kg m2/s] of the rotors mounted on a body with this orientation, with the spins
/// that they had at the start of the substep.
[[nodiscard]] Vector3 rotor_momentum(const Substep& substep, const BodyProperties& carrier,
                                     const Quaternion& carrier_start,
                                     const Quaternion& orientation);

/// Constant forces [N] on body `i`, and those that have been set, with what its mounted rotors pass
/// on to it, when all have these poses.
[[nodiscard]] Vector3 force_on(const Substep& substep, int i, std::span<const BodyState> poses);
/// Likewise torques about its centre of mass [N m]. Forces on rotors act at their centres unless
/// they have been set elsewhere; of their torques the part about the axle spins the rotor.
[[nodiscard]] Vector3 torque_on(const Substep& substep, int i, std::span<const BodyState> poses);

/// Work of the forces and torques that have been set, in the substep that leads to substep.next
/// [J].
[[nodiscard]] double work_of_set_forces(const Substep& substep);

/// `velocity` without what rounding on tilted axes leaks into directions the mobility excludes; the
/// leak would add up over the substeps.
[[nodiscard]] Vector3 allowed_velocity(const BodyProperties& body, const Vector3& velocity);

/// What drag makes of a velocity in some time: v -> keep v + gain a under a constant acceleration a
/// [1, s]. Exact, so a falling body's velocity does not depend on the step. Substep::moving has it
/// in the inverse masses, as gain / time.
struct Decay {
  double keep = 1.0;
  double gain = 0.0;
};
/// `rate` is the drag's coefficient over the mass, or over the moment of inertia [1/s].
[[nodiscard]] Decay decay(double rate, double time);

/// The same for the angular velocity of a free body whose moments of inertia differ, without
/// torque: implicit midpoint, of second order and stable for any drag.
[[nodiscard]] Vector3 damped_rotation(const Substep& substep, int i, const Quaternion& orientation,
                                      const Vector3& angular_velocity, double time);

}  // namespace sheave
