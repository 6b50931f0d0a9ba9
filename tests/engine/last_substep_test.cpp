#include <gtest/gtest.h>

#include "engine/constraint_batch.h"
#include "engine/world.h"
#include "tests/support/builders.h"

namespace sheave::test {
namespace {

/// A pendulum that turns in the plane, on a hinge.
Machine pendulum(IntegratorKind integrator, int substeps) {
  Machine machine = Atwood{}.machine();
  machine.model.step = settings(1.0 / 60.0, substeps, 10);
  machine.model.step.solver = SolverKind::direct;
  machine.model.step.integrator = integrator;
  return machine;
}

TEST(LastSubstep, ExistsOnlyAfterAStep) {
  Simulation simulation = start(pendulum(IntegratorKind::xpbd, 2));
  World& world = simulation.world;
  EXPECT_FALSE(world.last_substep().has_value());
  const State begin = world.state();
  ASSERT_TRUE(world.step().ok());
  ASSERT_TRUE(world.last_substep().has_value());
  EXPECT_EQ(world.last_substep()->integrator, IntegratorKind::xpbd);
  EXPECT_TRUE(world.last_substep()->late_forces.empty());
  ASSERT_TRUE(world.restore(begin).empty());
  EXPECT_FALSE(world.last_substep().has_value());
}

TEST(LastSubstep, BeginsWhereTheSubstepBeforeEnded) {
  Simulation simulation = start(pendulum(IntegratorKind::rattle, 1));
  World& world = simulation.world;
  for (int i = 0; i < 5; ++i) {
    const State before = world.state();
    ASSERT_TRUE(world.step().ok());
    const auto last = world.last_substep();
    ASSERT_TRUE(last.has_value());
    EXPECT_EQ(hash(last->start), hash(before));
    EXPECT_DOUBLE_EQ(last->h, 1.0 / 60.0);
    EXPECT_EQ(last->integrator, IntegratorKind::rattle);
  }
}

TEST(LastSubstep, IsAPartOfItsStep) {
  Simulation simulation = start(pendulum(IntegratorKind::rattle, 4));
  World& world = simulation.world;
  ASSERT_TRUE(world.step().ok());
  EXPECT_DOUBLE_EQ(world.last_substep()->h, 1.0 / 240.0);
  EXPECT_DOUBLE_EQ(world.last_substep()->start.time, 3.0 / 240.0);
}

// Atwood's machine has the same force at any time: `rattle` does half of it at the start and half
// at the end of a substep.
TEST(LastSubstep, HalvesOfASteadyForceAreEqual) {
  Simulation simulation = start(pendulum(IntegratorKind::rattle, 1));
  World& world = simulation.world;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(world.step().ok());
  const auto last = world.last_substep();
  ASSERT_EQ(last->late_forces.size(), world.features().size());
  const std::vector<double>& late = last->late_forces.back();
  ASSERT_EQ(late.size(), 2U);
  const std::vector<CableReport> reports = simulation.cable_reports();
  for (std::size_t k = 0; k < late.size(); ++k) {
    EXPECT_NEAR(late[k], 0.5 * reports[0].spans[k].tension, 1e-8 * late[k]);
  }
}

}  // namespace
}  // namespace sheave::test
