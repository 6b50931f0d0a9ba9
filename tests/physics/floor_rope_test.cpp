// The motion of loads on ropes with weight that lie on a floor (cable/lying_rope.h).

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/rope_steps.h"

namespace sheave::floor_rope {
namespace {

using test::accurate;
using test::attach;
using test::cable;
using test::step_of;

CableDef heavy(CableDef rope, std::vector<double> lengths, double stiffness = 1e6) {
  rope.linear_density = 10.0;
  rope.axial_stiffness = stiffness;
  rope.rest_lengths = std::move(lengths);
  rope.floor = 0.0;
  return rope;
}

/// A buoy above an anchor on the floor, lifted by 2500 N more than its weight and pushed away.
test::Machine buoy(const StepSettings& step, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::lump("buoy", {60.0, 25.0, 0.0}, 500.0));
  m.model.bodies.back().velocity = {1.0, 0.0, 2.0};
  m.model.bodies.back().force = {1500.0, 500.0 * test::g + 2500.0, 0.0};
  const auto anchor = attach(BodyId::world());
  CableDef rope =
      from_other_end ? cable("rope", {attach({0}), anchor}) : cable("rope", {anchor, attach({0})});
  m.cables.push_back(heavy(rope, {75.0}));
  return m;
}

/// A car between two ropes of this length over the floor, displaced from the middle: with 22.5 m
/// they touch it and leave it, with 30 m they lie slack and become taut.
test::Machine car(const StepSettings& step, double length) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef body = test::lump("car", {2.0, 5.0, 0.0}, 100.0);
  body.mobility = Mobility::slider;
  body.axis = Vector3::UnitX();
  m.model.add(body);
  m.cables.push_back(
      heavy(cable("left", {attach(BodyId::world(), {-20.0, 5.0, 0.0}), attach({0})}), {length}));
  m.cables.push_back(
      heavy(cable("right", {attach({0}), attach(BodyId::world(), {20.0, 5.0, 0.0})}), {length}));
  return m;
}

struct Course {
  Vector3 position = Vector3::Zero();
  double drift = 0.0;    ///< largest change of the energy [J]
  double floored = 0.0;  ///< least and largest length of the first span on the floor [m]
  double least = 1e9;
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
    const double floored = s.cable_reports()[0].spans[0].floored;
    course.floored = std::max(course.floored, floored);
    course.least = std::min(course.least, floored);
  }
  course.position = s.world.position({0});
  return course;
}

TEST(FloorRope, KeepsTheEnergyToSecondOrder) {
  std::vector<Course> courses;
  for (const int substeps : {8, 16, 32, 64}) {
    courses.push_back(run(buoy(accurate(substeps)), 4.0));
  }
  EXPECT_GT(courses[0].floored - courses[0].least, 5.0);
  for (std::size_t i = 1; i < courses.size(); ++i) {
    EXPECT_NEAR(courses[i - 1].drift / courses[i].drift, 4.0, 0.6);
  }
  const double first = (courses[1].position - courses[2].position).norm();
  const double second = (courses[2].position - courses[3].position).norm();
  EXPECT_NEAR(first / second, 4.0, 0.6);
}

TEST(FloorRope, TouchesDownAndLiftsOffToSecondOrder) {
  // The force has a kink at each instant (cable/lying_rope.h). Within a substep h it changes by the
  // jump of the stiffness times v h, so the impulse of the substep is wrong by the order h^2 there.
  // The place of the instant within its substep sets the factor, so the error falls as h^2 within a
  // bound, and not by 4 each time.
  std::vector<Course> courses;
  for (const int substeps : {8, 16, 32, 64, 128}) {
    courses.push_back(run(car(accurate(substeps), 22.5), 6.0));
  }
  EXPECT_EQ(courses[0].least, 0.0);
  EXPECT_GT(courses[0].floored, 1.0);
  const double fine = courses.back().position.x();
  for (std::size_t i = 0; i + 2 < courses.size(); ++i) {
    const double h = 1.0 / (8 << i);
    EXPECT_LE(std::abs(courses[i].position.x() - fine), 0.3 * h * h);
    EXPECT_LE(courses[i].drift, 60.0 * h * h);
  }
}

TEST(FloorRope, GoesSlackAndTautAgain) {
  std::vector<Course> courses;
  for (const int substeps : {8, 16, 32, 64}) {
    courses.push_back(run(car(accurate(substeps), 30.2), 6.0));
  }
  for (std::size_t i = 0; i + 1 < courses.size(); ++i) {
    const double h = 1.0 / (8 << i);
    EXPECT_LE(courses[i].drift, 60.0 * h * h);
  }
}

