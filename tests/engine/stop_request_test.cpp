// Steps that their caller ends early, what a substep may cost, and what is discarded with motion
// that is.

#include <limits>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/instants.h"
#include "engine/joints/hinge.h"
#include "engine/work_limit.h"
#include "tests/support/builders.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

/// Says so when it is asked for the n-th time; 0: never.
class NthTime {
 public:
  explicit NthTime(int n = 0) : n_(n) {}
  [[nodiscard]] StopRequest request() {
    return [this] { return ++asked_ == n_; };
  }
  [[nodiscard]] int asked() const { return asked_; }

 private:
  int n_;
  int asked_ = 0;
};

/// A load that swings under a light cart, whose substeps are cut, beside an obstacle that the cable
/// touches and leaves.
test::Machine whip() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step.dt = 1.0 / 60.0;
  BodyDef cart = test::weight("cart", Vector3::Zero(), 1e-4);
  cart.axis = Vector3::UnitX();
  m.model.add(cart);
  m.model.add(test::lump("bob", {0.84, -0.54, 0.0}, 1.0));
  m.cables.push_back(test::cable("rope", {test::attach(BodyId{0}), test::attach(BodyId{1})}));
  return m;
}

Model fallen_boxes() {
  test::Heap heap(SolverKind::direct, IntegratorKind::rattle);
  heap.surface.friction = 0.5;
  heap.floor();
  heap.put(test::box(Vector3::Constant(0.2)), {0.0, 0.1, 0.0});
  heap.put(test::box(Vector3::Constant(0.2)), {0.05, 0.31, 0.0});
  return heap.model;
}

/// Steps `stopped` with a stop at the first, second, ... time of asking until a step is complete,
/// and `whole` without any.
void expect_nothing_of_stopped_steps(World& stopped, World& whole, int steps) {
  for (int step = 0; step < steps; ++step) {
    const std::uint64_t before = hash(stopped.state());
    StepReport report;
    int n = 0;
    do {
      NthTime stop(++n);
      report = stopped.step(stop.request());
      if (report.ok()) {
        // Asked once fewer than it would have taken.
        EXPECT_EQ(stop.asked(), n - 1);
        break;
      }
      ASSERT_TRUE(report.stopped);
      EXPECT_FALSE(report.divergence.has_value());
      EXPECT_EQ(stop.asked(), n) << "nobody is asked after a yes";
      ASSERT_EQ(hash(stopped.state()), before) << "stop " << n << " of step " << step;
      EXPECT_FALSE(stopped.last_substep().has_value());
    } while (n < 100000);
    EXPECT_GT(n, 1);
    const StepReport right = whole.step();
    ASSERT_TRUE(right.ok());
    ASSERT_EQ(hash(stopped.state()), hash(whole.state())) << "step " << step;
    EXPECT_EQ(report.statistics.rounds, right.statistics.rounds);
    EXPECT_EQ(report.statistics.last_correction, right.statistics.last_correction);
  }
}

TEST(StopRequest, AtAnyMomentLeavesTheStateAtTheStartOfTheStep) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    test::Machine machine = test::Atwood{}.machine();
    machine.model.step = test::settings(1.0 / 60.0, 3, 6);
    machine.model.step.solver = method.solver;
    machine.model.step.integrator = method.integrator;
    Simulation stopped = test::start(machine);
    Simulation whole = test::start(machine);
    expect_nothing_of_stopped_steps(stopped.world, whole.world, 5);
  }
}

TEST(StopRequest, AtAnyMomentOfADividedSubstepOrOfContactsLeavesNoTrace) {
  {
    Simulation stopped = test::start(whip());
    Simulation whole = test::start(whip());
    // Up to where the cart whips past the bob.
    std::int64_t cut = 0;
    while (cut == 0 && whole.world.state().steps < 200) {
      ASSERT_TRUE(stopped.world.step().ok());
      const State before = whole.world.state();
      const StepReport report = whole.world.step();
      ASSERT_TRUE(report.ok());
      cut = report.statistics.cut_substeps;
      if (cut == 0) continue;
      ASSERT_TRUE(whole.world.restore(before).empty());
      ASSERT_TRUE(stopped.world.restore(before).empty());
    }
    ASSERT_GT(cut, 0);
    expect_nothing_of_stopped_steps(stopped.world, whole.world, 1);
  }
  World stopped = test::start(fallen_boxes());
  World whole = test::start(fallen_boxes());
  expect_nothing_of_stopped_steps(stopped, whole, 10);
}

TEST(StopRequest, IsAskedOncePerSubstepAndFactorisation) {
  test::Machine machine = test::Atwood{}.machine();
  machine.model.step = StepSettings{};
  Simulation affine = test::start(machine);
  // With a free body the stages do what affine substeps do otherwise.
  machine.model.bodies.push_back(test::lump("besides", {0.0, 0.0, 9.0}, 1.0));
  Simulation s = test::start(machine);
  for (int i = 0; i < 20; ++i) {
    NthTime never;
    const StepReport report = s.world.step(never.request());
    ASSERT_TRUE(report.ok());
    ASSERT_EQ(report.statistics.cut_substeps, 0);
    EXPECT_EQ(never.asked(), machine.model.step.substeps + report.statistics.factorisations);
    NthTime neither;
    ASSERT_TRUE(affine.world.step(neither.request()).ok());
    if (i > 0) {
      EXPECT_EQ(neither.asked(), 1);
    }
  }
}

TEST(StopRequest, ThatNeverStopsChangesNothing) {
  Simulation asked = test::start(whip());
  Simulation alone = test::start(whip());
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(asked.world.step([] { return false; }).ok());
    ASSERT_TRUE(alone.world.step().ok());
    ASSERT_EQ(hash(asked.world.state()), hash(alone.world.state()));
    EXPECT_TRUE(asked.world.last_substep().has_value());
  }
}

