// The motion of ropes with weight over massless wheels and through pinholes (cable/heavy_runs.cpp).

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/pinhole.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/rope_steps.h"

namespace sheave::heavy_runs {
namespace {

using test::accurate;
using test::attach;
using test::cable;
using test::roll;
using test::step_of;

using Link = std::shared_ptr<const LinkDef>;

Link hole(BodyId body, const Vector3& point) {
  auto link = std::make_shared<PinholeLink>();
  link->body = body;
  link->point = point;
  return link;
}

BodyDef without_inertia(BodyDef wheel) {
  wheel.spin_inertia = 0.0;
  return wheel;
}

enum class Over { wheel, eye };

/// Two weights of 10 kg, 20 m and 22 m below a massless wheel of 0.5 m or an eye, on a rope of 1 kg/m.
test::Machine atwood(const StepSettings& step, Over over, double density = 1.0) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(without_inertia(test::wheel("wheel", Vector3::Zero(), 0.5, 1.0)));
  const double beside = over == Over::wheel ? 0.5 : 0.0;
  m.model.add(test::weight("light", {-beside, -20.0, 0.0}, 10.0));
  m.model.add(test::weight("heavy", {beside, -22.0, 0.0}, 10.0));
  const Link between =
      over == Over::wheel ? Link(roll({0}, test::right)) : hole(BodyId::world(), Vector3::Zero());
  CableDef rope = cable("rope", {attach({1}), between, attach({2})});
  rope.linear_density = density;
  rope.axial_stiffness = 1e7;
  rope.pretension = (10.0 + 10.5 * density) * test::g;
  m.cables.push_back(rope);
  return m;
}

/// A rope of 1 kg/m over a massless wheel and through an eye 40 m apart, with weights at its ends.
test::Machine ropeway(const StepSettings& step, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(without_inertia(test::wheel("first", Vector3::Zero(), 1.0, 1.0)));
  m.model.add(test::weight("left", {-1.0, -20.0, 0.0}, 100.0));
  m.model.add(test::weight("right", {40.0, -20.0, 0.0}, 103.0));
  const Link eye = hole(BodyId::world(), {40.0, 3.0, 0.0});
  CableDef rope = from_other_end
                      ? cable("rope", {attach({2}), eye, roll({0}, test::left), attach({1})})
                      : cable("rope", {attach({1}), roll({0}, test::right), eye, attach({2})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e6;
  rope.pretension = 115.0 * test::g;
  m.cables.push_back(rope);
  return m;
}

/// A massless sheave in a block of 100 kg that moves in the plane, between a fixed end and another one,
/// with a swinging weight at the other end of the rope.
test::Machine block(const StepSettings& step) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef body = test::lump("block", {0.5, -20.0, 0.0}, 100.0);
  body.mobility = Mobility::planar;
  body.axis = Vector3::UnitZ();
  m.model.add(body);
  m.model.add(without_inertia(test::sheave("sheave", {0}, {0.5, -20.0, 0.0}, 0.5, 10.0, 1.25)));
  m.model.add(without_inertia(test::wheel("top", {1.5, 0.0, 0.0}, 0.5, 1.25)));
  BodyDef bob = test::lump("bob", {2.2, -10.0, 0.0}, 60.0);
  bob.mobility = Mobility::planar;
  bob.axis = Vector3::UnitZ();
  m.model.add(bob);
  CableDef rope = cable("rope", {attach(BodyId::world()), roll({1}, test::left),
                                 roll({2}, test::right), attach({3})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e6;
  rope.pretension = 650.0;
  m.cables.push_back(rope);
  return m;
}

struct Course {
  Vector3 position = Vector3::Zero();
  double drift = 0.0;  ///< largest change of the sum of energy and loss by creep [J]
  double length_error = 0.0;
};

Course run(const test::Machine& machine, int body, double time) {
  Simulation s = test::start(machine);
  const double before = s.world.energy().total();
  Course course;
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    if (!report.ok()) {
      ADD_FAILURE() << report.divergence->message;
      break;
    }
    const double crept = s.cable_reports()[0].creep_loss;
    course.drift = std::max(course.drift, std::abs(s.world.energy().total() + crept - before));
  }
  course.position = s.world.position({body});
  course.length_error = s.cable_reports()[0].length_error;
  return course;
}

TEST(HeavyRun, RunsOverAWheelAndAnEyeByTheHyperbolicCosine) {
  // The weights differ by 2 rho g x for the displacement x from the middle, 1 m at the start, and
  // neither rope nor wheel has inertia: (m1 + m2) x'' = 2 rho g x.
  const double rate = std::sqrt(2.0 * test::g / 20.0);
  for (const Over over : {Over::wheel, Over::eye}) {
    for (const int substeps : {1, 16, 64}) {
      const Course course = run(atwood(accurate(substeps), over), 1, 1.0);
      // The pretension leaves out the acceleration, so the run begins with a vibration of m a / k =
      // 10 kg x 1 m/s2 x 42 m / EA = 4e-5 m, which the weights share, and which averages out to that.
      EXPECT_NEAR(course.position.y() + 20.0, std::cosh(rate) - 1.0, 6e-5) << substeps;
      EXPECT_EQ(course.length_error, 0.0);
    }
  }
}

TEST(HeavyRun, KeepsTheEnergyToSecondOrder) {
  // The pretension leaves out the acceleration, so the rope vibrates.
  for (const Over over : {Over::wheel, Over::eye}) {
    std::vector<Course> courses;
    for (const int substeps : {4, 16, 64}) {
      test::Machine m = atwood(accurate(substeps), over);
      m.cables[0].axial_stiffness = 1e8;
      // A fall that leans sags, and a change of its tension draws rope through the eye.
      if (over == Over::eye) m.model.bodies[1].position.x() = -8.0;
      courses.push_back(run(m, 1, 0.5));
      EXPECT_EQ(courses.back().length_error, 0.0);
    }
    // A ratio of 16 for four times as many substeps. The next order changes it by a share of (h w)^2
    // with the vibrations of the weights, some 700 rad/s.
    for (std::size_t i = 1; i < courses.size(); ++i) {
      EXPECT_GT(courses[i - 1].drift / courses[i].drift, 10.0) << courses[i].drift;
    }
  }
  // A rope that sags between wheel and eye keeps 1e-9 of 45 kJ in 480 substeps.
  EXPECT_LE(run(ropeway(accurate(16)), 2, 0.5).drift, 1e-9 * 45e3);
}

TEST(HeavyRun, MovesToSecondOrder) {
  const auto place = [](int substeps) {
    return run(ropeway(accurate(substeps)), 2, 0.25).position.y();
  };
  const double fine = place(256);
  EXPECT_NEAR((place(8) - fine) / (place(16) - fine), 4.0, 0.4);
}

TEST(HeavyRun, MovesTheSameFromTheOtherEnd) {
  const auto apart = [](int substeps) {
    return (run(ropeway(accurate(substeps)), 1, 0.5).position -
            run(ropeway(accurate(substeps), true), 1, 0.5).position)
        .norm();
  };
  // Each end counts the chord tension of its own span, so both differ by the second order of the step
  // in the change of the lifts.
  EXPECT_LE(apart(16), 1e-6);
}

TEST(HeavyRun, MovesTheSameInATurnedWorld) {
  test::Machine turned = ropeway(accurate(4));
  turned.model.gravity = {test::g, 0.0, 0.0};
  const auto turn = [](const Vector3& v) { return Vector3(-v.y(), v.x(), v.z()); };
  for (BodyDef& body : turned.model.bodies) {
    body.position = turn(body.position);
    if (body.mobility == Mobility::slider) body.axis = turn(*body.axis);
  }
  turned.cables[0].links[2] = hole(BodyId::world(), turn({40.0, 3.0, 0.0}));
  const Vector3 there = run(turned, 2, 0.5).position;
  const Vector3 here = run(ropeway(accurate(4)), 2, 0.5).position;
  // Residuals of 1e-10 of the length in 120 substeps.
  EXPECT_LE((there - turn(here)).norm(), 1e-7);
}

TEST(HeavyRun, MovesTheSameWithAllSolversAndIntegrators) {
  for (const Over over : {Over::wheel, Over::eye}) {
    const auto place = [&](SolverKind solver, IntegratorKind integrator, int substeps) {
      return run(atwood(step_of(solver, integrator, substeps), over), 2, 0.5).position;
    };
    const Vector3 fine = place(SolverKind::direct, IntegratorKind::rattle, 64);
    // `xpbd` is of first order: half of the substep, half of the error.
    const auto rough = [&](SolverKind solver, int substeps) {
      return (place(solver, IntegratorKind::xpbd, substeps) - fine).norm();
    };
    EXPECT_NEAR(rough(SolverKind::direct, 16) / rough(SolverKind::direct, 32), 2.0, 0.2);
    // Sweeps end at residuals of 50 iterations.
    EXPECT_NEAR(rough(SolverKind::gauss_seidel, 16), rough(SolverKind::direct, 16), 1e-5);
  }
}

TEST(HeavyRun, CarriesABlockThatMoves) {
  const Course course = run(block(accurate(16)), 0, 1.0);
  // The bob swings and falls 1 m: 600 J change hands, and the energy keeps a millionth of them.
  EXPECT_LE(course.drift, 6e-4);
  EXPECT_GT((course.position - Vector3(0.5, -20.0, 0.0)).norm(), 0.1);
}

TEST(HeavyRun, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    for (const test::Machine& m : {ropeway(step), ropeway(step, true), block(step),
                                   atwood(step, Over::wheel), atwood(step, Over::eye)}) {
      EXPECT_TRUE(test::checked_run(m, 0.25).clean());
    }
    // A weight that suddenly is faster by a tenth is seen.
    EXPECT_FALSE(test::checked_run(atwood(step, Over::eye), 0.6, 0.5, 1.1).clean());
  }
}

TEST(HeavyRun, TendsToARopeWithoutWeightByItsWeight) {
  for (const Over over : {Over::wheel, Over::eye}) {
    const auto place = [&](double density) {
      return run(atwood(accurate(4), over, density), 2, 0.5).position.y();
    };
    const double none = place(0.0);
    const double little = place(1e-5) - none;
    const double more = place(1e-4) - none;
    // x'' = 2 rho g x / (m1 + m2): in half a second rho 2 g (1 m) / 20 kg x 0.125 s2.
    EXPECT_NEAR(more, -1e-4 * 0.125 * 2.0 * test::g / 20.0, 2e-7);
    EXPECT_NEAR(more / little, 10.0, 0.1);
  }
}

TEST(HeavyRun, TendsToAStiffRope) {
  const auto place = [](double stiffness) {
    test::Machine m = ropeway(accurate(4));
    m.cables[0].axial_stiffness = stiffness;
    return run(m, 2, 0.5).position.y();
  };
  const double stiff = place(1e11);
  // The strain of 1150 N on 85 m, and of the load that it carries: 1e-1 m at 1e6 N.
  EXPECT_NEAR(place(1e9), stiff, 1e-3);
  EXPECT_NEAR(place(1e10), stiff, 1e-4);
}

/// A level span of 20 m between a fixed end and an eye, with a tail of 4 m that only hangs.
test::Machine tail(const StepSettings& step, double mass) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::weight("tail", {20.0, -4.0, 0.0}, mass));
  CableDef rope = cable(
      "rope", {attach(BodyId::world()), hole(BodyId::world(), {20.0, 0.0, 0.0}), attach({0})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e6;
  rope.pretension = (mass + 2.0) * test::g;
  m.cables.push_back(rope);
  return m;
}

TEST(HeavyRun, EndsWhereItsWeightPullsTheRopeThrough) {
  // The least end tension of the level span is 0.754 w x = 15.1 kg g; the tail gives mass + 4 kg.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {1, 16}) {
      const StepSettings step = step_of(SolverKind::direct, integrator, substeps);
      Simulation s = test::start(tail(step, 6.0));
      StepReport report;
      for (int i = 0; i < 300 && report.ok(); ++i) report = s.world.step();
      ASSERT_FALSE(report.ok());
      EXPECT_NE(report.divergence->message.find("pulls the rope through"), std::string::npos)
          << report.divergence->message;
      EXPECT_NE(report.divergence->message.find("link 1 on \"world\""), std::string::npos);
    }
  }
}

TEST(HeavyRun, StaysWhereItsTailIsHeavyEnough) {
  const Course course = run(tail(accurate(16), 20.0), 0, 2.0);
  EXPECT_NEAR(course.position.y(), -4.0, 1.0);
  EXPECT_EQ(course.length_error, 0.0);
}

}  // namespace
}  // namespace sheave::heavy_runs
