// Dry friction on what a rigid drive holds through a rope: while all stands still, three rows say
// the same and the share of friction is anything within its limit. The direct solver must choose
// one and not go round between them.
//
// A weight of 100 kg with dry friction of 50 N in its guide hangs on a drum whose drive lifts it,
// slows down and stops.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/joint_report.h"
#include "engine/joints/hinge.h"
#include "engine/joints/slider.h"
#include "tests/support/builders.h"
#include "tests/support/friction_links.h"

namespace sheave {
namespace {

constexpr double guide_friction = 50.0;
constexpr double hoisted_mass = 100.0;
constexpr double drum_radius = 0.4;

test::Machine hoist(IntegratorKind integrator) {
  test::Machine machine;
  Model& model = machine.model;
  model.gravity = test::down;
  model.step = test::settings(1.0 / 60.0, 1, 10);
  model.step.solver = SolverKind::direct;
  model.step.integrator = integrator;
  const BodyId load = model.add(test::lump("load", {-drum_radius, -2.0, 0.0}, hoisted_mass));
  const BodyId drum = model.add(test::wheel("drum", Vector3::Zero(), drum_radius, 0.8));
  auto guide = std::make_shared<SliderJoint>();
  guide->name = "guide";
  guide->body_b = load;
  guide->anchor = {-drum_radius, -2.0, 0.0};
  guide->axis = Vector3::UnitY();
  guide->travel.friction = guide_friction;
  auto motor = std::make_shared<HingeJoint>();
  motor->name = "motor";
  motor->body_b = drum;
  motor->axis = -Vector3::UnitZ();
  motor->angle.drive = CoordinateDrive::speed;
  motor->angle.drive_times = {0.0, 0.5, 1.0};
  motor->angle.drive_values = {0.0, 1.0, 0.0};
  model.joints = {guide, motor};
  auto spool = test::roll(drum, test::right);
  spool->stored_length = 1.0;
  machine.cables.push_back(test::cable("rope", {test::attach(load), spool}));
  return machine;
}

class RedundantFriction : public testing::TestWithParam<IntegratorKind> {};

TEST_P(RedundantFriction, FindsASetOfRowsMovingAndAtRest) {
  Simulation s = test::start(hoist(GetParam()));
  std::int64_t fallbacks = 0;
  while (s.world.state().time < 2.0) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    fallbacks += report.statistics.solver_fallbacks;
    const double rope = s.cable_reports()[0].spans[0].tension;
    const double guide = joint_reports(s.world)[0].force.y();
    // Rounding of forces of 1000 N.
    EXPECT_LE(std::abs(guide), guide_friction + 1e-9);
    if (s.world.state().time > 0.6 && s.world.state().time < 0.95) {
      // It rises ever slower, by 2 rad/s2 x 0.4 m.
      EXPECT_NEAR(guide, -guide_friction, 1e-6);
      EXPECT_NEAR(rope, hoisted_mass * (test::g - 2.0 * drum_radius) + guide_friction, 1e-6);
    } else if (s.world.state().time > 1.1) {
      EXPECT_NEAR(rope + guide, hoisted_mass * test::g, 1e-6);
    }
  }
  EXPECT_EQ(fallbacks, 0);
  // Half a radian at 1 rad/s at most; then it stands. xpbd and rattle both follow the drive's
  // integral.
  EXPECT_NEAR(s.world.position({0}).y(), -2.0 + 0.5 * drum_radius, 1e-10);
  EXPECT_NEAR(s.world.velocity({0}).y(), 0.0, 1e-10);
}

// A rope from the world through a hole near the rim of a wheel and back to where it comes from, so
// both spans say the same. A torque M pulls the hole away: with the arm p, (T1 + T2) p = M. The
// rope is bent there by half a turn, so neither pull may be more than e^(m pi) times the other, in
// either half of a substep of `rattle`.
TEST_P(RedundantFriction, EqualSpansStayWithinTheConeInBothHalves) {
  constexpr double torque = 3.0;
  constexpr double friction = 0.01;
  test::Machine machine;
  machine.model.step = test::settings(1.0 / 100.0, 1, 20);
  machine.model.step.solver = SolverKind::direct;
  machine.model.step.integrator = GetParam();
  BodyDef wheel = test::wheel("wheel", Vector3::Zero(), 0.3, 0.05);
  wheel.torque = {0.0, 0.0, torque};
  const BodyId held = machine.model.add(wheel);
  const Vector3 hole{0.0, 0.2, 0.0};
  const Vector3 anchor{1.0, 0.5, 0.0};
  machine.cables.push_back(test::cable(
      "rope", {test::attach(BodyId::world(), anchor), test::eyelet(held, hole, friction),
               test::attach(BodyId::world(), anchor)}));
  Simulation s = test::start(machine);
  const double arm = std::abs(hole.cross(anchor - hole).z()) / (anchor - hole).norm();
  const double bound = std::exp(friction * pi) * (1.0 + 1e-6);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const std::vector<double> pulls = test::tensions(s.cable_reports()[0]);
    std::vector<double> late{0.0, 0.0};
    if (GetParam() == IntegratorKind::rattle) {
      late = s.world.last_substep()->late_forces.back();
      ASSERT_GE(late.size(), 2U);
      EXPECT_LE(late[0], bound * late[1]);
      EXPECT_LE(late[1], bound * late[0]);
    }
    EXPECT_NEAR((pulls[0] + pulls[1]) * arm, torque, 1e-6 * torque);
    EXPECT_LE(pulls[0] - late[0], bound * (pulls[1] - late[1]));
    EXPECT_LE(pulls[1] - late[1], bound * (pulls[0] - late[0]));
  }
  EXPECT_NEAR(s.world.angular_velocity(held).z(), 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Integrators, RedundantFriction,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle));

}  // namespace
}  // namespace sheave