/// A weight on a cable that it breaks in the first substep, and a bar with two drives of one angle
/// that agree for half a step and contradict each other from then on.
test::Machine broken_promise() {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = StepSettings{};
  m.model.step.substeps = 1;
  const double dt = m.model.step.dt;
  m.model.add(test::lump("load", {5.0, -1.0, 0.0}, 1.0));
  m.cables.push_back(test::cable(
      "rope", {test::attach(BodyId::world(), {5.0, 0.0, 0.0}), test::attach(BodyId{0})}));
  m.cables[0].breaking_tension = 0.5 * test::g;
  BodyDef bar = test::lump("bar", {0.5, 0.0, 0.0}, 2.0);
  bar.inertia = Vector3(0.01, 0.2, 0.2);
  const BodyId body = m.model.add(bar);
  for (const double last : {0.0, 0.1}) {
    auto hinge = std::make_shared<HingeJoint>();
    hinge->name = last == 0.0 ? "a" : "b";
    hinge->body_b = body;
    hinge->axis = Vector3::UnitZ();
    hinge->angle.drive = CoordinateDrive::position;
    hinge->angle.drive_times = {0.0, 0.5 * dt, dt};
    hinge->angle.drive_values = {0.0, 0.0, last};
    m.model.joints.push_back(hinge);
  }
  return m;
}

TEST(DiscardedMotion, LeavesNoEvents) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine = broken_promise();
    machine.model.step.integrator = integrator;
    Simulation s = test::start(machine);
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    // Parts were done, until the second half came to no end, and all of it was done again.
    ASSERT_EQ(report.statistics.unconverged, 1);
    ASSERT_EQ(report.statistics.cut_substeps, 0);
    ASSERT_EQ(s.cables->events().size(), 1U);
    EXPECT_EQ(s.cables->events()[0].kind, CableEvent::Kind::cut);
    // The cable breaks at once, after the shortest part of a substep.
    EXPECT_EQ(s.cables->events()[0].time, instant_slop(machine.model.step));
  }
}

TEST(DiscardedMotion, LeavesNoEventsOfAStoppedStep) {
  test::Machine machine = broken_promise();
  machine.model.joints.clear();
  machine.model.step.substeps = 4;
  Simulation s = test::start(machine);
  // The cable breaks in the first substep; the stop comes in the last one.
  NthTime count;
  ASSERT_TRUE(Simulation(test::start(machine)).world.step(count.request()).ok());
  NthTime stop(count.asked());
  ASSERT_TRUE(s.world.step(stop.request()).stopped);
  EXPECT_TRUE(s.cables->events().empty());
  ASSERT_TRUE(s.world.step().ok());
  EXPECT_EQ(s.cables->events().size(), 1U);
}

TEST(WorkLimit, NumbersThatOverflowEndTheRounds) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine machine = test::Atwood{}.machine();
    machine.model.step = StepSettings{};
    machine.model.step.integrator = integrator;
    Simulation s = test::start(machine);
    State state = s.world.state();
    state.bodies[1].velocity.y() = std::numeric_limits<double>::max();
    ASSERT_TRUE(s.world.restore(state).empty());
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.divergence.has_value());
    // An attempt has a round or two, from the start of the substep, where all is finite yet: the
    // whole, halves down to 2^-18, and the whole once or twice more.
    EXPECT_LE(report.statistics.rounds, 2 * (1 + 18 + 2));
  }
  // Sweeps, of which there are as many as were asked for, end soon.
  test::Machine machine = test::Atwood{}.machine();
  machine.model.step = test::settings(10.0, 1, 1000000);
  Simulation s = test::start(machine);
  State state = s.world.state();
  state.bodies[1].velocity.y() = std::numeric_limits<double>::max();
  ASSERT_TRUE(s.world.restore(state).empty());
  NthTime never;
  EXPECT_TRUE(s.world.step(never.request()).divergence.has_value());
  EXPECT_LE(never.asked(), 1 + 16);
}

TEST(WorkLimit, RefusesOneFactorisationTooMany) {
  WorkLimit work;
  work.allow(2);
  EXPECT_TRUE(work.take_factorisation());
  EXPECT_TRUE(work.take_factorisation());
  EXPECT_FALSE(work.exhausted());
  EXPECT_FALSE(work.take_factorisation());
  EXPECT_TRUE(work.exhausted());
  EXPECT_FALSE(work.stopped());
}

// Eleven boxes under a gravity of 1e6: each touches all others within a substep, and most sets of
// rows lead to another.
TEST(WorkLimit, BoundsTheFactorisationsOfAStep) {
  test::Heap heap(SolverKind::direct, IntegratorKind::rattle);
  heap.model.step = StepSettings{};
  heap.model.gravity = 1e6 * Vector3(0.0, -1.0, 0.0);
  heap.surface.friction = 0.5;
  heap.floor();
  for (int i = 0; i < 4; ++i) {
    heap.put(test::box(Vector3::Constant(0.2)), {0.01 * (i % 2), 0.1 + 0.2 * i, 0.0});
  }
  World world = heap.start();
  for (int i = 0; i < 3; ++i) {
    const StepReport report = world.step();
    ASSERT_TRUE(report.ok());
    // Whole and parts, and the two last attempts.
    constexpr std::int64_t most = 4096 + 2 * 512 + 3 * 50;
    EXPECT_LE(report.statistics.factorisations, most * heap.model.step.substeps);
  }
}

}  // namespace
}  // namespace sheave
