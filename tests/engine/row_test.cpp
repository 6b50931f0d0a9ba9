// One row on its own: the XPBD update of engine/row.h against its closed form.

#include "engine/row.h"

#include <gtest/gtest.h>

namespace sheave {
namespace {

MovingBody point_mass(double mass) {
  MovingBody body;
  body.inverse_mass = Matrix3::Identity() / mass;
  body.translates = true;
  return body;
}

Row pull(double value) {
  Row row;
  row.value = value;
  row.add(0, Vector3::UnitX(), Vector3::Zero());
  row.add(1, -Vector3::UnitX(), Vector3::Zero());
  return row;
}

TEST(SolveRow, RigidRowIsSolvedInOneStepAndSharesByInverseMass) {
  std::array<MovingBody, 2> bodies{point_mass(1.0), point_mass(3.0)};
  double multiplier = 0.0;
  // w = 1 + 1/3; the light body moves three times as far.
  EXPECT_DOUBLE_EQ(solve_row(pull(-0.4), 0.01, multiplier, bodies), 0.4);
  EXPECT_DOUBLE_EQ(multiplier, 0.3);
  EXPECT_DOUBLE_EQ(bodies[0].position.x(), 0.3);
  EXPECT_DOUBLE_EQ(bodies[1].position.x(), -0.1);
}

TEST(SolveRow, CompliantRowStopsWhereTheSpringBalances) {
  // l = -C0 / (w + a/h^2), and a second step at the new value changes nothing.
  std::array<MovingBody, 2> bodies{point_mass(1.0), point_mass(3.0)};
  constexpr double h = 0.1;
  constexpr double compliance = 0.02;
  Row row = pull(-0.4);
  row.compliance = compliance;
  double multiplier = 0.0;
  solve_row(row, h, multiplier, bodies);
  EXPECT_DOUBLE_EQ(multiplier, 0.4 / (4.0 / 3.0 + compliance / (h * h)));
  row.value = -0.4 + bodies[0].position.x() - bodies[1].position.x();
  EXPECT_NEAR(row.value, -compliance / (h * h) * multiplier, 1e-16);
  const double before = multiplier;
  solve_row(row, h, multiplier, bodies);
  EXPECT_NEAR(multiplier, before, 1e-15);
}

TEST(SolveRow, DampingFollowsTheImplicitDashpot) {
  // Implicit spring and dashpot of the elongation x = -C: h^2 f = l, f = x/a + b x'. With the row's
  // change D = grad C . dx over the substep, l (a/h^2) = -(C + a b D / h) at the solution.
  std::array<MovingBody, 2> bodies{point_mass(1.0), point_mass(3.0)};
  constexpr double h = 0.1;
  Row row = pull(-0.4);
  row.compliance = 0.02;
  row.damping = 7.0;
  // The prediction has already moved body 0 by -0.05.
  bodies[0].position.x() = -0.05;
  double multiplier = 0.0;
  solve_row(row, h, multiplier, bodies);
  const double moved = bodies[0].position.x() - bodies[1].position.x();
  const double value = -0.4 + (moved + 0.05);
  const double force = -value / 0.02 - 7.0 * moved / h;
  EXPECT_NEAR(multiplier / (h * h), force, 1e-12 * std::abs(force));
}

TEST(SolveRow, ClampsTheAccumulatedMultiplierNotTheIncrement) {
  std::array<MovingBody, 2> bodies{point_mass(1.0), point_mass(1.0)};
  Row row = pull(-0.4);
  row.lower = 0.0;
  double multiplier = 0.0;
  solve_row(row, 0.01, multiplier, bodies);
  EXPECT_DOUBLE_EQ(multiplier, 0.2);
  // Overshoot by another row: half of what was pulled has to be given back, and may be.
  row.value = 0.2;
  solve_row(row, 0.01, multiplier, bodies);
  EXPECT_DOUBLE_EQ(multiplier, 0.1);
  // But never more than was pulled.
  row.value = 5.0;
  solve_row(row, 0.01, multiplier, bodies);
  EXPECT_EQ(multiplier, 0.0);
  EXPECT_NEAR(bodies[0].position.x(), 0.0, 1e-16);
  EXPECT_EQ(solve_row(row, 0.01, multiplier, bodies), 0.0);
}

TEST(SolveRow, BetweenImmovableBodiesMovesNothing) {
  std::array<MovingBody, 2> bodies{};
  double multiplier = 0.0;
  EXPECT_EQ(solve_row(pull(-0.4), 0.01, multiplier, bodies), 0.0);
  EXPECT_EQ(multiplier, 0.0);
  Row soft = pull(-0.4);
  soft.compliance = 0.1;
  // A spring has its force all the same, 0.4 m / 0.1 m/N, whoever holds its ends.
  EXPECT_EQ(solve_row(soft, 0.01, multiplier, bodies), 0.4);
  EXPECT_NEAR(multiplier / (0.01 * 0.01), 4.0, 1e-12);
  EXPECT_EQ(solve_row(soft, 0.01, multiplier, bodies), 0.0);
  EXPECT_EQ(bodies[0].position, Vector3::Zero());
}

TEST(SolveRow, ScalesFromMicrogramsToMegatons) {
  for (const double mass : {1e-9, 1.0, 1e9}) {
    std::array<MovingBody, 2> bodies{point_mass(mass), point_mass(3.0 * mass)};
    double multiplier = 0.0;
    solve_row(pull(-0.4), 0.01, multiplier, bodies);
    EXPECT_NEAR(bodies[0].position.x(), 0.3, 1e-15);
    EXPECT_NEAR(multiplier, 0.3 * mass, 1e-15 * mass);
  }
}

TEST(Row, AddsContributionsToTheSameBody) {
  Row row;
  row.add(2, Vector3::UnitX(), Vector3::UnitY());
  row.add(2, Vector3::UnitX(), Vector3::UnitZ());
  ASSERT_EQ(row.term_count, 1);
  EXPECT_EQ(row.terms[0].linear, Vector3(2.0, 0.0, 0.0));
  EXPECT_EQ(row.terms[0].angular, Vector3(0.0, 1.0, 1.0));
  row.clear();
  EXPECT_EQ(row.term_count, 0);
}

/// Sweeps that turn a body to and fro about several axes and end where they began must leave it
/// where it was: its velocity follows from the sum of what was applied, and slender bodies under
/// large forces are turned by a radian at a time.
TEST(MovingBody, TurnsByTheSumOfItsCorrections) {
  MovingBody body;
  body.free_orientation = Quaternion(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  body.free_turn = {7.0, 0.0, 0.0};  // more than a turn in one substep
  body.orientation = body.free_orientation;
  body.turn = body.free_turn;
  const std::array<Vector3, 6> corrections{Vector3(0.9, 0.0, 0.0),  Vector3(0.0, 0.7, 0.0),
                                           Vector3(-0.9, 0.0, 0.0), Vector3(0.0, 0.0, 0.4),
                                           Vector3(0.0, -0.7, 0.0), Vector3(0.0, 0.0, -0.4)};
  for (const Vector3& correction : corrections) {
    body.rotate(correction);
    const Quaternion sum = turned(body.free_orientation, body.turn - body.free_turn);
    EXPECT_NEAR((body.orientation.coeffs() - sum.coeffs()).norm(), 0.0, 1e-15);
  }
  // Rounding of 7 + 0.9.
  EXPECT_NEAR((body.turn - body.free_turn).norm(), 0.0, 1e-14);
  EXPECT_NEAR((body.orientation.coeffs() - body.free_orientation.coeffs()).norm(), 0.0, 1e-14);
}

}  // namespace
}  // namespace sheave
