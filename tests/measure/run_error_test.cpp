// Errors of runs: what they mean is checked on runs whose errors are known.

#include "measure/run_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/rounding.h"

namespace sheave::measure {
namespace {

using test::eps;

Scene atwood_scene(int substeps, IntegratorKind integrator) {
  const test::Machine machine = test::Atwood().machine();
  Scene scene;
  scene.model = machine.model;
  scene.cables = machine.cables;
  scene.duration = 1.0;
  scene.model.step.dt = 1.0 / 60.0;
  scene.model.step.substeps = substeps;
  scene.model.step.solver = SolverKind::direct;
  scene.model.step.integrator = integrator;
  return scene;
}

Trajectory recorded(const Scene& scene) {
  Result<Trajectory> run = record(scene);
  if (!run) throw std::runtime_error(run.errors().front().message);
  return std::move(run).value();
}

TEST(RunError, OfXpbdUnderConstantAccelerationIsItsClosedForm) {
  // v(k h) = k a h is exact, positions sum it up: x(T) = a T^2 / 2 + a h T / 2. Weights and the
  // wheel's rim move alike, so the root mean square over the three is a h T / 2 too. Rounding: 60
  // steps of positions of some metres.
  const Trajectory reference = recorded(atwood_scene(1, IntegratorKind::rattle));
  const double a = test::Atwood().acceleration();
  for (const int substeps : {1, 2, 4}) {
    const Scene scene = atwood_scene(substeps, IntegratorKind::xpbd);
    const RunError error = error_of(recorded(scene), reference);
    const double h = scene.model.step.dt / substeps;
    const double expected = 0.5 * a * h * scene.duration / reference.scale;
    EXPECT_NEAR(error.position, expected, 1e-8 * expected) << substeps;
    EXPECT_EQ(error.position, error.position_end) << substeps;
    // Tensions are constant in time and right with both.
    EXPECT_LT(error.tension, 1e-8) << substeps;
  }
}

TEST(RunError, OfARunAgainstItselfIsZero) {
  const Trajectory run = recorded(atwood_scene(1, IntegratorKind::xpbd));
  const RunError error = error_of(run, run);
  EXPECT_EQ(error.position, 0.0);
  EXPECT_EQ(error.tension, 0.0);
  EXPECT_EQ(error.energy, 0.0);
}

/// Two bodies in two frames, all at rest; the first turns by its angle and reaches 0.5 m.
Trajectory still() {
  Trajectory run;
  run.scale = 4.0;
  run.bodies = {{BodyId{0}, "wheel", 0.5, true}, {BodyId{1}, "box", 2.0, false}};
  Frame frame;
  frame.poses.resize(2);
  frame.tensions = {3.0, 4.0};
  frame.energy = 10.0;
  run.frames = {frame, frame};
  run.frames[1].kinetic_energy = 5.0;
  return run;
}

TEST(RunError, CountsPlacesAndTurns) {
  const Trajectory reference = still();
  Trajectory run = still();
  // The rim has moved by three turns times 0.5 m: an unwrapped angle does not forget turns.
  const double angle = 6.0 * M_PI;
  run.frames[1].poses[0].angle = angle;
  run.frames[1].poses[1].position = {0.0, 0.3, 0.0};
  const double square = 0.25 * angle * angle + 0.09;
  EXPECT_NEAR(error_of(run, reference).position, std::sqrt(square / 2.0) / 4.0, 8.0 * eps);
  // A body that does not turn by an angle is compared by its orientation, whichever sign its
  // quaternion has.
  Trajectory turned = still();
  turned.frames[1].poses[1].orientation = Eigen::AngleAxisd(0.2, Vector3(0.6, 0.0, 0.8));
  EXPECT_NEAR(error_of(turned, reference).position, std::sqrt(0.16 / 2.0) / 4.0, 1e-8);
  turned.frames[1].poses[1].orientation.coeffs() *= -1.0;
  EXPECT_NEAR(error_of(turned, reference).position, std::sqrt(0.16 / 2.0) / 4.0, 1e-8);
}

TEST(RunError, UsesTheWorstFrame) {
  const Trajectory reference = still();
  Trajectory run = still();
  run.frames[0].poses[1].position = {0.8, 0.0, 0.0};
  EXPECT_NEAR(error_of(run, reference).position, 0.8 / std::sqrt(2.0) / 4.0, 4.0 * eps);
  EXPECT_EQ(error_of(run, reference).position_end, 0.0);
  EXPECT_EQ(position_errors(run, reference).size(), 2U);
}

TEST(RunError, OfTensionsAndEnergyIsRelative) {
  const Trajectory reference = still();
  Trajectory run = still();
  for (double& tension : run.frames[1].tensions) tension *= 1.01;
  run.frames[0].tensions = {100.0, 100.0};  // before the first step, where they mean nothing
  run.frames[1].energy = 9.0;
  const RunError error = error_of(run, reference);
  EXPECT_NEAR(error.tension, 0.01, 1e-14);
  EXPECT_NEAR(error.energy, 1.0 / 5.0,
              4.0 * eps);  // of the kinetic energy, which is all that happens
}

TEST(RunError, OfARunThatDivergedIsInfinite) {
  const Trajectory reference = still();
  Trajectory run = still();
  run.frames.pop_back();
  run.divergence = Divergence{BodyId{0}, 0.5, "gone"};
  EXPECT_TRUE(std::isinf(error_of(run, reference).position));
  EXPECT_TRUE(std::isinf(error_of(run, reference).tension));
}

TEST(RunError, MotionIsTheWayFromTheStart) {
  // Two bodies in a scene of 4 m: one goes 3 m and comes back, one turns by 2 rad with a reach of
  // 0.5 m.
  Trajectory run;
  run.scale = 4.0;
  run.bodies = {{BodyId{0}, "goes", 0.0, false}, {BodyId{1}, "turns", 0.5, true}};
  for (const double part : {0.0, 1.0, 0.0}) {
    Frame frame;
    frame.poses.resize(2);
    frame.poses[0].position = {7.0, 3.0 * part, 0.0};
    frame.poses[1].angle = 5.0 + 2.0 * part;
    run.frames.push_back(frame);
  }
  EXPECT_NEAR(motion_of(run), std::sqrt((9.0 + 1.0) / 2.0) / 4.0, 1e-15);
}

}  // namespace
}  // namespace sheave::measure
