// The second-order integrator: orders, energy, springs, impacts.

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "engine/joints/ball.h"
#include "engine/joints/distance.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::right;
using test::roll;

void use(test::Machine& m, IntegratorKind integrator, double h) {
  m.model.step = test::settings(h, 1, 30);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
}

/// Some numbers of a simulation at `time`, with steps of `h`.
using Probe = std::function<std::vector<double>(const Simulation&)>;
std::vector<double> at_time(test::Machine m, IntegratorKind integrator, double h, double time,
                            const Probe& probe) {
  use(m, integrator, h);
  Simulation s = test::start(m);
  const auto steps = static_cast<int>(std::lround(time / h));
  for (int i = 0; i < steps; ++i) {
    const StepReport report = s.world.step();
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.integrator_fallbacks, 0);
  }
  return probe(s);
}

/// Order of convergence of the worst of the numbers, from h, h / 2 and h / 4: differences of
/// successive ones fall by 2^order (Richardson).
double order(const test::Machine& m, IntegratorKind integrator, double h, double time,
             const Probe& probe) {
  std::vector<std::vector<double>> results;
  for (const double step : {h, 0.5 * h, 0.25 * h}) {
    results.push_back(at_time(m, integrator, step, time, probe));
  }
  double coarse = 0.0;
  double fine = 0.0;
  for (std::size_t i = 0; i < results[0].size(); ++i) {
    coarse = std::max(coarse, std::abs(results[0][i] - results[1][i]));
    fine = std::max(fine, std::abs(results[1][i] - results[2][i]));
  }
  return std::log2(coarse / fine);
}

void expect_orders(const test::Machine& m, double h, double time, const Probe& probe) {
  const double second = order(m, IntegratorKind::rattle, h, time, probe);
  EXPECT_GE(second, 1.9);
  EXPECT_LE(second, 2.1);
  const double first = order(m, IntegratorKind::xpbd, 0.1 * h, time, probe);
  EXPECT_GE(first, 0.9);
  EXPECT_LE(first, 1.1);
}

std::vector<double> position_of(const Simulation& s, BodyId body) {
  const Vector3 x = s.world.position(body);
  return {x.x(), x.y(), x.z()};
}

TEST(Rattle, PendulumOnACable) {
  const test::Machine m = test::cable_pendulum(1.0, 1.0, 1.0);
  expect_orders(m, 0.02, 1.0, [](const Simulation& s) { return position_of(s, {0}); });
}

TEST(Rattle, CableThatUnwinds) {
  const test::Machine m = test::involute();
  const auto probe = [](const Simulation& s) { return position_of(s, {1}); };
  expect_orders(m, 0.02, 1.0, probe);
  // Speed is constant, since the cable pulls across the path; l dl = r v dt gives the length.
  Simulation s = test::start(m);
  test::Machine fine = m;
  use(fine, IntegratorKind::rattle, 0.001);
  s = test::start(fine);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_NEAR(s.world.velocity({1}).norm(), 1.0, 1e-7);
  EXPECT_NEAR(s.cable_reports()[0].spans[0].length, std::sqrt(1.0 + 2.0 * 0.2), 1e-6);
}

TEST(Rattle, SwayingTackleWithMountedSheaves) {
  test::Tackle tackle{.strands = 4, .effort = 3.0, .block_mobility = Mobility::planar};
  test::Machine m = tackle.machine();
  m.model.bodies[0].velocity = {0.3, 0.0, 0.0};
  expect_orders(m, 0.02, 0.4, [](const Simulation& s) {
    std::vector<double> x = position_of(s, {0});
    x.push_back(s.world.position({1}).y());
    x.push_back(s.world.state().bodies[0].angle);
    return x;
  });
}

TEST(Rattle, TensionAtTheMiddleOfTheStep) {
  // A pendulum's tension m (g cos a + v^2 / l) = m g (3 cos a - 2 cos a0), with the angle at the
  // middle of the last step from the mean of the positions at its ends (its error is of second
  // order, too).
  const auto error = [](double h) {
    test::Machine m = test::cable_pendulum(1.0, 1.0, 1.0);
    use(m, IntegratorKind::rattle, h);
    Simulation s = test::start(m);
    Vector3 before = Vector3::Zero();
    for (int i = 0; i < static_cast<int>(std::lround(0.4 / h)); ++i) {
      before = s.world.position({0});
      EXPECT_TRUE(s.world.step().ok());
    }
    const Vector3 middle = 0.5 * (before + s.world.position({0}));
    const double expected = g * (3.0 * -middle.y() / middle.norm() - 2.0 * std::cos(1.0));
    return std::abs(s.cable_reports()[0].spans[0].tension - expected);
  };
  const double slope = std::log2(error(0.005) / error(0.0025));
  EXPECT_GE(slope, 1.9);
  EXPECT_LE(slope, 2.1);
}

