#pragma once
// Machines that must move alike: the mirror image, and the cable counted from its other end.

#include "tests/property/random_machine.h"

namespace sheave::test {

/// The mirror image of a polar vector (place, velocity, force, direction) in the plane x = 0.
[[nodiscard]] inline Vector3 mirrored(const Vector3& v) { return {-v.x(), v.y(), v.z()}; }
/// Of an axial vector (angular velocity, torque).
[[nodiscard]] inline Vector3 mirrored_axial(const Vector3& v) { return {v.x(), -v.y(), -v.z()}; }
/// Of an orientation: both frames are mirrored, R' = M R M.
[[nodiscard]] inline Quaternion mirrored(const Quaternion& q) {
  return {q.w(), q.x(), -q.y(), -q.z()};
}

/// The mirror image of a machine in the plane x = 0. Body frames are mirrored, too, so normals and
/// axes are mirrored as polar vectors and windings turn round.
[[nodiscard]] Machine mirrored(const Machine& machine);

/// The machine with its cables run through from the other end: a wheel that was passed
/// counter-clockwise is passed clockwise. (A belt begins at the same link.)
[[nodiscard]] Machine reversed(const Machine& machine);

}  // namespace sheave::test
