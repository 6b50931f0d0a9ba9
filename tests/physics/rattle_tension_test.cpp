// Forces of the second-order integrator: tensions and joint forces converge as positions do.
//
// The force of a substep, the mean of what acts in its two halves, is that of its middle to second
// order. The mean of the forces of the substeps before and after a moment is therefore that of the
// moment, to second order, too. The force of an xpbd substep acts at its end and is of first order
// wherever it is taken.

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "engine/constraint_batch.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

using ForceProbe = std::function<std::vector<double>(const Simulation&)>;

std::vector<double> tensions(const Simulation& s) {
  std::vector<double> all;
  const CableReport cable = s.cable_reports()[0];
  for (const SpanReport& span : cable.spans) all.push_back(span.tension);
  return all;
}

/// The forces at `time`, with substeps of `h`.
std::vector<double> forces_at(test::Machine m, IntegratorKind integrator, double h, double time,
                              const ForceProbe& probe) {
  m.model.step = test::settings(h, 1, 30);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  Simulation s = test::start(m);
  std::vector<double> before;
  std::vector<double> forces;
  const auto steps = static_cast<int>(std::lround(time / h));
  for (int i = 0; i <= steps; ++i) {
    if (i == steps) before = probe(s);
    const StepReport report = s.world.step();
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.integrator_fallbacks, 0);
  }
  forces = probe(s);
  for (std::size_t k = 0; k < forces.size(); ++k) forces[k] = 0.5 * (forces[k] + before[k]);
  return forces;
}

/// The largest difference of two lists.
double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

/// log2 of how errors fall from h to h / 2: against `exact`, or if there is none, of successive
/// differences.
double force_order(const test::Machine& m, IntegratorKind integrator, double h, double time,
                   const ForceProbe& probe, const std::vector<double>& exact) {
  const auto forces = [&](double step) { return forces_at(m, integrator, step, time, probe); };
  const std::vector<double> coarse = forces(h);
  const std::vector<double> middle = forces(0.5 * h);
  if (!exact.empty()) return std::log2(apart(coarse, exact) / apart(middle, exact));
  return std::log2(apart(coarse, middle) / apart(middle, forces(0.25 * h)));
}

void expect_force_orders(const test::Machine& m, double h, double time, const ForceProbe& probe,
                         const std::vector<double>& exact = {}) {
  const double second = force_order(m, IntegratorKind::rattle, h, time, probe, exact);
  EXPECT_GE(second, 1.9);
  EXPECT_LE(second, 2.1);
  const double first = force_order(m, IntegratorKind::xpbd, 0.1 * h, time, probe, exact);
  EXPECT_GE(first, 0.9);
  EXPECT_LE(first, 1.1);
}

TEST(RattleForces, CableThatUnwinds) {
  // T = m v^2 / l with l^2 = 1 + 2 r v t.
  expect_force_orders(test::involute(), 0.02, 1.0, tensions, {1.0 / std::sqrt(1.4)});
}

TEST(RattleForces, PendulumOnACable) {
  expect_force_orders(test::cable_pendulum(1.0, 1.0, 1.0), 0.01, 0.4, tensions);
}

TEST(RattleForces, SwayingTackleWithMountedSheaves) {
  test::Tackle tackle{.strands = 4, .effort = 3.0, .block_mobility = Mobility::planar};
  test::Machine m = tackle.machine();
  m.model.bodies[0].velocity = {0.3, 0.0, 0.0};
  expect_force_orders(m, 0.02, 0.4, tensions);
}

TEST(RattleForces, AtwoodIsExactAtAnyStep) {
  // Constant forces: every step has them, whatever its length. T1 = m1 (g + a), T2 = m2 (g - a).
  const test::Atwood atwood;
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    const std::vector<double> found = forces_at(atwood.machine(), integrator, 0.05, 0.4, tensions);
    EXPECT_NEAR(found[0], atwood.m1 * (g + atwood.acceleration()), 1e-9);
    EXPECT_NEAR(found[1], atwood.m2 * (g - atwood.acceleration()), 1e-9);
  }
}

TEST(RattleForces, JointsOfAHingedChainInSpace) {
  // The forces along x, y and z that hold the three anchors; the two rows after them hold a hinge's
  // axis.
  const auto probe = [](const Simulation& s) {
    std::vector<double> forces;
    const double h = s.world.model().step.dt;
    const std::span<const double> multipliers = s.world.features()[0]->multipliers();
    EXPECT_EQ(multipliers.size(), 15U);
    for (std::size_t i = 0; i < multipliers.size(); ++i) {
      if (i % 5 < 3) forces.push_back(multipliers[i] / (h * h));
    }
    return forces;
  };
  expect_force_orders(test::hinged_chain(), 0.01, 0.4, probe);
}

}  // namespace
}  // namespace sheave
