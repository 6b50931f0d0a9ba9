// The motion of ropes with weight over wheels and drums (cable/cable_weight.cpp).

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"
#include "tests/support/rope_steps.h"

namespace sheave::heavy_wheels {
namespace {

using test::accurate;
using test::attach;
using test::cable;
using test::roll;
using test::step_of;

/// Two weights of 10 kg, 20 m and 22 m below a wheel of 0.5 m, on a rope of 1 kg/m.
test::Machine atwood(const StepSettings& step) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::wheel("wheel", Vector3::Zero(), 0.5, 0.125));
  m.model.add(test::weight("light", {-0.5, -20.0, 0.0}, 10.0));
  m.model.add(test::weight("heavy", {0.5, -22.0, 0.0}, 10.0));
  CableDef rope = cable("rope", {attach({1}), roll({0}, test::right), attach({2})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e7;
  // At the chord tensions, which are those in the middle of the spans: the weights and half a span.
  rope.pretensions = {20.0 * test::g, 21.0 * test::g};
  m.cables.push_back(rope);
  return m;
}

/// A rope of 1 kg/m over two wheels 40 m apart, with weights at its ends.
test::Machine ropeway(const StepSettings& step, bool from_other_end = false) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::wheel("first", Vector3::Zero(), 1.0, 5.0));
  m.model.add(test::wheel("second", {40.0, 3.0, 0.0}, 1.5, 5.0));
  m.model.add(test::weight("left", {-1.0, -20.0, 0.0}, 100.0));
  m.model.add(test::weight("right", {41.5, -20.0, 0.0}, 103.0));
  const auto first = from_other_end ? test::left : test::right;
  CableDef rope =
      from_other_end
          ? cable("rope", {attach({3}), roll({1}, first), roll({0}, first), attach({2})})
          : cable("rope", {attach({2}), roll({0}, first), roll({1}, first), attach({3})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e6;
  // Nearly balanced: the weights and the rope below the middles of the spans.
  rope.pretensions = {110.0 * test::g, 122.0 * test::g, 114.5 * test::g};
  if (from_other_end) std::swap(rope.pretensions.front(), rope.pretensions.back());
  m.cables.push_back(rope);
  return m;
}

/// A sheave in a block of 100 kg that moves in the plane, between a fixed end and a wheel, with a
/// swinging weight at the other end of the rope.
test::Machine block(const StepSettings& step) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef body = test::lump("block", {0.5, -20.0, 0.0}, 100.0);
  body.mobility = Mobility::planar;
  body.axis = Vector3::UnitZ();
  m.model.add(body);
  m.model.add(test::sheave("sheave", {0}, {0.5, -20.0, 0.0}, 0.5, 10.0, 1.25));
  m.model.add(test::wheel("top", {1.5, 0.0, 0.0}, 0.5, 1.25));
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
  /// Largest change of the sum of the energy and the loss by creep of the rope on its wheels [J].
  double drift = 0.0;
  double length_error = 0.0;  ///< of the cable at the end
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

TEST(HeavyRopeOnWheels, RunsOverByTheHyperbolicCosine) {
  // The weights differ by 2 rho g x for the displacement x from the middle, 1 m at the start, and the
  // rope has no inertia: (m1 + m2 + I / r^2) x'' = 2 rho g x.
  const double rate = std::sqrt(2.0 * test::g / (20.0 + 0.125 / 0.25));
  const Course course = run(atwood(accurate(16)), 1, 1.0);
  // The pretension leaves out the acceleration, so both spans begin with vibrations of
  // m a / k = 10 kg x 1 m/s2 x 20 m / EA = 2e-5 m, which average out to that.
  EXPECT_NEAR(course.position.y() + 20.0, std::cosh(rate) - 1.0, 6e-5);
  EXPECT_EQ(course.length_error, 0.0);
}

TEST(HeavyRopeOnWheels, KeepsTheEnergyToSecondOrder) {
  // The pretension leaves out the acceleration, so the spans vibrate.
  std::vector<Course> courses;
  for (const int substeps : {4, 16, 64}) {
    test::Machine m = atwood(accurate(substeps));
    m.cables[0].axial_stiffness = 1e8;
    courses.push_back(run(m, 1, 0.5));
  }
  // The next order changes the ratio of 16 by a share of (h w)^2 with the vibrations of the weights,
  // some 700 rad/s.
  for (std::size_t i = 1; i < courses.size(); ++i) {
    EXPECT_GT(courses[i - 1].drift / courses[i].drift, 10.0) << courses[i].drift;
    EXPECT_EQ(courses[i].length_error, 0.0);
  }
  // A rope that sags between wheels keeps 1e-10 of 45 kJ in 480 substeps.
  EXPECT_LE(run(ropeway(accurate(16)), 3, 0.5).drift, 1e-10 * 45e3);
}

TEST(HeavyRopeOnWheels, MovesTheSameFromTheOtherEnd) {
  const Vector3 one = run(ropeway(accurate(16)), 3, 0.5).position;
  const Vector3 other = run(ropeway(accurate(16), true), 3, 0.5).position;
  // Residuals of 1e-10 of the length in 480 substeps.
  EXPECT_LE((one - other).norm(), 1e-6);
}

TEST(HeavyRopeOnWheels, MovesTheSameWithAllSolversAndIntegrators) {
  const Vector3 fine = run(atwood(accurate(64)), 2, 0.5).position;
  const Vector3 sweeps =
      run(atwood(step_of(SolverKind::gauss_seidel, IntegratorKind::rattle, 64)), 2, 0.5).position;
  // Sweeps end at residuals of 50 iterations, 1e-8 of the spans.
  EXPECT_LE((sweeps - fine).norm(), 1e-5);
  // `xpbd` is of first order: half of the substep, half of the error.
  const auto rough = [&](int substeps) {
    const StepSettings step = step_of(SolverKind::direct, IntegratorKind::xpbd, substeps);
    return (run(atwood(step), 2, 0.5).position - fine).norm();
  };
  EXPECT_NEAR(rough(16) / rough(32), 2.0, 0.2);
}

TEST(HeavyRopeOnWheels, CarriesABlockThatMoves) {
  const Course course = run(block(accurate(16)), 0, 1.0);
  // The bob swings and falls 1 m: 600 J change hands, and the energy keeps a millionth of them.
  EXPECT_LE(course.drift, 6e-4);
  EXPECT_GT((course.position - Vector3(0.5, -20.0, 0.0)).norm(), 0.1);
}

TEST(HeavyRopeOnWheels, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const StepSettings step = step_of(SolverKind::direct, integrator, 16);
    for (const test::Machine& m : {ropeway(step), block(step), atwood(step)}) {
      EXPECT_TRUE(test::checked_run(m, 0.25).clean());
    }
    // A weight that suddenly has twice its velocity is seen.
    EXPECT_FALSE(test::checked_run(atwood(step), 0.6, 0.5, 2.0).clean());
  }
}

TEST(HeavyRopeOnWheels, BecomesARopeWithoutWeight) {
  test::Machine light = ropeway(accurate(16));
  light.cables[0].linear_density = 1e-7;
  test::Machine none = light;
  none.cables[0].linear_density = 0.0;
  // Weights of 1e-8 of the tensions change accelerations of 1 m/s2 by as much.
  EXPECT_LE((run(light, 3, 1.0).position - run(none, 3, 1.0).position).norm(), 1e-6);
}

/// A load of 100 kg, 10 m below a drum that turns freely, with 50 m of rope of 2 kg/m on it.
test::Machine hoist(const StepSettings& step) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(test::wheel("drum", Vector3::Zero(), 0.5, 50.0));
  m.model.add(test::weight("load", {0.5, -10.0, 0.0}, 100.0));
  auto drum = std::make_shared<SpoolLink>();
  drum->body = BodyId{0};
  drum->winding = test::right;
  drum->stored_length = 50.0;
  CableDef rope = cable("rope", {drum, attach({1})});
  rope.linear_density = 2.0;
  rope.axial_stiffness = 1e7;
  rope.pretension = 110.0 * test::g;
  m.cables.push_back(rope);
  return m;
}

