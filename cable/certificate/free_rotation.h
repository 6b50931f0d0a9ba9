#pragma once
// Rotation of bodies in a substep under their loads alone, by the integrator's own rule
// (engine/integrators/xpbd.cpp). Constraints add a rotation vector c afterwards. Rotations do not
// commute, and the integrator counts the sum of both vectors as the rotation.

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// Exact effect of drag at the rate c [1/s] over a time t: factor of an initial velocity, e^(-ct),
/// and of a steady impulse, (1 - e^(-ct)) / ct.
struct Drag {
  double keep = 1.0;
  double share = 1.0;
  Drag(double rate, double time);
};

/// Free rotation of a body. For `rattle` with the loads of the first half of the substep.
struct FreeRotation {
  Quaternion orientation;              ///< at the end of the substep
  Vector3 turn = Vector3::Zero();      ///< rotation vector that the integrator counts [rad]
  Vector3 momentum = Vector3::Zero();  ///< at the start, after drag, rotors included [N m s]
};

/// For a body that moves freely: not driven, not on an axle, not planar.
[[nodiscard]] FreeRotation free_rotation(const Evidence& evidence, int i);

/// Rotation of any body as the integrator counts it [rad]. For a freely moving body it is the sum
/// of the free rotation and the rotation by constraints.
[[nodiscard]] Vector3 counted_turn(const Evidence& evidence, int i);

/// Torque at one end of a body's own loads and of its rotors' loads, except those that spin the
/// rotors [N m].
[[nodiscard]] Vector3 load_torque_with_rotors(const Evidence& evidence, int i, End when);
/// Spin angular momentum of the rotors that the body carries, at one end, with the body in this
/// orientation [N m s].
[[nodiscard]] Vector3 rotor_momentum(const Evidence& evidence, int i, const Quaternion& orientation,
                                     End when);
/// Angular velocity after the drag of the first half of a substep, or of all of it [rad/s].
[[nodiscard]] Vector3 damped_spin(const Evidence& evidence, int i, const Matrix3& inertia,
                                  const Vector3& angular_velocity);
/// Rotates a tensor from the body's frame to the world's.
[[nodiscard]] Matrix3 in_world(const Matrix3& own, const Quaternion& orientation);

}  // namespace sheave::certify
