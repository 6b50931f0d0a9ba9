// The guess of the next motion (engine/motion_history.h) takes no round more and changes no result.

#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "engine/joints/ball.h"
#include "engine/joints/hinge.h"
#include "engine/world.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

/// Two rods that hang from each other and swing, on hinges in a plane or on ball joints in space,
/// which have `friction` [N m].
Model double_pendulum(bool in_space, IntegratorKind integrator, double friction = 0.0) {
  Model model;
  model.gravity = Vector3(0.0, -9.81, 0.0);
  model.step = test::settings(1.0 / 240.0, 1, 50);
  model.step.solver = SolverKind::direct;
  model.step.integrator = integrator;
  BodyId above;
  for (int i = 0; i < 2; ++i) {
    BodyDef rod = test::lump("rod" + std::to_string(i), {0.5 + i, 0.0, 0.0}, 1.0);
    if (!in_space) {
      rod.mobility = Mobility::planar;
      rod.axis = Vector3(0.0, 0.0, 1.0);
    } else if (i == 1) {
      rod.angular_velocity = Vector3(2.0, 0.0, 0.0);
    }
    const BodyId id = model.add(rod);
    const BodyId carrier = i == 0 ? BodyId::world() : above;
    if (in_space) {
      auto joint = std::make_shared<BallJoint>();
      joint->name = "joint" + std::to_string(i);
      joint->anchor = Vector3(i, 0.0, 0.0);
      joint->body_a = carrier;
      joint->body_b = id;
      joint->friction = friction;
      model.joints.push_back(joint);
    } else {
      auto joint = std::make_shared<HingeJoint>();
      joint->name = "joint" + std::to_string(i);
      joint->anchor = Vector3(i, 0.0, 0.0);
      joint->axis = Vector3(0.0, 0.0, 1.0);
      joint->body_a = carrier;
      joint->body_b = id;
      model.joints.push_back(joint);
    }
    above = id;
  }
  return model;
}

struct Swing {
  State state;
  std::int64_t rounds = 0;
};

Swing swing(const Model& model, int steps, bool guesses) {
  Result<World> world = World::create(model);
  EXPECT_TRUE(world) << test::text(world.errors());
  Swing result;
  for (int i = 0; i < steps; ++i) {
    if (!guesses) {
      State plain = world->state();
      plain.history = {};
      EXPECT_TRUE(world->restore(plain).empty());
    }
    const StepReport report = world->step();
    EXPECT_TRUE(report.ok());
    result.rounds += report.statistics.rounds;
  }
  result.state = world->state();
  return result;
}

class MotionGuess : public testing::TestWithParam<std::tuple<bool, IntegratorKind>> {};

TEST_P(MotionGuess, TakesNoMoreRoundsAndChangesNoResult) {
  const auto [in_space, integrator] = GetParam();
  const Model model = double_pendulum(in_space, integrator);
  constexpr int steps = 120;
  const Swing with = swing(model, steps, true);
  const Swing without = swing(model, steps, false);
  // One round of xpbd, and with rattle another one for the velocities, but for the first substeps,
  // which know nothing.
  const int least = integrator == IntegratorKind::xpbd ? 1 : 2;
  EXPECT_LE(static_cast<double>(with.rounds), 1.1 * least * steps);
  EXPECT_LE(with.rounds, without.rounds);
  // Each substep leaves at most 1e-12 of the scene's size of 2 m as a residual, as a velocity of
  // 5e-10 m/s at 240 Hz. A swing of half a second, in which errors double at most every 0.1 s,
  // adds up 120 of these to less than 2e-6 m/s times their random signs; they are far smaller.
  for (std::size_t b = 0; b < with.state.bodies.size(); ++b) {
    const BodyState& own = with.state.bodies[b];
    const BodyState& other = without.state.bodies[b];
    EXPECT_LT((own.position - other.position).norm(), 1e-9) << b;
    EXPECT_LT((own.velocity - other.velocity).norm(), 1e-7) << b;
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, MotionGuess,
                         testing::Combine(testing::Bool(),
                                          testing::Values(IntegratorKind::xpbd,
                                                          IntegratorKind::rattle)));

/// Rows with friction are looked at a second time in any case. By the backward rule the guess still
/// saves rounds of Newton's method.
TEST(MotionGuess, SavesRoundsOfFriction) {
  const Model model = double_pendulum(true, IntegratorKind::xpbd, 0.5);
  constexpr int steps = 120;
  const Swing with = swing(model, steps, true);
  const Swing without = swing(model, steps, false);
  EXPECT_LT(static_cast<double>(with.rounds), 0.8 * static_cast<double>(without.rounds));
  // The last look leaves at most 1e-10 of the scene's size of 2 m, which is 2e-10 m and 5e-8 m/s in
  // each of the 120 substeps. If errors have random signs, their sum is 11 times as large.
  for (std::size_t b = 0; b < with.state.bodies.size(); ++b) {
    const BodyState& own = with.state.bodies[b];
    const BodyState& other = without.state.bodies[b];
    EXPECT_LT((own.position - other.position).norm(), 1e-8) << b;
    EXPECT_LT((own.velocity - other.velocity).norm(), 5e-7) << b;
  }
}

/// Sweeps keep no history, so one of the direct solver would be as old as the run.
TEST(MotionGuess, HistoryOfTheDirectSolverIsNotForSweeps) {
  Model model = double_pendulum(false, IntegratorKind::rattle);
  State with = swing(model, 20, true).state;
  ASSERT_GE(with.history.order, 0) << "nothing would be guessed";
  model.step.solver = SolverKind::gauss_seidel;
  State without = with;
  without.history = {};
  std::vector<State> ends;
  for (const State& start : {with, without}) {
    Result<World> world = World::create(model);
    ASSERT_TRUE(world) << test::text(world.errors());
    State own = start;
    own.layout = world->state().layout;
    ASSERT_TRUE(world->restore(own).empty());
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(world->step().ok());
    ends.push_back(world->state());
  }
  for (std::size_t b = 0; b < ends[0].bodies.size(); ++b) {
    EXPECT_EQ(ends[0].bodies[b].position, ends[1].bodies[b].position) << b;
    EXPECT_EQ(ends[0].bodies[b].velocity, ends[1].bodies[b].velocity) << b;
  }
}

}  // namespace
}  // namespace sheave