TEST(HeavyRopeOnDrums, UnwindsByTheHyperbolicCosine) {
  // The stored rope weighs at the axle, so (m + I / r^2) x'' = (m + rho x) g for the free length x,
  // which begins at 10 m: x + m / rho = (10 m + m / rho) cosh(k t), k^2 = rho g / (m + I / r^2).
  const double rate = std::sqrt(2.0 * test::g / (100.0 + 50.0 / 0.25));
  const Course course = run(hoist(accurate(16)), 1, 1.0);
  // The vibration of the start has m a L / EA = 100 kg x 4 m/s2 x 12 m / 1e7 N = 5e-4 m, of which
  // the load's acceleration keeps the change of stretch; the strain of stored rope is as much.
  EXPECT_NEAR(-course.position.y(), 60.0 * std::cosh(rate) - 50.0, 1.5e-3);
  EXPECT_EQ(course.length_error, 0.0);
  // 750 J of weight become motion.
  EXPECT_LE(course.drift, 750e-6);
  EXPECT_TRUE(test::checked_run(hoist(accurate(16)), 1.0).clean());
}

/// The first message with which a machine is refused.
std::string refusal(const test::Machine& machine) {
  const auto made = Simulation::create(machine.model, machine.cables);
  return made ? "" : made.errors()[0].message;
}

