// Rigid ropes of which fewer would do: how they share a load.
//
// A board of mass m and inertia I hangs on three vertical ropes at x_i. Two equations of statics,
// sum T_i = m g and sum x_i T_i = 0, leave one of the three open. Rigid ropes share the load as
// springs do that are as stiff as what they hold is light (engine/solvers/row_sharing.cpp): with
// W_i = 1 / m + x_i^2 / I, what a unit of T_i moves its end by, W_i T_i = a + b x_i, as the board
// goes down by a and turns by b.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;

struct Board {
  static constexpr double mass = 3.0;
  static constexpr double inertia = 0.4;
  static constexpr std::array places{-0.5, 0.15, 0.45};
  static double yield_at(double x) { return 1.0 / mass + x * x / inertia; }
};

/// The tensions above.
std::array<double, 3> closed_form() {
  double sum = 0.0;  // of 1 / W
  double first = 0.0;
  double second = 0.0;
  for (const double x : Board::places) {
    sum += 1.0 / Board::yield_at(x);
    first += x / Board::yield_at(x);
    second += x * x / Board::yield_at(x);
  }
  const double a = Board::mass * g * second / (sum * second - first * first);
  const double b = -a * first / second;
  std::array<double, 3> tensions{};
  for (std::size_t i = 0; i < 3; ++i)
    tensions[i] = (a + b * Board::places[i]) / Board::yield_at(Board::places[i]);
  return tensions;
}

/// `compliance`: of each rope, per W_i [s2].
test::Machine board(IntegratorKind integrator, double compliance) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(integrator, 0.01, 2);
  BodyDef body = test::lump("board", Vector3::Zero(), Board::mass);
  body.inertia = Vector3::Constant(Board::inertia);
  body.mobility = Mobility::planar;
  body.axis = Vector3::UnitZ();
  const BodyId hung = m.model.add(body);
  for (const double x : Board::places) {
    CableDef rope = cable("rope " + std::to_string(m.cables.size()),
                          {attach(hung, {x, 0.0, 0.0}), attach(BodyId::world(), {x, 2.0, 0.0})});
    rope.compliance = compliance * Board::yield_at(x);
    // Critical.
    if (compliance > 0.0) rope.damping = 2.0 * std::sqrt(compliance) / *rope.compliance;
    m.cables.push_back(rope);
  }
  return m;
}

/// Beside it, a bead of a milligram in a rope that carries 100 kg.
void add_bead_under_load(test::Machine& m) {
  const BodyId bead = m.model.add(test::lump("bead", {5.0, 0.0, 0.0}, 1e-6));
  const BodyId load = m.model.add(test::lump("load", {5.0, -1.0, 0.0}, 100.0));
  m.cables.push_back(cable("upper", {attach(BodyId::world(), {5.0, 1.0, 0.0}), attach(bead)}));
  m.cables.push_back(cable("lower", {attach(bead), attach(load)}));
}

class SharedLoad : public testing::TestWithParam<IntegratorKind> {};

TEST_P(SharedLoad, OfRigidRopesFollowsEffectiveInverseMasses) {
  const std::array<double, 3> expected = closed_form();
  double sum = 0.0;
  for (const double tension : expected) {
    ASSERT_GT(tension, 2.0);
    sum += tension;
  }
  ASSERT_NEAR(sum, Board::mass * g, 1e-12);
  Simulation s = test::start(board(GetParam(), 0.0));
  test::run(s.world, 0.5);
  for (std::size_t i = 0; i < 3; ++i) {
    // Lengths are rounded to 1e-16 m, of ropes that yield by 1e-9 W h^2, some 1e-14 m/N.
    EXPECT_NEAR(s.cable_reports()[i].spans[0].tension, expected[i], 0.01) << i;
  }
  EXPECT_TRUE(s.certificate()->clean());
}

TEST_P(SharedLoad, OfElasticRopesFollowsTheirCompliances) {
  // With 1e-4 s^2 all that the ropes do has the angular frequency 100 / s: it is over in a second.
  Simulation s = test::start(board(GetParam(), 1e-4));
  test::run(s.world, 1.0);
  const std::array<double, 3> expected = closed_form();
  for (std::size_t i = 0; i < 3; ++i) {
    // The board has turned by 5e-4, and its arms are shorter by a part of the square of that.
    EXPECT_NEAR(s.cable_reports()[i].spans[0].tension, expected[i], 1e-4) << i;
  }
}

// A middle rope that is too long by 1e-7 m carries nothing, and the others what is left by the law
// of the lever, whatever hangs beside them: what rows may be off by and still agree was measured by
// what moved most in the whole machine, and a bead that yields easily hid the gap.
TEST_P(SharedLoad, LeavesOutARopeThatIsTooLong) {
  for (const bool beside : {false, true}) {
    test::Machine m = board(GetParam(), 0.0);
    m.model.step = test::direct_settings(GetParam(), 0.0005);
    m.model.bodies[0].velocity = {0.0, -0.1, 0.0};
    m.cables[1].rest_lengths = {2.0 + 1e-7};
    if (beside) add_bead_under_load(m);
    Simulation s = test::start(m);
    test::run(s.world, 0.1);
    const double load = Board::mass * g;
    const double length = Board::places[2] - Board::places[0];
    const std::vector<CableReport> ropes = s.cable_reports();
    EXPECT_NEAR(ropes[0].spans[0].tension, load * Board::places[2] / length, 1e-3) << beside;
    EXPECT_EQ(ropes[1].spans[0].tension, 0.0) << beside;
    EXPECT_NEAR(ropes[2].spans[0].tension, -load * Board::places[0] / length, 1e-3) << beside;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, SharedLoad,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle));

}  // namespace
}  // namespace sheave
