// Friction in several directions as one vector: engine/friction_rows.h.

#include "engine/friction_rows.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sheave {
namespace {

Matrix3 skewed_yield() {
  // Symmetric and positive definite: 4 > 1 and 4 * 3 - 1 > 0, and the third is apart.
  Matrix3 yield;
  yield << 4.0, 1.0, 0.0, 1.0, 3.0, 0.5, 0.0, 0.5, 2.0;
  return yield;
}

TEST(HoldWithin, HoldsForcesWithinTheBound) {
  const Vector3 force(0.3, -0.2, 0.4);
  const Vector3 found = hold_within(skewed_yield(), skewed_yield() * force, 1.0);
  EXPECT_NEAR((found - force).norm(), 0.0, 1e-12);
}

TEST(HoldWithin, BeyondItSlipsAgainstTheForceThatHasTheBound) {
  const Matrix3 yield = skewed_yield();
  for (const Vector3& wanted :
       {Vector3(5.0, 0.0, 0.0), Vector3(4.0, -7.0, 3.0), Vector3(0.0, 0.0, 1000.0)}) {
    for (const double bound : {0.01, 0.5, 1.0}) {
      const Vector3 force = hold_within(yield, wanted, bound);
      const Vector3 slip = yield * force - wanted;
      EXPECT_NEAR(force.norm(), bound, 1e-14);
      EXPECT_NEAR((slip.normalized() + force / bound).norm(), 0.0, 1e-9) << wanted.transpose();
    }
  }
}

TEST(HoldWithin, OpposesSlipAlongDirectionsWithoutYield) {
  // Along z nothing yields, and something else moves it: friction is against all of the slip.
  Matrix3 yield = Matrix3::Identity();
  yield(2, 2) = 0.0;
  const Vector3 wanted(3.0, 0.0, 4.0);
  const Vector3 force = hold_within(yield, wanted, 1.0);
  const Vector3 slip = yield * force - wanted;
  EXPECT_NEAR((slip.normalized() + force).norm(), 0.0, 1e-9);
  EXPECT_EQ(hold_within(yield, wanted, 0.0), Vector3::Zero());
}

TEST(SolveFriction, MovesABodyBackAsFarAsTheBoundAllows) {
  const Vector3 slip(0.3, 0.4, 0.0);
  for (const double bound : {10.0, 0.6}) {
    std::array<MovingBody, 1> bodies;
    bodies[0].inverse_mass = 0.5 * Matrix3::Identity();
    bodies[0].translates = true;
    bodies[0].position = slip;
    std::array<Row, 2> rows;
    for (int k = 0; k < 2; ++k) {
      Row& row = rows[static_cast<std::size_t>(k)];
      row.value = slip[k];
      row.upper = bound;
      row.lower = -bound;
      row.add(0, Vector3::Unit(k), Vector3::Zero());
    }
    std::array<double, 2> multipliers{};
    const double moved = solve_friction(rows, multipliers, bodies);
    // w = 1 / 2: to hold it takes 1 in all.
    const double force = std::min(bound, 1.0);
    EXPECT_NEAR(moved, 0.5 * force, 1e-13);
    EXPECT_NEAR(multipliers[0], -0.6 * force, 1e-13);
    EXPECT_NEAR(multipliers[1], -0.8 * force, 1e-13);
    EXPECT_NEAR((bodies[0].position - (1.0 - force) * slip).norm(), 0.0, 1e-13);
  }
}

}  // namespace
}  // namespace sheave