TEST(HeavyRopeOnWheels, RefusesOtherLinksByName) {
  const auto with = [&](const auto& change) {
    test::Machine m = ropeway(accurate(4));
    change(m);
    return refusal(m);
  };
  const auto rolling = [](test::Machine& m) {
    auto link = std::make_shared<RollingLink>(*roll({0}, test::right));
    m.cables[0].links[1] = link;
    return link;
  };
  EXPECT_NE(with([&](test::Machine& m) { rolling(m)->friction = 0.2; }).find("does not slide"),
            std::string::npos);
  EXPECT_NE(with([&](test::Machine& m) {
              m.model.bodies[0].spin_inertia = 0.0;
              rolling(m)->efficiency = 0.9;
            }).find("leave efficiency, bending_loss and bearing_friction out"),
            std::string::npos);
  EXPECT_NE(with([&](test::Machine& m) {
              m.model.bodies[0].spin_inertia = 0.0;
              m.cables[0].axial_damping = 100.0;
            }).find("without a damper only"),
            std::string::npos);
  EXPECT_NE(with([&](test::Machine& m) {
              m.model.gravity = {0.0, -9.0, 1.0};
            }).find("vertical plane"),
            std::string::npos);
  EXPECT_NE(with([&](test::Machine& m) {
              m.model.bodies[2] = test::lump("left", {-1.0, -20.0, 0.0}, 100.0);
            }).find("mobility \"planar\""),
            std::string::npos);
  EXPECT_NE(with([&](test::Machine& m) {
              auto hole = std::make_shared<PinholeLink>();
              hole->body = BodyId::world();
              hole->friction = 0.1;
              m.cables[0].links[1] = hole;
            }).find("passes pinholes freely"),
            std::string::npos);
}

/// A block of 50 kg with a sheave below a level rope, which only the start of the run bends over the
/// sheave: the block falls with 2 m/s, and below the line between both fixed ends nothing holds the
/// rope on the sheave.
test::Machine falling_block(const StepSettings& step, double density, double stiffness) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  BodyDef block = test::weight("block", {5.0, 0.6, 0.0}, 50.0);
  block.velocity = {0.0, -2.0, 0.0};
  m.model.add(block);
  m.model.add(test::sheave("wheel", {0}, {5.0, 0.6, 0.0}, 0.3, 10.0, 0.45));
  CableDef rope = cable("rope", {attach(BodyId::world(), {0.0, 0.0, 0.0}), roll({1}, test::right),
                                 attach(BodyId::world(), {10.0, 0.0, 0.0})});
  rope.linear_density = density;
  rope.axial_stiffness = stiffness;
  m.cables.push_back(rope);
  return m;
}

