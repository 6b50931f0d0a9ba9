#pragma once
// How bodies turn in a substep with nothing but their loads, by the integrator's own rule
// (engine/integrators/xpbd.cpp). What turns them besides is a rotation vector c after that, and as
// rotations do not commute the integrator counts as turned the sum of both.

#include "cable/certificate/evidence.h"

namespace sheave::certify {

/// What drag at the rate c [1/s], which is exact, leaves of a velocity in a time t, e^(-ct), and of
/// a steady impulse, (1 - e^(-ct)) / ct.
struct Drag {
  double keep = 1.0;
  double share = 1.0;
  Drag(double rate, double time);
};

/// Of `rattle` with the loads of its first half.
struct FreeRotation {
  Quaternion orientation;              ///< at the end
  Vector3 turn = Vector3::Zero();      ///< rotation vector that the integrator counts it by [rad]
  Vector3 momentum = Vector3::Zero();  ///< at the start, less drag, the rotors' included [N m s]
};

/// Of a body that moves freely: neither driven nor on an axle nor planar.
[[nodiscard]] FreeRotation free_rotation(const Evidence& evidence, int i);

/// How far any body has turned, as the integrator counts it: of one that moves freely the free
/// rotation and what came after it [rad].
[[nodiscard]] Vector3 counted_turn(const Evidence& evidence, int i);

/// Torque of a body's own loads and those of the rotors on it, but for what spins these, at one end
/// [N m].
[[nodiscard]] Vector3 load_torque_with_rotors(const Evidence& evidence, int i, End when);
/// Spin angular momentum of the rotors that the body carries, of one end, with the body turned like
/// that [N m s].
[[nodiscard]] Vector3 rotor_momentum(const Evidence& evidence, int i, const Quaternion& orientation,
                                     End when);
/// What drag leaves of an angular velocity in the first half of a substep, or all of it [rad/s].
[[nodiscard]] Vector3 damped_spin(const Evidence& evidence, int i, const Matrix3& inertia,
                                  const Vector3& angular_velocity);
/// A tensor of the body's frame in that of the world.
[[nodiscard]] Matrix3 in_world(const Matrix3& own, const Quaternion& orientation);

}  // namespace sheave::certify
