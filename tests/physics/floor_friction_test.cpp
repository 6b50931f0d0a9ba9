// Ropes that lie on a floor with friction (cable/floor_profile.h): published anchor tensions, closed forms
// of hysteresis, a program of its own, energy, orders of convergence, and bad input.

#include "cable/floor_friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/rope_steps.h"

namespace sheave::floor_friction {
namespace {

using test::accurate;
using test::attach;
using test::cable;
using test::step_of;

struct RopeOf {
  double density = 0.0;
  double stiffness = 0.0;
  double length = 0.0;
  double friction = 0.0;
};

/// A rope from an anchor at the origin, or at `anchor`, to body 0.
CableDef moored(const RopeOf& of, bool from_other_end = false,
                const Vector3& at = Vector3::Zero()) {
  const auto anchor = attach(BodyId::world(), at);
  CableDef rope =
      from_other_end ? cable("rope", {attach({0}), anchor}) : cable("rope", {anchor, attach({0})});
  rope.linear_density = of.density;
  rope.axial_stiffness = of.stiffness;
  rope.rest_lengths = {of.length};
  rope.floor = 0.0;
  rope.floor_friction = of.friction;
  return rope;
}

/// A ship that moves as it is told, on such a rope.
test::Machine ship(const StepSettings& step, const Vector3& from, const Vector3& velocity,
                   const CableDef& rope, double gravity = 10.0) {
  test::Machine m;
  m.model.gravity = {0.0, -gravity, 0.0};
  m.model.step = step;
  BodyDef body = test::lump("ship", from, 1.0);
  body.mobility = Mobility::kinematic;
  body.velocity = velocity;
  m.model.add(body);
  m.cables.push_back(rope);
  return m;
}

struct Mooring {
  double horizontal = 0.0;  ///< H [N]
  double vertical = 0.0;    ///< at the ship [N]
  double anchor = 0.0;      ///< tension there [N]
  double floored = 0.0;     ///< [m]
};

Mooring mooring_of(const Simulation& s) {
  const CableReport report = s.cable_reports()[0];
  const SpanReport& span = report.spans[0];
  const bool starts = report.links[0].body.is_world();
  const Vector3 pull = starts ? span.end_force : span.start_force;
  return {std::hypot(pull.x(), pull.z()), -pull.y(), span.tension_at(starts ? 0.0 : 1.0),
          span.floored};
}

Mooring moved(const test::Machine& m, double time) {
  Simulation s = test::start(m);
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
  }
  return mooring_of(s);
}

TEST(FloorFriction, HasThePublishedAnchorTensions) {
  // 500 m of rope with 800 N/m and 7.51e12 N between an anchor and a ship 400 m away and 200 m above it,
  // pulled there out of slack: the cases with friction in the tests of MoorPy (NREL), whose own tolerance
  // is 1e-5. With 0.1 the tension falls by 80 N/m along 202.81 m, with 5 to 0.
  struct Case {
    double friction, horizontal, vertical, anchor, floored;
  };
  for (const Case& one :
       {Case{0.1, 96643.42877136687, 237751.75577183915, 80418.60434855078, 202.81030528520108},
        Case{5.0, 96643.43501616362, 237751.75997440016, 0.0, 202.81030003199982}}) {
    for (const bool other_end : {false, true}) {
      for (const int substeps : {1, 4, 64}) {
        const CableDef rope = moored({80.0, 7.51e12, 500.0, one.friction}, other_end);
        const Mooring found =
            moved(ship(accurate(substeps), {290.0, 200.0, 0.0}, {55.0, 0.0, 0.0}, rope), 2.0);
        EXPECT_NEAR(found.horizontal, one.horizontal, 1e-6 * one.horizontal);
        EXPECT_NEAR(found.vertical, one.vertical, 1e-6 * one.vertical);
        EXPECT_NEAR(found.anchor, one.anchor, 1e-6 * one.horizontal);
        EXPECT_NEAR(found.floored, one.floored, 1e-6 * one.floored);
      }
    }
  }
}

/// A rope of 10 m, 100 N/m and EA = 1e5 N that lies whole on the floor, with mu 0.5: k = 50 N/m.
constexpr RopeOf flat{10.0, 1e5, 10.0, 0.5};
constexpr double flat_slope = 50.0;

/// The tension of the end of such a rope that is drawn out by `way` with no tension before.
double drawn(double way) {
  // A front x from the end: the way is k x^2 / 2 EA, up to the length; then all of it slides.
  const double whole = 0.5 * flat_slope * flat.length * flat.length / flat.stiffness;
  if (way < whole) return std::sqrt(2.0 * flat_slope * flat.stiffness * way);
  return flat_slope * flat.length + (way - whole) * flat.stiffness / flat.length;
}

/// The same after the end has gone back from there by `way`: the front has half the slope, so Masing's
/// rule doubles the curve.
double drawn_back(double way) { return 2.0 * drawn(0.5 * way); }

TEST(FloorFriction, HasTheHysteresisOfARodOnTheGround) {
  for (const double way : {0.01, 0.02, 0.04}) {
    for (const int substeps : {1, 16}) {
      for (const bool other_end : {false, true}) {
        const CableDef rope = moored(flat, other_end);
        Simulation s =
            test::start(ship(accurate(substeps), {10.0, 0.0, 0.0}, {way, 0.0, 0.0}, rope));
        test::run(s.world, 1.0);
        EXPECT_NEAR(mooring_of(s).horizontal, drawn(way), 1e-6 * drawn(way));
        State back = s.world.state();
        const double half = way < 0.025 ? 0.5 * way : 0.3 * way;
        back.bodies[0].velocity = Vector3(-half, 0.0, 0.0);
        // A kinematic body goes on as it is told: the way back is a machine that begins there.
        test::Machine m = ship(accurate(substeps), {10.0 + way, 0.0, 0.0}, {-half, 0.0, 0.0}, rope);
        Simulation again = test::start(m);
        State state = again.world.state();
        state.features = back.features;
        ASSERT_TRUE(again.world.restore(state).empty());
        test::run(again.world, 1.0);
        const double expected = drawn(way) - drawn_back(half);
        EXPECT_NEAR(mooring_of(again).horizontal, expected, 1e-6 * drawn(way));
      }
    }
  }
}

/// A puck that slides on the floor at the end of such a rope.
test::Machine puck(const StepSettings& step, double friction, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = {0.0, -10.0, 0.0};
  m.model.step = step;
  BodyDef body = test::lump("puck", {9.99, 0.0, 0.0}, 100.0);
  body.mobility = Mobility::slider;
  body.axis = Vector3::UnitX();
  body.velocity = {0.5, 0.0, 0.0};
  m.model.add(body);
  RopeOf rope = flat;
  rope.friction = friction;
  m.cables.push_back(moored(rope, from_other_end));
  return m;
}

struct Course {
  Vector3 position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  double drift = 0.0;  ///< largest change of energy and loss together [J]
  double loss = 0.0;   ///< at the end [J]
  double least = 1e9;  ///< least change of the loss in a step [J]
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
    const double loss = s.cable_reports()[0].floor_loss;
    course.least = std::min(course.least, loss - course.loss);
    course.loss = loss;
    course.drift = std::max(course.drift, std::abs(s.world.energy().total() + loss - before));
  }
  course.position = s.world.position({0});
  course.velocity = s.world.state().bodies[0].velocity;
  return course;
}