TEST(Rattle, HingedChainInSpace) {
  expect_orders(test::hinged_chain(), 0.01, 0.4,
                [](const Simulation& s) { return position_of(s, {2}); });
}

TEST(Rattle, TorqueFreeTop) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  BodyDef top = test::lump("top", Vector3::Zero(), 1.0);
  top.angular_velocity = {1.0, 3.0, 0.5};
  m.model.add(top);
  const auto probe = [](const Simulation& s) {
    const Quaternion q = s.world.orientation({0});
    return std::vector<double>{q.w(), q.x(), q.y(), q.z()};
  };
  const double slope = order(m, IntegratorKind::rattle, 0.02, 2.0, probe);
  EXPECT_GE(slope, 1.9);
  EXPECT_LE(slope, 2.1);
}

TEST(Rattle, EnergyOfAPendulumOnARollingCableNeitherGrowsNorDies) {
  // 10^5 substeps of 1/240 s: a pendulum whose cable rolls over a wheel with a counterweight.
  test::Machine m;
  m.model.gravity = test::down;
  const BodyId wheel = m.model.add(test::wheel("wheel", Vector3::Zero(), 0.2, 0.05));
  const BodyId weight = m.model.add(test::weight("weight", {-0.2, -2.0, 0.0}, 1.02));
  BodyDef ball = test::lump("ball", {0.2 + std::sin(0.2), -std::cos(0.2), 0.0}, 1.0);
  ball.mobility = Mobility::planar;
  const BodyId bob = m.model.add(ball);
  m.cables.push_back(cable("rope", {attach(weight), roll(wheel, right), attach(bob)}));
  use(m, IntegratorKind::rattle, 1.0 / 240.0);
  Simulation s = test::start(m);
  const double start = s.world.energy().total();
  // The scale is what the motion turns over.
  double kinetic = 0.0;
  double early = 0.0;
  double late = 0.0;
  double early_mean = 0.0;
  double late_mean = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    ASSERT_EQ(report.statistics.integrator_fallbacks, 0) << i;
    const double drift = std::abs(s.world.energy().total() - start);
    kinetic = std::max(kinetic, s.world.energy().kinetic);
    (i < 10'000 ? early : late) = std::max(i < 10'000 ? early : late, drift);
    if (i < 10'000) early_mean += (s.world.energy().total() - start) / 10'000;
    if (i >= 90'000) late_mean += (s.world.energy().total() - start) / 10'000;
  }
  // It oscillates by some (h w)^2 = 3e-4 of what the motion turns over, and stays there.
  EXPECT_LT(late / kinetic, 3e-4);
  EXPECT_LT(late, 1.05 * early);
  EXPECT_LT(std::abs(late_mean - early_mean) / kinetic, 1e-6);
}

TEST(Rattle, SpringsKeepTheirEnergyAndStayStable) {
  // A weight on a cable of compliance a: w = 1 / sqrt(m a), from resolved to 1000 times too stiff
  // for the step.
  for (const double stiffness : {1e1, 1e3, 1e5, 1e7, 1e9}) {
    test::Machine m;
    m.model.gravity = test::down;
    const BodyId weight = m.model.add(test::weight("weight", {0.0, -1.0, 0.0}, 1.0));
    m.cables.push_back(cable("rope", {attach(BodyId::world()), attach(weight)}));
    m.cables[0].compliance = 1.0 / stiffness;
    // Half of the force at rest, so that it swings and never goes slack.
    m.cables[0].rest_lengths = {1.0 - 0.5 * g / stiffness};
    use(m, IntegratorKind::rattle, 1.0 / 60.0);
    Simulation s = test::start(m);
    const double start = s.world.energy().total();
    const double scale = 0.5 * g * g / stiffness;
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      worst = std::max(worst, std::abs(s.world.energy().total() - start));
    }
    // Energies near 10 J round at 1e-15 each.
    EXPECT_LT(worst, 1e-9 * scale + 1e-11) << stiffness;
  }
}

