#pragma once
// Vectors and rotations.
//
// Frames: unless a name says otherwise, vectors are in the world frame, right-handed, SI units.
// "body frame" is the frame in which a body's shapes and link points are written; its origin need
// not be the centre of mass. Quaternions turn body-frame vectors into world-frame vectors.
//
// Quaternion is an unaligned Eigen type and Vector3 and Matrix3 never are aligned ones, so that the
// layout of public structs does not depend on the instruction set or the settings of Eigen that a
// program is compiled with (docs/how-to/cpp.md).

#include <cmath>
#include <cstddef>
#include <type_traits>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/math/portable.h"

namespace sheave {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::ColMajor>;
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

static_assert(sizeof(Vector3) == 3 * sizeof(double) && alignof(Vector3) <= alignof(double) &&
                  sizeof(Matrix3) == 9 * sizeof(double) && alignof(Matrix3) <= alignof(double) &&
                  sizeof(Quaternion) == 4 * sizeof(double) &&
                  alignof(Quaternion) <= alignof(double),
              "a setting of Eigen changes the layout of structs that the library has compiled");
static_assert(std::is_same_v<Eigen::Index, std::ptrdiff_t>,
              "EIGEN_DEFAULT_DENSE_INDEX_TYPE must not be set in programs that use Sheave");

constexpr double pi = 3.14159265358979323846;

// Products for inner loops, written out: Eigen's expression templates for 3 x 3 sizes are not
// inlined at -O2 and cost several times as much. One fixed order of summation, too.

/// a . b
[[nodiscard, gnu::always_inline]] inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// a x b
[[nodiscard, gnu::always_inline]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// m v
[[nodiscard, gnu::always_inline]] inline Vector3 times(const Matrix3& m, const Vector3& v) {
  return {m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2],
          m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
          m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]};
}
/// a + s b
[[nodiscard, gnu::always_inline]] inline Vector3 sum(const Vector3& a, double s, const Vector3& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

/// Whether all components are 0.
[[nodiscard]] inline bool is_zero(const Vector3& v) {
  return v[2] == 0.0 && v[0] == 0.0 && v[1] == 0.0;
}

/// Whether all components are finite; 0 times infinity or NaN is NaN.
[[nodiscard]] inline bool is_finite(const Vector3& v) {
  return 0.0 * v[0] + 0.0 * v[1] + 0.0 * v[2] == 0.0;
}

/// q v, in Eigen's order of operations.
[[nodiscard, gnu::always_inline]] inline Vector3 rotated(const Quaternion& q, const Vector3& v) {
  const Vector3 axis{q.x(), q.y(), q.z()};
  Vector3 twice = cross(axis, v);
  twice += twice;
  const Vector3 last = cross(axis, twice);
  return {v[0] + q.w() * twice[0] + last[0], v[1] + q.w() * twice[1] + last[1],
          v[2] + q.w() * twice[2] + last[2]};
}

/// R m R^T of a symmetric m, with the matrix R of q.
[[nodiscard]] inline Matrix3 turned_tensor(const Quaternion& q, const Matrix3& m) {
  const Matrix3 r = q.toRotationMatrix();
  Matrix3 result;
  for (int i = 0; i < 3; ++i) {
    const Vector3 row = times(m, Vector3{r(i, 0), r(i, 1), r(i, 2)});
    for (int j = 0; j <= i; ++j) {
      result(i, j) = row[0] * r(j, 0) + row[1] * r(j, 1) + row[2] * r(j, 2);
      result(j, i) = result(i, j);
    }
  }
  return result;
}

/// The rotation by |turn| radians about turn/|turn| [rad], exact to rounding for any size.
/// Small turns (every correction of a solver is one) use the Taylor series of sin and cos, which
/// at |turn| < 0.2 is exact to the last bit and several times faster.
[[nodiscard]] inline Quaternion rotation_by(const Vector3& turn) {
  const double half_squared = 0.25 * dot(turn, turn);
  double half_cosine = 0.0;
  double half_sinc = 0.0;  // sin(half angle) / half angle
  if (half_squared < 0.01) {
    const double t = half_squared;
    // Products with constants: a division takes as long as ten products.
    half_cosine =
        1.0 - t * (1.0 / 2.0) *
                  (1.0 - t * (1.0 / 12.0) *
                             (1.0 - t * (1.0 / 30.0) *
                                        (1.0 - t * (1.0 / 56.0) * (1.0 - t * (1.0 / 90.0)))));
    half_sinc =
        1.0 - t * (1.0 / 6.0) *
                  (1.0 - t * (1.0 / 20.0) *
                             (1.0 - t * (1.0 / 42.0) *
                                        (1.0 - t * (1.0 / 72.0) * (1.0 - t * (1.0 / 110.0)))));
  } else {
    const double half_angle = std::sqrt(half_squared);
    half_cosine = portable::cos(half_angle);
    half_sinc = portable::sin(half_angle) / half_angle;
  }
  const double scale = 0.5 * half_sinc;
  return {half_cosine, scale * turn.x(), scale * turn.y(), scale * turn.z()};
}

/// `orientation` turned further by the world-frame rotation vector `turn` [rad]. One Newton step
/// towards unit length undoes rounding, so that a unit quaternion stays one for ever.
[[nodiscard]] inline Quaternion turned(const Quaternion& orientation, const Vector3& turn) {
  const Quaternion a = rotation_by(turn);
  const Quaternion& b = orientation;
  const double w = a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z();
  const double x = a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y();
  const double y = a.w() * b.y() + a.y() * b.w() + a.z() * b.x() - a.x() * b.z();
  const double z = a.w() * b.z() + a.z() * b.w() + a.x() * b.y() - a.y() * b.x();
  const double scale = 1.5 - 0.5 * (w * w + x * x + y * y + z * z);
  return {scale * w, scale * x, scale * y, scale * z};
}

/// Some unit vector perpendicular to the unit vector `direction`; a continuous choice is
/// impossible, so callers must not depend on which one.
[[nodiscard]] inline Vector3 any_perpendicular(const Vector3& direction) {
  const Vector3 helper = std::abs(direction.x()) < 0.6 ? Vector3::UnitX() : Vector3::UnitY();
  return direction.cross(helper).normalized();
}

}  // namespace sheave