TEST(FloorFriction, TakesTheEnergyThatAPuckLoses) {
  // The puck draws the rope out until its energy is elastic energy and loss, and comes back. At the turn
  // v = 0: the work of the end, the integral of drawn(), is m v^2 / 2.
  double turn = 0.0;
  double high = 0.1;
  while (high - turn > 1e-15) {
    const double way = 0.5 * (turn + high);
    double work = 0.0;
    constexpr int parts = 20000;
    for (int i = 0; i < parts; ++i) work += drawn((i + 0.5) / parts * way) * way / parts;
    (work < 12.5 ? turn : high) = way;
  }
  for (const bool other_end : {false, true}) {
    std::vector<double> errors;
    for (const int substeps : {8, 16, 32}) {
      Simulation s = test::start(puck(accurate(substeps), flat.friction, other_end));
      double farthest = 0.0;
      while (s.world.state().time < 0.3 - 1e-9) {
        ASSERT_TRUE(s.world.step().ok());
        farthest = std::max(farthest, s.world.position({0}).x() - 10.0);
      }
      errors.push_back(std::abs(farthest - turn));
    }
    // The farthest step is within half a step of the turn: T / m (h / 2)^2 / 2, with T below 1000 N.
    const double step = 1.0 / 60.0;
    EXPECT_LE(errors.back(), 1000.0 / 100.0 * 0.125 * step * step + 1e-6);
  }
  std::vector<Course> courses;
  for (const int substeps : {8, 16, 32, 64}) {
    courses.push_back(run(puck(accurate(substeps), flat.friction), 1.0));
  }
  for (const Course& course : courses) {
    EXPECT_GE(course.least, 0.0);
    EXPECT_GT(course.loss, 1.0);
  }
  for (std::size_t i = 0; i + 1 < courses.size(); ++i) {
    // It becomes taut and slack within a substep, as without friction.
    const double h = 1.0 / (8 << i);
    EXPECT_LE(courses[i].drift, 3.0 * h * h);
  }
}