TEST(FloorRope, WholeOnTheFloorIsASpring) {
  // A puck on an elastic rope that lies whole: straight flight to the length, then half a period of
  // pi sqrt(m L / EA) with the speed reversed.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = accurate(32);
  BodyDef puck = test::lump("puck", {8.0, 0.0, 0.0}, 100.0);
  puck.mobility = Mobility::slider;
  puck.axis = Vector3::UnitX();
  puck.velocity = {3.0, 0.0, 0.0};
  m.model.add(puck);
  m.cables.push_back(heavy(cable("rope", {attach(BodyId::world()), attach({0})}), {10.0}, 1e5));
  const double time = 1.5;
  const double taut = 2.0 / 3.0;
  const double half = std::numbers::pi * std::sqrt(100.0 * 10.0 / 1e5);
  const Course course = run(m, time);
  // The instant at which the rope becomes taut is known to a substep h. The rope's tension is then at
  // most k v h, so the speed is wrong by k v h^2 / m = 8e-7 m/s times 3, at both instants.
  EXPECT_NEAR(course.position.x(), 10.0 - 3.0 * (time - taut - half), 3e-4);
  EXPECT_NEAR(course.drift, 0.0, 450.0 * 1e-3);
}

TEST(FloorRope, PaysOutOntoTheFloorFromADrum) {
  // A drum that turns freely at the height b pays rope out onto the floor, where it lies slack. The
  // part that hangs plumb pulls with w b at all times: I w' = w b r, with the height of the axle.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = accurate(16);
  m.model.add(test::wheel("drum", {0.0, 10.0, 0.0}, 0.5, 50.0));
  SpoolLink spool;
  spool.body = {0};
  spool.winding = test::right;
  spool.stored_length = 200.0;
  CableDef rope =
      cable("rope", {std::make_shared<SpoolLink>(spool), attach(BodyId::world(), {5.0, 0.0, 0.0})});
  m.cables.push_back(heavy(rope, {16.0}, 1e9));
  Simulation s = test::start(m);
  const double before = s.world.energy().total();
  while (s.world.state().time < 2.0 - 1e-9) ASSERT_TRUE(s.world.step().ok());
  const double pull = 10.0 * test::g * 10.0;
  // The strain of the hanging part, 1e-6, changes w b by its half.
  const double angle = 0.5 * pull * 0.5 / 50.0 * 4.0;
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(report.spans[0].rest_length, 16.0 + 0.5 * angle, 4e-6 * angle);
  EXPECT_LE(report.spans[0].start_force.x(), 1e-9 * pull);
  EXPECT_EQ(report.length_error, 0.0);
  EXPECT_NEAR(s.world.energy().total(), before, 1e-6 * before);
}

/// A rope over two wheels with inertia above the floor, on which its middle lies, with a load at each end.
test::Machine over_wheels(const StepSettings& step, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::wheel("first", {0.0, 6.0, 0.0}, 0.5, 6.0));
  m.model.add(test::wheel("second", {30.0, 7.0, 0.0}, 0.8, 6.0));
  m.model.add(test::weight("left", {-0.5, 2.0, 0.0}, 30.0));
  m.model.add(test::weight("right", {30.8, 2.0, 0.0}, 32.0));
  const auto first = from_other_end ? test::left : test::right;
  CableDef rope = from_other_end ? cable("rope", {attach({3}), test::roll({1}, first),
                                                  test::roll({0}, first), attach({2})})
                                 : cable("rope", {attach({2}), test::roll({0}, first),
                                                  test::roll({1}, first), attach({3})});
  rope.linear_density = 2.0;
  rope.axial_stiffness = 1e6;
  rope.floor = 0.0;
  rope.pretensions = {32.0 * test::g, 24.0 * test::g, 36.0 * test::g};
  if (from_other_end) std::swap(rope.pretensions.front(), rope.pretensions.back());
  m.cables.push_back(rope);
  return m;
}

