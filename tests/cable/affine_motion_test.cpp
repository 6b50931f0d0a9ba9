// Substeps of machines in which nothing turns a row's gradient (engine/solvers/affine_motion.h)
// against the stages of engine/step.cpp, which any machine takes that has a free body besides: it
// need not have to do with anything.
//
// Both solve the same equations, so what differs is rounding: some 1e-16 of the lengths per
// substep, over 1e3 substeps and twice integrated at most 1e-10.

#include "engine/solvers/affine_motion.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"

namespace sheave::affine_motion {
namespace {

using test::attach;
using test::right;
using test::roll;

constexpr double rounding = 1e-10;

test::Machine machine(IntegratorKind integrator, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(1.0 / 120.0, substeps, 50);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  return m;
}

/// Two weights over three wheels, of which one has drag.
test::Machine train(IntegratorKind integrator, int substeps) {
  test::Machine m = machine(integrator, substeps);
  m.model.bodies = {
      test::wheel("a", {0.0, 0.0, 0.0}, 0.3, 0.02), test::wheel("b", {2.0, 0.7, 0.0}, 0.2, 0.01),
      test::wheel("c", {4.0, 0.1, 0.0}, 0.25, 0.03), test::weight("light", {-0.3, -2.0, 0.0}, 1.0),
      test::weight("heavy", {4.25, -2.0, 0.0}, 1.4)};
  m.model.bodies[1].angular_damping = 0.05;
  m.model.bodies[3].damping = 0.3;
  m.cables = {
      test::cable("cable", {attach(BodyId{3}), roll(BodyId{0}, right), roll(BodyId{1}, right),
                            roll(BodyId{2}, right), attach(BodyId{4})})};
  return m;
}

/// The same with springs that are damped.
test::Machine elastic_train(IntegratorKind integrator, int substeps) {
  test::Machine m = train(integrator, substeps);
  m.cables[0].compliance = 2e-4;
  m.cables[0].damping = 15.0;
  return m;
}

/// A block that slides, with the wheel of a tackle of two parts on it, above a floor.
test::Machine tackle(IntegratorKind integrator, int substeps) {
  test::Machine m = machine(integrator, substeps);
  m.model.bodies = {test::wheel("fixed", {0.4, 0.0, 0.0}, 0.2, 0.02),
                    test::weight("block", {0.0, -2.0, 0.0}, 3.0),
                    test::sheave("sheave", BodyId{1}, {0.0, -1.7, 0.0}, 0.2, 0.5, 0.01),
                    test::weight("effort", {0.6, -2.0, 0.0}, 1.4)};
  m.model.ground = GroundDef{{0.0, -4.0, 0.0}, Vector3::UnitY()};
  m.cables = {test::cable("cable", {attach(BodyId{}, {-0.2, 0.0, 0.0}), roll(BodyId{2}, test::left),
                                    roll(BodyId{0}, right), attach(BodyId{3})})};
  return m;
}

/// A weight on a drum with a drive that changes with time.
test::Machine winch(IntegratorKind integrator, int substeps, DriveKind drive) {
  test::Machine m = machine(integrator, substeps);
  m.model.bodies = {test::wheel("drum", {0.0, 0.0, 0.0}, 0.2, 0.05),
                    test::wheel("wheel", {2.0, 0.0, 0.0}, 0.2, 0.01),
                    test::weight("weight", {2.2, -2.0, 0.0}, 2.0)};
  m.model.bodies[0].drive = drive;
  m.model.bodies[0].drive_times = {0.0, 0.4, 1.0};
  m.model.bodies[0].drive_values = drive == DriveKind::torque ? std::vector<double>{3.0, 4.5, 4.0}
                                                              : std::vector<double>{0.0, 1.0, 0.5};
  auto spool = std::make_shared<SpoolLink>();
  spool->body = BodyId{0};
  spool->winding = right;
  spool->stored_length = 1.5;
  m.cables = {test::cable("cable", {spool, roll(BodyId{1}, right), attach(BodyId{2})})};
  return m;
}

/// Sets something at the start of a step.
using Setter = std::function<Errors(World&, int)>;

/// Runs the machine and the same with a free body besides, and compares them.
void compare(const test::Machine& m, int steps, int least_affine, const Setter& set = {}) {
  Simulation affine = test::start(m);
  test::Machine besides = m;
  besides.model.bodies.push_back(test::lump("besides", {0.0, 0.0, 50.0}, 1.0));
  Simulation stages = test::start(besides);
  int taken = 0;
  for (int i = 0; i < steps; ++i) {
    if (set) {
      ASSERT_TRUE(set(affine.world, i).empty());
      ASSERT_TRUE(set(stages.world, i).empty());
    }
    const StepReport report = affine.world.step();
    ASSERT_TRUE(report.ok());
    const StepReport other = stages.world.step();
    ASSERT_NEAR(report.statistics.external_work, other.statistics.external_work, rounding);
    ASSERT_TRUE(other.ok());
    ASSERT_GT(other.statistics.factorisations, 0);
    // Only the stages factor in every substep.
    if (report.statistics.factorisations == 0) ++taken;
    const State& own = affine.world.state();
    const State& their = stages.world.state();
    for (std::size_t b = 0; b < own.bodies.size(); ++b) {
      const BodyState& x = own.bodies[b];
      const BodyState& y = their.bodies[b];
      ASSERT_LE((x.position - y.position).norm(), rounding) << i << " " << b;
      ASSERT_LE((x.velocity - y.velocity).norm(), 100.0 * rounding) << i << " " << b;
      ASSERT_LE((x.angular_velocity - y.angular_velocity).norm(), 100.0 * rounding)
          << i << " " << b;
      ASSERT_LE(std::abs(x.angle - y.angle), 10.0 * rounding) << i << " " << b;
      ASSERT_LE((x.orientation.coeffs() - y.orientation.coeffs()).norm(), 10.0 * rounding);
    }
    const std::vector<CableReport> mine = affine.cable_reports();
    const std::vector<CableReport> others = stages.cable_reports();
    ASSERT_EQ(mine[0].length_error, 0.0);
    for (std::size_t k = 0; k < mine[0].spans.size(); ++k) {
      const double tension = others[0].spans[k].tension;
      ASSERT_NEAR(mine[0].spans[k].tension, tension, 1e-7 * std::max(tension, 1.0))
          << i << " " << k;
    }
    const std::optional<Certificate> certificate = affine.certificate();
    ASSERT_TRUE(certificate.has_value());
    ASSERT_TRUE(certificate->clean(1e-6)) << i;
  }
  EXPECT_GE(taken, least_affine);
  EXPECT_EQ(affine.cables->events().size(), stages.cables->events().size());
}

class AffineMotion : public testing::TestWithParam<std::tuple<IntegratorKind, int>> {
 protected:
  [[nodiscard]] IntegratorKind integrator() const { return std::get<0>(GetParam()); }
  [[nodiscard]] int substeps() const { return std::get<1>(GetParam()); }
};

TEST_P(AffineMotion, TrainMovesAsByTheStages) { compare(train(integrator(), substeps()), 100, 98); }

TEST_P(AffineMotion, ElasticTrainMovesAsByTheStages) {
  compare(elastic_train(integrator(), substeps()), 100, 98);
}

TEST_P(AffineMotion, TackleMovesAsByTheStagesAndLands) {
  compare(tackle(integrator(), substeps()), 200, 60);
}

TEST_P(AffineMotion, WinchesMoveAsByTheStages) {
  for (const DriveKind drive : {DriveKind::torque, DriveKind::speed, DriveKind::angle}) {
    compare(winch(integrator(), substeps(), drive), 130, 100);
  }
}

TEST_P(AffineMotion, DrumThatRunsOutIsLeftToTheStages) {
  test::Machine m = winch(integrator(), substeps(), DriveKind::none);
  m.model.bodies[0].drive_times.clear();
  m.model.bodies[0].drive_values.clear();
  // It is at an end after 82 to 84 steps; later it swings through its dead point, and rounding
  // grows.
  compare(m, 86, 70);
}

TEST_P(AffineMotion, WeightThatIsThrownUpIsLeftToTheStages) {
  // The heavy weight lands, and the light one goes on.
  test::Machine m = train(integrator(), substeps());
  m.model.ground = GroundDef{{0.0, -2.6, 0.0}, Vector3::UnitY()};
  compare(m, 150, 60);
}

TEST_P(AffineMotion, MovesAsByTheStagesUnderChangedGravityAndForces) {
  const Setter set = [](World& world, int i) -> Errors {
    if (i == 20) return world.set_gravity({1.0, -7.0, 0.5});
    if (i == 30) return world.set_force(BodyId{1}, {{0.0, 1.0, 0.0}, {0.1, 0.0, 0.05}});
    if (i == 35)
      return world.set_force(BodyId{3}, {{2.0, 3.0, 0.0}, Vector3::Zero(), Vector3(0.1, 0.0, 0.0)});
    if (i == 50) return world.clear_force(BodyId{1});
    return {};
  };
  compare(train(integrator(), substeps()), 80, 78, set);
  const Setter on_sheave = [](World& world, int i) -> Errors {
    return i == 10 ? world.set_force(BodyId{2}, {{0.0, 4.0, 0.0}, {0.0, 0.0, 0.2}}) : Errors{};
  };
  compare(tackle(integrator(), substeps()), 40, 38, on_sheave);
}

TEST_P(AffineMotion, ForcesThatTurnAboutAnAxleAreLeftToTheStages) {
  const Setter rim = [](World& world, int i) -> Errors {
    return i == 10 ? world.set_force(BodyId{1},
                                     {{0.0, 1.0, 0.0}, Vector3::Zero(), Vector3(0.2, 0.0, 0.0)})
                   : Errors{};
  };
  compare(train(integrator(), substeps()), 60, 8, rim);
}

// The second force is one for the stages; by then the first has been taken.
TEST_P(AffineMotion, ForcesClearedTogetherNoLongerAct) {
  const Setter set = [](World& world, int i) -> Errors {
    Errors errors;
    const auto keep = [&](const Errors& more) {
      errors.insert(errors.end(), more.begin(), more.end());
    };
    if (i == 10) {
      keep(world.set_force(BodyId{0}, {Vector3::Zero(), {0.0, 0.0, 0.5}}));
      keep(world.set_force(BodyId{1}, {{0.0, 1.0, 0.0}, Vector3::Zero(), Vector3(0.2, 0.0, 0.0)}));
    }
    if (i == 20) {
      keep(world.clear_force(BodyId{0}));
      keep(world.clear_force(BodyId{1}));
    }
    return errors;
  };
  compare(train(integrator(), substeps()), 60, 48, set);
}

TEST_P(AffineMotion, MovesAsByTheStagesWithChangedDrives) {
  for (const DriveKind drive : {DriveKind::torque, DriveKind::speed, DriveKind::angle}) {
    const Setter set = [&](World& world, int i) -> Errors {
      const double turned = world.state().bodies[0].angle;
      if (drive == DriveKind::angle) {
        return i % 7 == 5 ? world.set_drive(BodyId{0}, {turned + 0.03, 0.05}) : Errors{};
      }
      if (i == 40) return world.clear_drive(BodyId{0});
      return i % 5 == 2 ? world.set_drive(BodyId{0}, 3.0 + 0.05 * i) : Errors{};
    };
    // The light wheel lets the cable fall slack when the drum is slowed down.
    compare(winch(integrator(), substeps(), drive), 80, 50, set);
  }
}

TEST_P(AffineMotion, CableBreaksInTheSameSubstep) {
  test::Machine m = train(integrator(), substeps());
  m.model.bodies[4].drive = DriveKind::none;
  m.cables[0].breaking_tension = 1e9;
  m.cables[0].cut_time = 0.25;
  compare(m, 60, 28);
}

TEST_P(AffineMotion, ARunFromASnapshotContinuesBitForBit) {
  const test::Machine m = elastic_train(integrator(), substeps());
  Simulation whole = test::start(m);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(whole.world.step().ok());
  const State middle = whole.world.state();
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(whole.world.step().ok());
  Simulation second = test::start(m);
  ASSERT_TRUE(second.world.restore(middle).empty());
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(second.world.step().ok());
  EXPECT_EQ(hash(second.world.state()), hash(whole.world.state()));
  ASSERT_TRUE(whole.world.restore(middle).empty());
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(whole.world.step().ok());
  EXPECT_EQ(hash(second.world.state()), hash(whole.world.state()));
}

/// The number of steps among `steps` that leaps have made; after each the state is the same bit for
/// bit as that of a world that makes one after the other.
std::int64_t leap_beside(const test::Machine& machine, int steps) {
  Simulation walking = test::start(machine);
  Simulation leaping = test::start(machine);
  std::int64_t leapt = 0;
  std::int64_t stride = 1;
  while (leaping.world.state().steps < steps) {
    leapt += leaping.leap(stride);
    EXPECT_TRUE(leaping.world.step().ok());
    EXPECT_TRUE(leaping.world.last_substep().has_value());
    stride = stride % 7 + 2;
    while (walking.world.state().steps < leaping.world.state().steps) {
      EXPECT_TRUE(walking.world.step().ok());
    }
    EXPECT_EQ(hash(leaping.world.state()), hash(walking.world.state()));
    EXPECT_EQ(leaping.world.state().time, walking.world.state().time);
    if (testing::Test::HasFailure()) break;
  }
  return leapt;
}

/// A train in a tilted plane: directions whose length is rounded make the end of a step another
/// start of the next one.
test::Machine askew_train(IntegratorKind integrator, int substeps) {
  test::Machine m = train(integrator, substeps);
  const Quaternion tilt = rotation_by({0.2, 0.3, 0.1});
  m.model.gravity = tilt * m.model.gravity;
  for (BodyDef& body : m.model.bodies) {
    body.position = tilt * body.position;
    body.orientation = tilt * body.orientation;
    if (body.axis) body.axis = tilt * *body.axis;
  }
  return m;
}

/// A train with an axis that points down, and a place whose zeros are negative: of such a zero any
/// sum makes another one.
test::Machine signed_train(IntegratorKind integrator, int substeps) {
  test::Machine m = train(integrator, substeps);
  m.model.bodies[3].axis = Vector3(0.0, -1.0, 0.0);
  m.model.bodies[4].position.z() = -0.0;
  return m;
}

/// A train whose heavy weight lands, so that the light one goes on.
test::Machine thrown_train(IntegratorKind integrator, int substeps) {
  test::Machine m = train(integrator, substeps);
  m.model.ground = GroundDef{{0.0, -2.6, 0.0}, Vector3::UnitY()};
  return m;
}

TEST_P(AffineMotion, SubstepsDoneTogetherEqualSingleSubstepsBitForBit) {
  for (const test::Machine& machine :
       {train(integrator(), substeps()), elastic_train(integrator(), substeps()),
        tackle(integrator(), substeps()), thrown_train(integrator(), substeps()),
        askew_train(integrator(), substeps()), signed_train(integrator(), substeps()),
        winch(integrator(), substeps(), DriveKind::torque)}) {
    Simulation whole = test::start(machine);
    Simulation watched = test::start(machine);
    for (int i = 0; i < 120; ++i) {
      ASSERT_TRUE(whole.world.step().ok());
      ASSERT_TRUE(watched.world.step({}, [] {}).ok());
      ASSERT_EQ(hash(whole.world.state()), hash(watched.world.state())) << i;
      // What the last substep started from is the same, too.
      const State& start = whole.world.last_substep()->start;
      const State& other = watched.world.last_substep()->start;
      ASSERT_EQ(hash(start), hash(other)) << i;
    }
  }
}

TEST_P(AffineMotion, LeapsEqualStepsBitForBit) {
  const bool alone = substeps() == 1;
  for (const test::Machine& machine :
       {train(integrator(), substeps()), elastic_train(integrator(), substeps()),
        tackle(integrator(), substeps()), thrown_train(integrator(), substeps()),
        askew_train(integrator(), substeps()), signed_train(integrator(), substeps())}) {
    const std::int64_t leapt = leap_beside(machine, 150);
    EXPECT_EQ(leapt > 40, alone) << leapt;
  }
  for (const DriveKind drive : {DriveKind::torque, DriveKind::speed, DriveKind::angle}) {
    EXPECT_EQ(leap_beside(winch(integrator(), substeps(), drive), 130) > 40, alone);
  }
}

TEST_P(AffineMotion, LeapsHaveNoLastSubstepAndLeaveSetLoadsToSteps) {
  Simulation own = test::start(train(integrator(), substeps()));
  ASSERT_TRUE(own.world.step().ok());
  const std::int64_t done = own.leap(10);
  EXPECT_EQ(done, substeps() == 1 ? 10 : 0);
  EXPECT_EQ(own.world.last_substep().has_value(), done == 0);
  EXPECT_EQ(own.leap(0), 0);
  EXPECT_EQ(own.leap(-1), 0);
  ASSERT_TRUE(own.world.set_gravity({0.0, -1.0, 0.0}).empty());
  EXPECT_EQ(own.leap(10), 0);
}

TEST_P(AffineMotion, AStoppedStepLeavesTheStateUnchanged) {
  // The light weight is thrown up, so that steps are begun in one way and ended in another.
  test::Machine m = train(integrator(), substeps());
  m.model.ground = GroundDef{{0.0, -2.6, 0.0}, Vector3::UnitY()};
  Simulation whole = test::start(m);
  Simulation stopped = test::start(m);
  for (int i = 0; i < 120; ++i) {
    ASSERT_TRUE(whole.world.step().ok());
    for (int most = 0;; ++most) {
      const std::uint64_t before = hash(stopped.world.state());
      int polls = 0;
      const StepReport report = stopped.world.step([&] { return polls++ == most; });
      if (!report.stopped) break;
      ASSERT_EQ(hash(stopped.world.state()), before) << i << " " << most;
    }
    ASSERT_EQ(hash(stopped.world.state()), hash(whole.world.state())) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, AffineMotion,
                         testing::Combine(testing::Values(IntegratorKind::xpbd,
                                                          IntegratorKind::rattle),
                                          testing::Values(1, 3)));

}  // namespace
}  // namespace sheave::affine_motion
