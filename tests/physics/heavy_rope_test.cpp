// The motion of loads on ropes with weight (cable/cable_weight.cpp).

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/rope_steps.h"

namespace sheave::heavy_rope {
namespace {

using test::attach;
using test::cable;
using test::step_of;

/// A load between two sagging spans, displaced from its rest, with a velocity out of their plane.
test::Machine line(const StepSettings& step, double density = 1.05, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::lump("load", {40.0, -12.0, 0.0}, 30.0));
  m.model.bodies.back().velocity = {0.0, 0.0, 2.0};
  const auto left = attach(BodyId::world());
  const auto right = attach(BodyId::world(), {100.0, 0.0, 0.0});
  CableDef rope = from_other_end ? cable("line", {right, attach({0}), left})
                                 : cable("line", {left, attach({0}), right});
  rope.linear_density = density;
  rope.axial_stiffness = 1e6;
  rope.rest_lengths = {42.0, 62.0};
  if (from_other_end) rope.rest_lengths = {62.0, 42.0};
  m.cables.push_back(rope);
  return m;
}

struct Course {
  Vector3 position = Vector3::Zero();
  double drift = 0.0;  ///< largest change of the energy [J]
};

Course run(const test::Machine& machine, double time) {
  Simulation s = test::start(machine);
  const double before = s.world.energy().total();
  Course course;
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
    course.drift = std::max(course.drift, std::abs(s.world.energy().total() - before));
  }
  course.position = s.world.position({0});
  return course;
}

TEST(HeavyRope, KeepsTheEnergyToSecondOrder) {
  std::vector<Course> courses;
  for (const int substeps : {8, 16, 32}) {
    courses.push_back(
        run(line(step_of(SolverKind::direct, IntegratorKind::rattle, substeps)), 2.0));
  }
  // The ratio of two errors of second order differs from 4 by the next order: (h w)^2 with the
  // fastest vibration of the ropes, 30 rad/s, is 4e-3 with 8 substeps; larger terms of the jerks of
  // the sag have been seen to 10 %.
  for (std::size_t i = 1; i < courses.size(); ++i) {
    EXPECT_NEAR(courses[i - 1].drift / courses[i].drift, 4.0, 0.6);
  }
  const double first = (courses[0].position - courses[1].position).norm();
  const double second = (courses[1].position - courses[2].position).norm();
  EXPECT_NEAR(first / second, 4.0, 0.6);
}

TEST(HeavyRope, MovesTheSameWithAllSolversAndIntegrators) {
  const Vector3 fine =
      run(line(step_of(SolverKind::direct, IntegratorKind::rattle, 64)), 1.0).position;
  const Course sweeps =
      run(line(step_of(SolverKind::gauss_seidel, IntegratorKind::rattle, 64)), 1.0);
  EXPECT_LE((sweeps.position - fine).norm(), 1e-8);
  // `xpbd` is of first order: half of the substep, half of the error.
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    const Vector3 coarse = run(line(step_of(solver, IntegratorKind::xpbd, 64)), 1.0).position;
    const Vector3 half = run(line(step_of(solver, IntegratorKind::xpbd, 128)), 1.0).position;
    EXPECT_NEAR((coarse - fine).norm() / (half - fine).norm(), 2.0, 0.1);
  }
}

TEST(HeavyRope, MovesTheSameFromTheOtherEnd) {
  const StepSettings step = step_of(SolverKind::direct, IntegratorKind::rattle, 16);
  const Vector3 one = run(line(step), 1.0).position;
  const Vector3 other = run(line(step, 1.05, true), 1.0).position;
  EXPECT_LE((one - other).norm(), 1e-8);  // residuals of rounds, in 960 substeps
}

TEST(HeavyRope, BecomesARopeWithoutWeight) {
  // Without sag the spans are slack and taut; with a weight of 1e-9 of the tension they should be so
  // to that order, but for the last moments before they become taut.
  const StepSettings step = step_of(SolverKind::direct, IntegratorKind::rattle, 16);
  const Vector3 light = run(line(step, 1e-7), 1.0).position;
  const Vector3 none = run(line(step, 0.0), 1.0).position;
  EXPECT_LE((light - none).norm(), 1e-3);
}

TEST(HeavyRope, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const test::Machine m = line(step_of(SolverKind::direct, integrator, 16));
    EXPECT_TRUE(test::checked_run(m, 1.0).clean());
    // A load that suddenly has twice its velocity is seen.
    EXPECT_FALSE(test::checked_run(m, 1.0, 0.5, 2.0).clean());
  }
}

TEST(HeavyRope, DampsTheStretchOfItsChord) {
  test::Machine m = line(step_of(SolverKind::direct, IntegratorKind::rattle, 16));
  m.cables[0].damping = 200.0;
  EXPECT_TRUE(test::checked_run(m, 1.0).clean());
  Simulation s = test::start(m);
  double before = s.world.energy().total();
  const double start = before;
  while (s.world.state().time < 2.0) {
    ASSERT_TRUE(s.world.step().ok());
    const double now = s.world.energy().total();
    // Without the damper the energy varies by 1 J.
    EXPECT_LE(now, before + 1.0);
    before = now;
  }
  EXPECT_LT(before, start - 10.0);
}

TEST(HeavyRope, BreaksByTheTensionAtItsUpperEnd) {
  // A load of 10 kg below 20 m of rope with 1 kg/m: 98.1 N below, 294.3 N above.
  for (const double breaking : {290.0, 310.0}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(1.0 / 60.0, 16, 50);
    m.model.add(test::lump("load", {0.0, -20.0, 0.0}, 10.0));
    CableDef rope = cable("rope", {attach(BodyId::world()), attach({0})});
    rope.linear_density = 1.0;
    rope.axial_stiffness = 1e5;
    rope.damping = 2e3;
    // At rest the mean tension of 196.2 N stretches 20 m by 39 mm.
    rope.rest_lengths = {20.0 / (1.0 + 196.2 / 1e5)};
    rope.breaking_tension = breaking;
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    while (s.world.state().time < 0.5) ASSERT_TRUE(s.world.step().ok());
    EXPECT_EQ(s.cable_reports()[0].cut, breaking < 294.3);
  }
}

TEST(HeavyRope, NeedsAMaterialAndPoints) {
  test::Machine m = line(test::settings(1.0 / 60.0, 4, 50));
  m.cables[0].axial_stiffness.reset();
  const auto rigid = Simulation::create(m.model, m.cables);
  ASSERT_FALSE(rigid);
  EXPECT_NE(rigid.errors()[0].message.find("axial_stiffness"), std::string::npos);
}

}  // namespace
}  // namespace sheave::heavy_rope