TEST(Rattle, ResolvedSpringsHaveTheirFrequency) {
  // Implicit midpoint: tan(w' h / 2) = w h / 2, so w' is too low by (w h)^2 / 12; 20 steps per
  // period: 0.8 %, 120: 0.02 %.
  test::Machine m;
  m.model.gravity = test::down;
  const BodyId weight = m.model.add(test::weight("weight", {0.0, -1.0, 0.0}, 1.0));
  m.cables.push_back(cable("rope", {attach(BodyId::world()), attach(weight)}));
  m.cables[0].compliance = 1e-2;
  m.cables[0].rest_lengths = {1.0 - 0.05};
  const double h = 2.0 * pi / 10.0 / 40.0;
  use(m, IntegratorKind::rattle, h);
  Simulation s = test::start(m);
  const double rest = -0.95 - 0.0981;
  int steps = 0;
  int crossings = 0;
  double first = 0.0;
  double last = 0.0;
  double before = s.world.position(weight).y() - rest;
  for (; steps < 2000; ++steps) {
    ASSERT_TRUE(s.world.step().ok());
    const double now = s.world.position(weight).y() - rest;
    if (before < 0.0 && now >= 0.0) {
      const double time = (steps + before / (before - now)) * h;
      if (crossings++ == 0) first = time;
      last = time;
    }
    before = now;
  }
  const double frequency = 2.0 * pi * (crossings - 1) / (last - first);
  EXPECT_NEAR(frequency, 2.0 / h * std::atan(0.5 * 10.0 * h), 1e-4);
}

TEST(Rattle, NoImpactMakesEnergy) {
  // A ball thrown up on its rigid cable, which goes taut again and again; and the same with a
  // spring.
  for (const double compliance : {0.0, 1e-4, 1e-2}) {
    test::Machine m = test::cable_pendulum(1.0, 1.0, 2.5);
    m.cables[0].compliance = compliance;
    m.model.bodies[0].velocity = {1.0, 0.3, 0.0};
    use(m, IntegratorKind::rattle, 1.0 / 240.0);
    Simulation s = test::start(m);
    const double start = s.world.energy().total();
    double most = start;
    for (int i = 0; i < 5000; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      most = std::max(most, s.world.energy().total());
    }
    // What the energy of a smooth motion oscillates by, of order (h w)^2 of the kinetic energy.
    EXPECT_LT(most - start, 1e-3 * g) << compliance;
  }
}

TEST(Rattle, ASwingTooFarForItsStepIsCutAndCounted) {
  test::Machine m = test::cable_pendulum(1.0, 1.0, 1.0);
  m.model.bodies[0].velocity = {0.0, 0.0, 30.0};
  use(m, IntegratorKind::rattle, 0.1);
  Simulation s = test::start(m);
  std::int64_t cut = 0;
  for (int i = 0; i < 10; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    cut += report.statistics.cut_substeps;
    EXPECT_EQ(report.statistics.integrator_fallbacks, 0);
    EXPECT_EQ(report.statistics.unconverged, 0);
  }
  EXPECT_GT(cut, 0);
  EXPECT_NEAR(s.world.position({0}).norm(), 1.0, 1e-6);
}

TEST(Rattle, BothSolversAgree) {
  test::Machine m = test::cable_pendulum(1.0, 1.0, 1.0);
  use(m, IntegratorKind::rattle, 0.01);
  Simulation direct = test::start(m);
  m.model.step.solver = SolverKind::gauss_seidel;
  Simulation sweeps = test::start(m);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(direct.world.step().ok());
    ASSERT_TRUE(sweeps.world.step().ok());
  }
  EXPECT_NEAR((direct.world.position({0}) - sweeps.world.position({0})).norm(), 0.0, 1e-8);
}

TEST(Rattle, AStateCanBeRestored) {
  test::Tackle tackle{.strands = 4, .effort = 3.0, .block_mobility = Mobility::free};
  test::Machine m = tackle.machine();
  m.model.bodies[0].angular_velocity = {0.1, 0.2, 0.3};
  use(m, IntegratorKind::rattle, 0.005);
  Simulation s = test::start(m);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
  const State saved = s.world.state();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.world.step().ok());
  Simulation other = test::start(m);
  ASSERT_TRUE(other.world.restore(saved).empty());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(other.world.step().ok());
  EXPECT_EQ(hash(other.world.state()), hash(s.world.state()));
}

}  // namespace
}  // namespace sheave