/// A buoy above an anchor on the floor, lifted by 2500 N more than its weight and pushed away. A soft rope
/// with much friction.
test::Machine buoy(const StepSettings& step, double friction = 0.8, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::lump("buoy", {60.0, 25.0, 0.0}, 500.0));
  m.model.bodies.back().velocity = {1.0, 0.0, 2.0};
  m.model.bodies.back().force = {1500.0, 500.0 * test::g + 2500.0, 0.0};
  m.cables.push_back(moored({10.0, 2e5, 75.0, friction}, from_other_end));
  return m;
}

TEST(FloorFriction, KeepsEnergyAndLossToSecondOrder) {
  // Up to 2.4 s H rises from 760 N to 1500 N, and rope is lifted and slides. The residuals of rounds are
  // below the error of 32 substeps.
  std::vector<Course> courses;
  for (const int substeps : {4, 8, 16, 32}) courses.push_back(run(buoy(accurate(substeps)), 2.4));
  EXPECT_GT(courses[0].loss, 4.0);
  for (std::size_t i = 1; i < courses.size(); ++i) {
    EXPECT_NEAR(courses[i - 1].drift / courses[i].drift, 4.0, 0.4);
    EXPECT_GE(courses[i].least, 0.0);
  }
  const double first = (courses[0].position - courses[1].position).norm();
  const double second = (courses[1].position - courses[2].position).norm();
  EXPECT_NEAR(first / second, 4.0, 0.4);
}

TEST(FloorFriction, KeepsEnergyAndLossWhereRopeIsLaid) {
  // From 2.4 s on rope is laid, at first while it slides. There the mean tension of a substep, in the pose
  // of its end, may find rope that sticks: an error of first order, but only of a share of 2e-5 of the loss.
  // The rest is the error of the same buoy without friction, 0.07 h^2.
  for (const int substeps : {8, 16, 32, 64}) {
    const Course course = run(buoy(accurate(substeps)), 4.0);
    EXPECT_GT(course.loss, 7.0);
    const double h = 1.0 / substeps;
    EXPECT_LE(course.drift, 0.06 * h * h + 2e-5 * course.loss) << substeps;
  }
}

TEST(FloorFriction, MovesTheSameWithAllSolversAndIntegrators) {
  const Vector3 fine = run(buoy(accurate(64)), 1.0).position;
  const Vector3 sweeps =
      run(buoy(step_of(SolverKind::gauss_seidel, IntegratorKind::rattle, 64)), 1.0).position;
  EXPECT_LE((sweeps - fine).norm(), 1e-8);
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    const Vector3 coarse = run(buoy(step_of(solver, IntegratorKind::xpbd, 64)), 1.0).position;
    const Vector3 half = run(buoy(step_of(solver, IntegratorKind::xpbd, 128)), 1.0).position;
    EXPECT_NEAR((coarse - fine).norm() / (half - fine).norm(), 2.0, 0.1);
  }
}