/// Depth of a level rope of this length between ends 10 m apart [m]: L = 2 a sinh(5 / a).
double sag_of(double length) {
  double low = 1.0;
  double high = 1e3;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (2.0 * a * std::sinh(5.0 / a) > length ? low : high) = a;
  }
  return low * (std::cosh(5.0 / low) - 1.0);
}

TEST(HeavyRopeOnWheels, EndsTheRunWhereItWouldLeaveItsWheel) {
  for (const double stiffness : {1e6, 1e8}) {
    for (const int substeps : {1, 4, 16}) {
      for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
        Simulation s = test::start(
            falling_block(step_of(SolverKind::direct, integrator, substeps), 1.0, stiffness));
        StepReport report;
        for (int i = 0; i < 60 && report.ok(); ++i) report = s.world.step();
        ASSERT_FALSE(report.ok());
        const std::string& message = report.divergence->message;
        EXPECT_NE(message.find("has left the wheel of link 1 on \"wheel\""), std::string::npos)
            << message;
        // The rope hangs freely there, with the sheave in its lowest point. The state is that of
        // the substep before, and the tension may be the mean over a substep, so the event is up to
        // a substep early or late, in which the block falls by 6.5 m/s x h at most. A strain of
        // 1e-4 lengthens the rope by 1 mm, and deepens its sag by 3 mm.
        const double fall = 6.5 / 60.0 / substeps;
        const double top = s.world.position({0}).y() + 0.3;
        EXPECT_NEAR(top, -sag_of(s.cable_reports()[0].total_length), 0.005 + fall);
      }
    }
  }
}

TEST(HeavyRopeOnWheels, LeavesItsWheelWithoutWeight) {
  Simulation s = test::start(falling_block(accurate(4), 0.0, 1e6));
  for (int i = 0; i < 24; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_FALSE(s.cable_reports()[0].links[1].touched);
}

TEST(HeavyRopeOnWheels, EndsTheRunIfGravityLeavesThePlane) {
  Simulation s = test::start(atwood(accurate(4)));
  ASSERT_TRUE(s.world.step().ok());
  ASSERT_TRUE(s.world.set_gravity({0.5, -9.0, 0.0}).empty());
  ASSERT_TRUE(s.world.step().ok()) << "turned in the plane";
  ASSERT_TRUE(s.world.set_gravity({0.0, -9.0, 0.1}).empty());
  const StepReport report = s.world.step();
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.divergence->message.find("gravity has left the plane of the wheel of link 1"),
            std::string::npos)
      << report.divergence->message;
}

// A drive without a limit unwinds the drum, winds the rope on the other way round, and draws the load
// against the drum, until the span has no length left. The certificate tells, and comes to an end.
TEST(HeavyRopeOnDrums, ACheckOfASpanWithoutLengthComesToAnEnd) {
  test::Machine m = hoist(step_of(SolverKind::direct, IntegratorKind::rattle, 1));
  m.model.bodies[0].drive = DriveKind::speed;
  m.model.bodies[0].drive_values = {0.0, -4.0, -4.0};
  m.model.bodies[0].drive_times = {0.0, 1.0, 5.0};
  m.model.bodies[1].position.y() = -3.0;
  auto drum = std::make_shared<SpoolLink>();
  drum->body = BodyId{0};
  drum->winding = test::right;
  drum->stored_length = 1.0;
  m.cables[0].links[0] = drum;
  m.cables[0].axial_stiffness = 1e6;
  Simulation s = test::start(m);
  bool doubtful = false;
  double least = 3.0;
  for (int i = 0; i < 240 && s.world.step().ok(); ++i) {
    const auto certificate = s.certificate();
    doubtful = doubtful || (certificate && !certificate->clean());
    least = std::min(least, s.cable_reports()[0].spans[0].rest_length);
  }
  EXPECT_LT(least, 0.1);
  EXPECT_TRUE(doubtful);
}

}  // namespace
}  // namespace sheave::heavy_wheels
