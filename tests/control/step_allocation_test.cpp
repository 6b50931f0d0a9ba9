// A step in the steady state allocates no memory: what it needs is there from the steps before.

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "scenes/control/scene_supervisor.h"
#include "scenes/generators.h"
#include "scenes/scene.h"
#include "tests/control/allocation_count.h"
#include "tests/support/builders.h"

namespace sheave::step_allocation {
namespace {

/// In steps after the first ones.
std::int64_t allocations_in(Scene scene, IntegratorKind integrator) {
  scene.model.step.solver = SolverKind::direct;
  scene.model.step.integrator = integrator;
  scene.model.step.iterations = 50;
  Result<Simulation> simulation = create_simulation(scene);
  if (!simulation) throw std::runtime_error(test::text(simulation.errors()));
  constexpr int first = 20;
  constexpr int measured = 20;
  for (int i = 0; i < first; ++i) EXPECT_TRUE(simulation->world.step().ok());
  const std::int64_t before = test::allocation_count();
  for (int i = 0; i < measured; ++i) EXPECT_TRUE(simulation->world.step().ok());
  return test::allocation_count() - before;
}

Scene paper_scene(const std::string& name) {
  SceneResult scene = load_scene(std::string(SHEAVE_SOURCE_DIR) + "/scenes/paper/" + name);
  if (!scene) throw std::runtime_error(name);
  return *scene;
}

class StepAllocation : public testing::TestWithParam<IntegratorKind> {};

TEST_P(StepAllocation, IsZeroIfNoDirectionTurns) {
  WheelTrainOptions train;
  train.wheels = 64;
  EXPECT_EQ(allocations_in(*generate_wheel_train(train), GetParam()), 0);
  for (const char* name : {"pulley.json", "hilbert3.json", "hilbert2-loose.json"}) {
    EXPECT_EQ(allocations_in(paper_scene(name), GetParam()), 0) << name;
  }
}

TEST_P(StepAllocation, IsZeroForAFreeBody) {
  Scene scene;
  scene.model.bodies.push_back(test::lump("body", Vector3::Zero(), 1.0));
  EXPECT_EQ(allocations_in(scene, GetParam()), 0);
}

INSTANTIATE_TEST_SUITE_P(Integrators, StepAllocation,
                         testing::Values(IntegratorKind::xpbd, IntegratorKind::rattle));

}  // namespace
}  // namespace sheave::step_allocation