TEST(FloorFriction, MovesTheSameFromTheOtherEnd) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    const Course one = run(buoy(step), 2.0);
    const Course other = run(buoy(step, 0.8, true), 2.0);
    EXPECT_LE((one.position - other.position).norm(), 1e-8);  // residuals of rounds
    EXPECT_NEAR(one.loss, other.loss, 1e-6 * one.loss);
  }
}

TEST(FloorFriction, MovesTheSameTurned) {
  const Course plain = run(buoy(accurate(16)), 2.0);
  for (const Vector3& axis : {Vector3(1.0, 0.0, 0.0), Vector3(1.0, 2.0, -3.0)}) {
    const Quaternion turn(Eigen::AngleAxisd(1.2, axis.normalized()));
    test::Machine m = buoy(accurate(16));
    m.model.gravity = turn * m.model.gravity;
    BodyDef& body = m.model.bodies[0];
    body.position = turn * body.position;
    body.velocity = turn * body.velocity;
    body.force = turn * body.force;
    const Course turned = run(m, 2.0);
    // Rounding of places and residuals of rounds.
    EXPECT_LE((turned.position - turn * plain.position).norm(), 1e-8);
    EXPECT_NEAR(turned.loss, plain.loss, 1e-6 * plain.loss);
  }
}

TEST(FloorFriction, VanishesWithItsCoefficient) {
  // The loss and the force of friction are proportional to the coefficient where little slides.
  const Vector3 without = run(buoy(accurate(16), 0.0), 1.0).position;
  const double first = (run(buoy(accurate(16), 1e-3), 1.0).position - without).norm();
  const double second = (run(buoy(accurate(16), 5e-4), 1.0).position - without).norm();
  EXPECT_NEAR(first / second, 2.0, 0.05);
}

TEST(FloorFriction, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    for (const test::Machine& m :
         {buoy(step), buoy(step, 0.8, true), puck(step, 0.5), puck(step, 0.5, true)}) {
      const Certificate told = test::checked_run(m, 1.0);
      EXPECT_TRUE(told.clean()) << (told.clean() ? "" : told.worst()->sentence());
      EXPECT_FALSE(test::checked_run(m, 1.0, 0.3, 2.0).clean());
    }
  }
}

/// A drum with inertia on a quay, whose rope lies on the floor up to an anchor, and a load that turns it.
test::Machine winch(const StepSettings& step, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef drum = test::wheel("drum", {30.0, 8.0, 0.0}, 0.5, 40.0);
  m.model.add(drum);
  m.model.bodies.back().angular_velocity = {0.0, 0.0, -1.0};
  SpoolLink spool;
  spool.body = {0};
  spool.winding = from_other_end ? test::left : test::right;
  spool.stored_length = 5.0;
  const auto end = std::make_shared<SpoolLink>(spool);
  const auto anchor = attach(BodyId::world());
  CableDef rope = from_other_end ? cable("rope", {end, anchor}) : cable("rope", {anchor, end});
  rope.linear_density = 5.0;
  rope.axial_stiffness = 1e5;
  rope.rest_lengths = {34.0};
  rope.floor = 0.0;
  rope.floor_friction = 0.7;
  m.cables.push_back(rope);
  return m;
}

TEST(FloorFriction, HoldsRopeThatADrumHauls) {
  std::vector<double> angles;
  for (const int substeps : {16, 32, 64}) {
    Simulation s = test::start(winch(accurate(substeps)));
    const double before = s.world.energy().total();
    double drift = 0.0;
    while (s.world.state().time < 1.5 - 1e-9) {
      ASSERT_TRUE(s.world.step().ok());
      const CableReport report = s.cable_reports()[0];
      drift = std::max(drift, std::abs(s.world.energy().total() + report.creep_loss +
                                       report.floor_loss - before));
    }
    angles.push_back(s.cable_reports()[0].spans[0].rest_length);
    EXPECT_GT(s.cable_reports()[0].floor_loss, 0.0);
    EXPECT_LE(drift, 1e-4 * std::abs(before) / substeps);
  }
  EXPECT_NEAR((angles[0] - angles[1]) / (angles[1] - angles[2]), 4.0, 1.0);
  for (const bool other_end : {false, true}) {
    const Certificate told = test::checked_run(winch(accurate(16), other_end), 1.0);
    EXPECT_TRUE(told.clean()) << (told.clean() ? "" : told.worst()->sentence());
  }
}

