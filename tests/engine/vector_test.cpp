#include "engine/vector.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/rounding.h"

namespace sheave {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
using Exact = long double;  // 11 more bits: its own rounding does not count here

const std::vector<Vector3> axes{
    Vector3::UnitX(),
    -Vector3::UnitY(),
    Vector3::UnitZ(),
    Vector3(1.0, 2.0, -3.0).normalized(),
    Vector3(-1.0, 1e-6, 0.3).normalized(),
};

Eigen::Quaternion<Exact> reference(const Vector3& turn) {
  const Eigen::Matrix<Exact, 3, 1> exact = turn.cast<Exact>();
  return Eigen::Quaternion<Exact>(Eigen::AngleAxis<Exact>(exact.norm(), exact.normalized()));
}

/// Angles [rad] over the whole range, densely about the switch from series to library functions.
std::vector<double> angles() {
  std::vector<double> result{0.19999, 0.2 - 1e-15, 0.2, 0.2 + 1e-15, 0.20001, pi, 2.0 * pi};
  for (double angle = 1e-12; angle < 100.0; angle *= 1.07) {
    result.push_back(angle);
  }
  result.push_back(100.0);
  return result;
}

TEST(RotationBy, AgreesWithAngleAxisFromTinyToManyTurns) {
  for (const Vector3& axis : axes) {
    for (const double angle : angles()) {
      const Vector3 turn = angle * axis;
      const Quaternion q = rotation_by(turn);
      const Eigen::Quaternion<Exact> exact = reference(turn);
      // The squared norm is a sum of three products, so the half angle is known to 2 epsilon
      // relative; sine and cosine pass that on as 2 epsilon (half angle) and add a rounding or two
      // of their own.
      const double tolerance = epsilon * (2.0 + angle);
      EXPECT_NEAR(static_cast<double>(q.w() - exact.w()), 0.0, tolerance) << angle;
      const Eigen::Matrix<Exact, 3, 1> error = q.vec().cast<Exact>() - exact.vec();
      EXPECT_LE(static_cast<double>(error.norm()), tolerance) << angle;
    }
  }
}

TEST(RotationBy, SeriesIsExactToTheLastBits) {
  // Below the switch the vector part is turn / 2 (1 - t / 6 ...): relative, not only absolute,
  // accuracy. Rounding: t to 2 epsilon but weighted by t / 6 < 0.002, one for the bracket, one for
  // the factor 0.5, one for each component. The first series term left out is t^6 / 13! < 2e-22.
  for (const Vector3& axis : axes) {
    for (const double angle : angles()) {
      if (angle >= 0.2) continue;
      const Vector3 turn = angle * axis;
      const Quaternion q = rotation_by(turn);
      const Eigen::Quaternion<Exact> exact = reference(turn);
      const Eigen::Matrix<Exact, 3, 1> error = q.vec().cast<Exact>() - exact.vec();
      EXPECT_LE(static_cast<double>(error.norm() / exact.vec().norm()), 2.0 * epsilon) << angle;
      EXPECT_LE(std::abs(static_cast<double>(q.w() - exact.w())), epsilon) << angle;
    }
  }
}

TEST(RotationBy, IsContinuousAcrossTheSwitch) {
  const Quaternion below = rotation_by(Vector3(std::nextafter(0.2, 0.0), 0.0, 0.0));
  const Quaternion above = rotation_by(Vector3(std::nextafter(0.2, 1.0), 0.0, 0.0));
  // Two neighbours of 0.2 differ by 2^-54 each way; either branch may round twice.
  EXPECT_LE((below.coeffs() - above.coeffs()).norm(), 3.0 * epsilon);
}

TEST(RotationBy, NoTurnIsTheIdentity) {
  EXPECT_EQ(rotation_by(Vector3::Zero()).coeffs(), Quaternion::Identity().coeffs());
}

TEST(RotationBy, TurnsCounterClockwiseAboutItsAxis) {
  // Independent of quaternion conventions: 90 degrees about z take x to y. pi/2 is rounded, and the
  // matrix of q adds products of two components with 1 ulp each.
  const Vector3 turned_x = rotation_by(Vector3(0.0, 0.0, 0.5 * pi)) * Vector3(Vector3::UnitX());
  EXPECT_LE((turned_x - Vector3::UnitY()).norm(), 8.0 * epsilon);
}

TEST(Turned, AppliesTheTurnInTheWorldFrame) {
  const Quaternion start = rotation_by(Vector3(0.3, -0.7, 1.1));
  const Vector3 turn(0.0, 0.0, 0.25);
  const Vector3 point(1.0, 2.0, 3.0);
  const Vector3 expected = rotation_by(turn) * (start * point);
  // Length 3.7, two rotations of some ten roundings each.
  EXPECT_LE((turned(start, turn) * point - expected).norm(), 40.0 * epsilon);
  const Vector3 in_body_frame = start * (rotation_by(turn) * point);
  EXPECT_GE((in_body_frame - expected).norm(), 0.1) << "this test could not tell the frames apart";
}

TEST(Turned, StaysAUnitQuaternionOverAMillionTurns) {
  // Each step multiplies two quaternions (norm error: some epsilon, the components' roundings) and
  // then makes one Newton step, which squares that error; what stays is the rounding of the last
  // product, half an ulp in each of four components: 0.5 epsilon sqrt(4) at most. Without the
  // Newton step the error would be a random walk, some 1e3 epsilon by the end.
  Quaternion q = rotation_by(Vector3(0.1, 0.2, 0.3));
  const Vector3 turn(0.011, -0.007, 0.013);
  double worst = 0.0;
  for (int step = 0; step < 1'000'000; ++step) {
    q = turned(q, turn);
    worst = std::max(worst, std::abs(q.norm() - 1.0));
  }
  EXPECT_LE(worst, 2.0 * epsilon);
  // And it arrives where one large turn leads: the angle errors add up, at most 4 epsilon per step.
  const Eigen::Quaternion<Exact> start = reference(Vector3(0.1, 0.2, 0.3));
  const Eigen::Matrix<Exact, 3, 1> step = turn.cast<Exact>();
  const Eigen::Quaternion<Exact> whole(
      Eigen::AngleAxis<Exact>(1e6L * step.norm(), step.normalized()));
  const Eigen::Quaternion<Exact> apart = (whole * start).conjugate() * q.cast<Exact>();
  EXPECT_LE(static_cast<double>(apart.vec().norm()), 4e6 * epsilon);
}

TEST(Turned, RepairsALengthErrorQuadratically) {
  // f(n) = n (1.5 - 0.5 n^2) = 1 - 1.5 d^2 - 0.5 d^3 at n = 1 + d.
  Quaternion q = Quaternion::Identity();
  q.coeffs() *= 1.0 + 1e-4;
  const double length = turned(q, Vector3(0.0, 0.0, 0.1)).norm();
  EXPECT_NEAR(length, 1.0 - 1.5e-8 - 0.5e-12, 4.0 * epsilon);
}

TEST(AnyPerpendicular, IsAUnitVectorAtRightAngles) {
  std::vector<Vector3> directions = axes;
  directions.push_back(Vector3(0.6, 0.8, 0.0));
  directions.push_back(Vector3(0.59999999, 0.8, 0.0).normalized());
  directions.push_back(Vector3(1.0, 1.0, 0.0).normalized());
  for (const Vector3& direction : directions) {
    const Vector3 other = any_perpendicular(direction);
    EXPECT_NEAR(other.norm(), 1.0, 2.0 * epsilon);
    // The cross product is at least 0.6 long, so normalising magnifies its rounding by under 2.
    EXPECT_NEAR(other.dot(direction), 0.0, 4.0 * epsilon);
  }
}

TEST(Vectors, HaveNoExtraAlignment) {
  // The public structs must have one layout whatever instruction set a program is compiled for.
  EXPECT_EQ(sizeof(Vector3), 3 * sizeof(double));
  EXPECT_EQ(sizeof(Quaternion), 4 * sizeof(double));
  EXPECT_EQ(alignof(Vector3), alignof(double));
  EXPECT_EQ(alignof(Quaternion), alignof(double));
  EXPECT_EQ(alignof(Matrix3), alignof(double));
}

}  // namespace
}  // namespace sheave