TEST(FloorRope, RunsOverWheelsToSecondOrder) {
  std::vector<Course> courses;
  for (const int substeps : {16, 32, 64}) {
    Simulation s = test::start(over_wheels(accurate(substeps)));
    const double before = s.world.energy().total();
    Course& course = courses.emplace_back();
    while (s.world.state().time < 1.0 - 1e-9) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport report = s.cable_reports()[0];
      course.drift =
          std::max(course.drift, std::abs(s.world.energy().total() + report.creep_loss - before));
      course.least = std::min(course.least, report.spans[1].floored);
    }
    course.position = s.world.position({2});
    EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
  }
  EXPECT_GT(courses[0].least, 0.5);
  // Rope loses 1e-4 J by creep on the wheels. The pieces in which a wheel keeps its strain tell that
  // to a half.
  for (const Course& course : courses) EXPECT_LE(course.drift, 5e-5);
  const double first = (courses[0].position - courses[1].position).norm();
  const double second = (courses[1].position - courses[2].position).norm();
  // The spans begin with vibrations, because the pretensions leave out the acceleration.
  EXPECT_NEAR(first / second, 4.0, 0.6);
  EXPECT_TRUE(test::checked_run(over_wheels(accurate(16)), 0.5).clean());
  EXPECT_TRUE(
      test::checked_run(over_wheels(step_of(SolverKind::direct, IntegratorKind::xpbd, 16)), 0.5)
          .clean());
  const auto left_after = [](bool other) {
    Simulation s = test::start(over_wheels(accurate(16), other));
    test::run(s.world, 1.0);
    return s.world.position({2});
  };
  EXPECT_LE((left_after(false) - left_after(true)).norm(), 1e-7);
}

TEST(FloorRope, MovesTheSameWithAllSolversAndIntegrators) {
  const Vector3 fine = run(buoy(accurate(64)), 1.0).position;
  const Vector3 sweeps =
      run(buoy(step_of(SolverKind::gauss_seidel, IntegratorKind::rattle, 64)), 1.0).position;
  EXPECT_LE((sweeps - fine).norm(), 1e-8);
  // `xpbd` is of first order: half of the substep, half of the error.
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    const Vector3 coarse = run(buoy(step_of(solver, IntegratorKind::xpbd, 64)), 1.0).position;
    const Vector3 half = run(buoy(step_of(solver, IntegratorKind::xpbd, 128)), 1.0).position;
    EXPECT_NEAR((coarse - fine).norm() / (half - fine).norm(), 2.0, 0.1);
  }
}

TEST(FloorRope, MovesTheSameFromTheOtherEnd) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    const Vector3 one = run(buoy(step), 2.0).position;
    const Vector3 other = run(buoy(step, true), 2.0).position;
    EXPECT_LE((one - other).norm(), 1e-8);  // residuals of rounds, in 1920 substeps
  }
}

/// The machine turned by `turn` and lifted, so that gravity has another direction and floors another
/// height.
test::Machine moved(test::Machine m, const Quaternion& turn, double lift) {
  const Vector3 up = turn * Vector3::UnitY();
  m.model.gravity = turn * m.model.gravity;
  for (BodyDef& body : m.model.bodies) {
    body.position = turn * body.position + lift * up;
    body.velocity = turn * body.velocity;
    body.force = turn * body.force;
    if (body.axis) body.axis = turn * *body.axis;
  }
  for (CableDef& rope : m.cables) {
    *rope.floor += lift;
    for (auto& link : rope.links) {
      auto copy = std::make_shared<AttachmentLink>(dynamic_cast<const AttachmentLink&>(*link));
      if (copy->body.is_world()) copy->point = turn * copy->point + lift * up;
      link = copy;
    }
  }
  return m;
}

TEST(FloorRope, MovesTheSameTurnedAndLifted) {
  const Vector3 plain = run(buoy(accurate(16)), 2.0).position;
  for (const Vector3& axis :
       {Vector3(0.0, 1.0, 0.0), Vector3(1.0, 0.0, 0.0), Vector3(1.0, 2.0, -3.0)}) {
    const Quaternion turn(Eigen::AngleAxisd(1.2, axis.normalized()));
    const double lift = -7.0;
    const Vector3 other = run(moved(buoy(accurate(16)), turn, lift), 2.0).position;
    // Rounding of places and residuals of rounds.
    EXPECT_LE((other - (turn * plain + lift * (turn * Vector3::UnitY()))).norm(), 1e-8);
  }
}

TEST(FloorRope, MovesTheSameInMillimetresAndTonnes) {
  // mm, t, s: forces in N, lengths times 1000, densities in t/mm times 1e-6, masses times 1e-3.
  test::Machine m = buoy(accurate(16));
  const Vector3 plain = run(m, 2.0).position;
  m.model.gravity *= 1e3;
  BodyDef& body = m.model.bodies[0];
  body = test::lump("buoy", {60e3, 25e3, 0.0}, 0.5);
  body.velocity = {1e3, 0.0, 2e3};
  body.force = {1500.0, 500.0 * test::g + 2500.0, 0.0};
  m.cables[0].linear_density = 10.0 * 1e-6;
  m.cables[0].rest_lengths = {75e3};
  const Vector3 other = run(m, 2.0).position;
  EXPECT_LE((other * 1e-3 - plain).norm(), 1e-8);
}