TEST(FloorFriction, HoldsRopeThatPassesAnEye) {
  // A load lifts and lowers itself on rope through an eye above the floor.
  std::vector<Course> courses;
  for (const int substeps : {16, 32, 64}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = accurate(substeps);
    m.model.add(test::weight("load", {20.0, 4.0, 0.0}, 60.0));
    PinholeLink eye;
    eye.point = {20.0, 8.0, 0.0};
    CableDef rope =
        cable("rope", {attach(BodyId::world()), std::make_shared<PinholeLink>(eye), attach({0})});
    rope.linear_density = 2.0;
    rope.axial_stiffness = 2e4;
    rope.floor = 0.0;
    rope.floor_friction = 0.6;
    rope.rest_lengths = {22.3, 3.9};
    m.cables.push_back(rope);
    courses.push_back(run(m, 1.0));
  }
  EXPECT_NEAR((courses[0].position - courses[1].position).norm() /
                  (courses[1].position - courses[2].position).norm(),
              4.0, 1.0);
  EXPECT_LE(courses[2].drift, 0.3 * courses[1].drift);
}

TEST(FloorFriction, IsSavedAndRestoredBitForBit) {
  const test::Machine m = buoy(accurate(8));
  Simulation s = test::start(m);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
  const State saved = s.world.state();
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
  Simulation other = test::start(m);
  ASSERT_TRUE(other.world.restore(saved).empty());
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(s.world.position({0}), other.world.position({0}));
  EXPECT_EQ(s.cable_reports()[0].floor_loss, other.cable_reports()[0].floor_loss);
}

void expect_refused(const test::Machine& m, const std::string& word) {
  const auto made = Simulation::create(m.model, m.cables);
  ASSERT_FALSE(made);
  EXPECT_NE(made.errors()[0].message.find(word), std::string::npos) << made.errors()[0].message;
}

TEST(FloorFriction, RefusesWhatItCannotHold) {
  test::Machine m = buoy(accurate(4));
  m.cables[0].floor.reset();
  expect_refused(m, "friction needs a floor");
  m = buoy(accurate(4), -0.1);
  expect_refused(m, "floor_friction");
  m = buoy(accurate(4), std::nan(""));
  expect_refused(m, "floor_friction");
  m = buoy(accurate(4));
  m.cables[0].floor = -1.0;
  expect_refused(m, "anchor on the floor");
  m = buoy(accurate(4));
  m.cables[0].damping = 10.0;
  expect_refused(m, "damper");
  // A span between two links above the floor would lie on it.
  m = buoy(accurate(4));
  m.model.add(test::lump("second", {100.0, 20.0, 0.0}, 500.0));
  m.cables[0].links.push_back(attach({1}));
  m.cables[0].rest_lengths = {75.0, 80.0};
  expect_refused(m, "span 1");
}

TEST(FloorFriction, EndsWhereAnotherSpanComesToLie) {
  test::Machine m = buoy(accurate(4));
  m.model.bodies[0].force.y() = 500.0 * test::g + 3000.0;
  m.model.add(test::lump("second", {100.0, 20.0, 0.0}, 50.0));
  m.cables[0].links.push_back(attach({1}));
  m.cables[0].rest_lengths = {75.0, 41.0};
  Simulation s = test::start(m);
  StepReport report;
  for (int i = 0; i < 400 && report.ok(); ++i) report = s.world.step();
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.divergence->message.find("span 1"), std::string::npos)
      << report.divergence->message;
}

}  // namespace
}  // namespace sheave::floor_friction
