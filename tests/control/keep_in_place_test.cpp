// States that are looked at where they lie (World::keep_in_place), and settings that are told by
// names (LiveWorld::set_in_simulation).

#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/control/control_point.h"
#include "tests/support/builders.h"
#include "tests/support/live.h"

namespace sheave {
namespace {

using test::live;
using testing::HasSubstr;

/// Where the numbers lie that are looked at.
struct Place {
  const BodyState* bodies = nullptr;
  const double* cables = nullptr;
  bool operator==(const Place&) const = default;
};
Place place_of(const State& state) {
  return {state.bodies.data(), state.features.back().reals.data()};
}

test::Machine with(test::Machine machine, SolverKind solver, IntegratorKind integrator,
                   int substeps) {
  machine.model.step = {0.01, substeps, 10, solver, integrator};
  return machine;
}

/// Motion that is evaluated without bodies (affine), by rounds, by sweeps; one and several substeps.
std::vector<test::Machine> machines() {
  std::vector<test::Machine> all;
  for (const int substeps : {1, 2, 3}) {
    for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
      for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
        all.push_back(with(test::Atwood{}.machine(), solver, integrator, substeps));
        all.push_back(with(test::cable_pendulum(1.0, 2.0, 0.5), solver, integrator, substeps));
      }
    }
  }
  return all;
}

TEST(KeepInPlace, TheStateStaysAtItsAddressWithTheSameBits) {
  for (const test::Machine& machine : machines()) {
    Simulation kept = test::start(machine);
    Simulation plain = test::start(machine);
    kept.world.keep_in_place();
    const Place place = place_of(kept.world.state());
    const State first = kept.world.state();
    for (int i = 0; i < 20; ++i) {
      if (i == 7) kept.world.keep_in_place();  // once more is no other place
      if (i == 12) {
        ASSERT_TRUE(kept.world.restore(first).empty());
        ASSERT_TRUE(plain.world.restore(first).empty());
        ASSERT_EQ(place_of(kept.world.state()), place);
      }
      ASSERT_TRUE(kept.step().ok());
      ASSERT_TRUE(plain.step().ok());
      ASSERT_EQ(place_of(kept.world.state()), place) << "step " << i;
      ASSERT_EQ(hash(kept.world.state()), hash(plain.world.state())) << "step " << i;
    }
  }
}

/// What the promise is for: without it there is a machine whose numbers move.
TEST(KeepInPlace, WithoutTheCallTheStateMoves) {
  std::size_t most = 0;
  for (const test::Machine& machine : machines()) {
    Simulation plain = test::start(machine);
    std::set<const BodyState*> places;
    for (int i = 0; i < 4; ++i) {
      places.insert(place_of(plain.world.state()).bodies);
      ASSERT_TRUE(plain.step().ok());
    }
    most = std::max(most, places.size());
  }
  EXPECT_GT(most, 1U);
}

TEST(KeepInPlace, AStoppedStepKeepsTheAddress) {
  Simulation simulation = test::start(
      with(test::cable_pendulum(1.0, 2.0, 0.5), SolverKind::direct, IntegratorKind::rattle, 4));
  simulation.world.keep_in_place();
  ASSERT_TRUE(simulation.step().ok());
  const Place place = place_of(simulation.world.state());
  const std::uint64_t before = hash(simulation.world.state());
  int asked = 0;
  const StepReport report = simulation.step([&] { return ++asked > 2; });
  ASSERT_TRUE(report.stopped);
  EXPECT_EQ(hash(simulation.world.state()), before);
  EXPECT_EQ(place_of(simulation.world.state()), place);
}

TEST(KeepInPlace, WorldsWithoutCablesKeepTheirBodies) {
  Simulation simulation = test::start(test::hinged_chain());
  simulation.world.keep_in_place();
  const BodyState* bodies = simulation.world.state().bodies.data();
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(simulation.step().ok());
    ASSERT_EQ(simulation.world.state().bodies.data(), bodies);
  }
}

TEST(KeepInPlace, AnEditLeavesTheOldStateUnchanged) {
  LiveWorld world = live(test::Atwood{}.machine());
  ASSERT_TRUE(world.step().ok());
  std::shared_ptr<const void> old = world.keep_in_place();
  EXPECT_EQ(world.keep_in_place(), old);
  const BodyState* bodies = world.state().bodies.data();
  const std::size_t count = world.state().bodies.size();
  ASSERT_TRUE(world.step().ok());
  ASSERT_EQ(world.state().bodies.data(), bodies);
  const std::vector<BodyState> before(bodies, bodies + count);

  test::edit(world, [](Edit& edit) { edit.add(test::lump("lump", {3.0, 0.0, 0.0}, 1.0)); });
  const std::shared_ptr<const void> now = world.keep_in_place();
  EXPECT_NE(now, old);
  EXPECT_NE(world.state().bodies.data(), bodies);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(world.step().ok());
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(bodies[i].position, before[i].position);
    EXPECT_EQ(bodies[i].velocity, before[i].velocity);
  }
  EXPECT_NE(world.state().bodies[1].position, before[1].position);
}

TEST(SetInSimulation, SetsTheSameValuesAsHandles) {
  LiveWorld by_name = live(test::Atwood{}.machine());
  LiveWorld by_handle = live(test::Atwood{}.machine());
  const Simulation& simulation = by_name.simulation();
  const std::string body = simulation.world.model().bodies[1].name;
  const auto point =
      find_control(body + ".force_y", simulation.world.model(), *simulation.cable_definitions);
  ASSERT_TRUE(point);
  const Errors errors =
      by_name.set_in_simulation([&](Simulation& own) { return point->set(own, 2.5, 0.0); });
  EXPECT_TRUE(errors.empty()) << test::text(errors);
  ASSERT_TRUE(by_handle.set_force(*by_handle.body(body), {.force = {0.0, 2.5, 0.0}}).empty());
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(by_name.step().ok());
    ASSERT_TRUE(by_handle.step().ok());
  }
  EXPECT_EQ(hash(by_name.state()), hash(by_handle.state()));
}

TEST(SetInSimulation, SetsAllOrNothing) {
  LiveWorld world = live(test::Atwood{}.machine());
  const Simulation& simulation = world.simulation();
  const std::string body = simulation.world.model().bodies[1].name;
  const auto force =
      find_control(body + ".force_y", simulation.world.model(), *simulation.cable_definitions);
  ASSERT_TRUE(force);
  const std::uint64_t before = hash(world.state());
  const Errors errors = world.set_in_simulation([&](Simulation& own) -> Errors {
    if (Errors first = force->set(own, 1.0, 0.0); !first.empty()) return first;
    EXPECT_NE(hash(own.world.state()), before);
    return {{"", "the second cannot be"}};
  });
  EXPECT_THAT(test::text(errors), HasSubstr("the second cannot be"));
  EXPECT_EQ(hash(world.state()), before);
}

}  // namespace
}  // namespace sheave