TEST(FloorRope, IsNoRestraintFarBelow) {
  // The bits of a rope that never comes near its floor.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    test::Machine m = car(step_of(SolverKind::direct, integrator, 4), 22.5);
    for (CableDef& rope : m.cables) rope.floor = -100.0;
    const Vector3 with = run(m, 2.0).position;
    for (CableDef& rope : m.cables) rope.floor.reset();
    EXPECT_EQ(with, run(m, 2.0).position);
  }
}

TEST(FloorRope, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    for (const test::Machine& m :
         {buoy(step), buoy(step, true), car(step, 22.5), car(step, 30.2)}) {
      const Certificate told = test::checked_run(m, 3.0);
      EXPECT_TRUE(told.clean()) << (told.clean() ? "" : told.worst()->sentence());
      EXPECT_FALSE(test::checked_run(m, 2.0, 1.0, 2.0).clean());
    }
  }
}

TEST(FloorRope, IsSavedAndRestoredBitForBit) {
  const test::Machine m = car(accurate(8), 30.2);
  Simulation s = test::start(m);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
  const State saved = s.world.state();
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
  const Vector3 end = s.world.position({0});
  Simulation other = test::start(m);
  ASSERT_TRUE(other.world.restore(saved).empty());
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(end, other.world.position({0}));
}

void expect_refused(const test::Machine& m, const std::string& word) {
  const auto made = Simulation::create(m.model, m.cables);
  ASSERT_FALSE(made);
  EXPECT_NE(made.errors()[0].message.find(word), std::string::npos) << made.errors()[0].message;
}

TEST(FloorRope, RefusesWhatAFloorCannotHave) {
  test::Machine m = buoy(accurate(4));
  m.cables[0].floor = 1.0;
  expect_refused(m, "below the floor");
  m = buoy(accurate(4));
  m.cables[0].linear_density = 0.0;
  expect_refused(m, "linear_density");
  m = buoy(accurate(4));
  m.cables[0].axial_inertia = true;
  expect_refused(m, "axial_inertia");
  m = buoy(accurate(4));
  m.model.gravity = Vector3::Zero();
  expect_refused(m, "gravity");
  m = buoy(accurate(4));
  m.cables[0].floor = std::nan("");
  expect_refused(m, "floor");
  m = buoy(accurate(4));
  m.cables[0].rest_lengths.clear();
  m.cables[0].pretension = 1.0;
  expect_refused(m, "slack on its floor");
}

TEST(FloorRope, EndsWhereItLiesSlackBehindAnEye) {
  // Below the eye the load and the rope pull with 49 N + 78 N, and 157 N of rope hang to the floor.
  for (const bool from_other_end : {false, true}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = accurate(4);
    m.model.add(test::weight("load", {20.0, 4.0, 0.0}, 5.0));
    PinholeLink eye;
    eye.point = {20.0, 8.0, 0.0};
    const auto ring = std::make_shared<PinholeLink>(eye);
    const auto anchor = attach(BodyId::world());
    CableDef rope = from_other_end ? cable("rope", {attach({0}), ring, anchor})
                                   : cable("rope", {anchor, ring, attach({0})});
    rope.linear_density = 2.0;
    rope.axial_stiffness = 1e6;
    rope.floor = 0.0;
    rope.rest_lengths = from_other_end ? std::vector{4.0, 28.0} : std::vector{28.0, 4.0};
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    StepReport report;
    for (int i = 0; i < 60 && report.ok(); ++i) report = s.world.step();
    ASSERT_FALSE(report.ok());
    EXPECT_NE(report.divergence->message.find("slack on its floor"), std::string::npos);
  }
}

TEST(FloorRope, EndsWhereAnEndSinksBelowTheFloor) {
  test::Machine m = buoy(accurate(4));
  m.model.bodies[0].force = Vector3::Zero();
  Simulation s = test::start(m);
  StepReport report;
  for (int i = 0; i < 400 && report.ok(); ++i) report = s.world.step();
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.divergence->message.find("below its floor"), std::string::npos);
  // 25 m of fall, and less by the rope's pull: the rope on the floor slackens.
  EXPECT_NEAR(s.world.position({0}).y(), 0.0, 0.5);
}

}  // namespace
}  // namespace sheave::floor_rope
