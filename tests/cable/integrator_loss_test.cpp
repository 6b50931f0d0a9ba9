// What the integrator takes, against closed forms and against what is missing where nothing else
// takes any.

#include "cable/certificate/integrator_loss.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave::certify {
namespace {

using test::g;

struct Losses {
  double taken = 0.0;      ///< [J]
  double exchanged = 0.0;  ///< [J]
  double missing = 0.0;    ///< energy at the start less that at the end [J]
};

Losses losses_of(test::Machine machine, IntegratorKind integrator, int substeps, double time) {
  constexpr double dt = 0.01;
  machine.model.step = test::settings(dt, substeps, 30);
  machine.model.step.solver = SolverKind::direct;
  machine.model.step.integrator = integrator;
  Simulation s = test::start(machine);
  IntegratorLoss loss;
  const double start = s.world.energy().total();
  loss.observe(s.world, start, 0);
  std::int64_t fallbacks = 0;
  for (int i = 0; i < static_cast<int>(std::lround(time / dt)); ++i) {
    const StepReport report = s.world.step();
    EXPECT_TRUE(report.ok());
    fallbacks += report.statistics.integrator_fallbacks;
    loss.observe(s.world, s.world.energy().total(), fallbacks);
  }
  return {loss.taken(), loss.exchanged(), start - s.world.energy().total()};
}

TEST(IntegratorLoss, IsExactInFreeFall) {
  // v = g t is exact, positions are g h t / 2 too low: m g^2 h t / 2, exactly. Velocities are
  // differences of positions of some metres, so they have 1e-15 m / h = 1e-12 m/s of rounding, and
  // the energies of 100 J that are compared 1e-9 of 0.2 J.
  test::Machine fall;
  fall.model.gravity = test::down;
  fall.model.add(test::lump("stone", Vector3::Zero(), 2.0));
  for (const int substeps : {1, 5}) {
    const double expected = 2.0 * g * g * 0.01 / substeps * 1.0 / 2.0;
    const Losses of_xpbd = losses_of(fall, IntegratorKind::xpbd, substeps, 1.0);
    EXPECT_NEAR(of_xpbd.taken, expected, 1e-8 * expected);
    EXPECT_NEAR(of_xpbd.missing, expected, 1e-8 * expected);
    EXPECT_NEAR(of_xpbd.exchanged, 0.0, 1e-8) << "nothing goes in or out";
    EXPECT_EQ(losses_of(fall, IntegratorKind::rattle, substeps, 1.0).taken, 0.0);
  }
}

TEST(IntegratorLoss, FollowsItsLawOnACircle) {
  // w0 / sqrt(1 + 2 w0^2 h t), so of the energy 1 - 1 / (1 + 2 w0^2 h t) is gone. What is of higher
  // order: (w h)^2, and that the acceleration is that of a chord of w dt = 0.02: 1e-3.
  test::Machine circle = test::cable_pendulum(1.0, 1.0, 0.0);
  circle.model.gravity.setZero();
  constexpr double w = 2.0;
  circle.model.bodies[0].velocity = {w, 0.0, 0.0};
  for (const int substeps : {1, 4}) {
    const Losses losses = losses_of(circle, IntegratorKind::xpbd, substeps, 5.0);
    const double share = 2.0 * w * w * 0.01 / substeps * 5.0;
    const double expected = 0.5 * w * w * share / (1.0 + share);
    // The law itself is one of small w h: 0.02 for one substep.
    EXPECT_NEAR(losses.taken, expected, 0.03 * expected) << substeps;
    EXPECT_NEAR(losses.taken, losses.missing, 0.03 * expected) << substeps;
    EXPECT_LT(losses.exchanged, 0.05 * expected) << substeps;
  }
}

TEST(IntegratorLoss, EqualsTheMissingEnergyWithoutOtherLosses) {
  // Pendulums, wheels, a tackle that sways, joints in space: to first order in h, and the
  // acceleration from steps of 0.01 s, in which things turn by 0.05 rad or so.
  test::Tackle tackle{.strands = 4, .effort = 3.0, .block_mobility = Mobility::planar};
  test::Machine swaying = tackle.machine();
  swaying.model.bodies[0].velocity = {0.3, 0.0, 0.0};
  for (const test::Machine& machine :
       {test::cable_pendulum(1.0, 1.0, 1.0), test::Atwood().machine(), test::involute(),
        test::wheel_train(5, 1.0, 2.0, 0.1, 0.01), swaying}) {
    const Losses losses = losses_of(machine, IntegratorKind::xpbd, 4, 0.5);
    EXPECT_GT(losses.taken, 0.0);
    EXPECT_NEAR(losses.taken, losses.missing, 0.1 * losses.missing);
  }
  const Losses chain = losses_of(test::hinged_chain(), IntegratorKind::xpbd, 16, 0.5);
  EXPECT_NEAR(chain.taken, chain.missing, 0.1 * chain.missing);
}

TEST(IntegratorLoss, DoesNotCountImpactsAndDrives) {
  // A weight that falls 0.5 m into its cable loses m g 0.5 m, which is no integrator's fault; its
  // own part is that of the fall.
  test::Machine drop = test::cable_pendulum(1.0, 1.0, 0.0);
  drop.model.bodies[0].position = {0.0, -0.5, 0.0};
  drop.cables[0].rest_lengths = {1.0};
  const Losses dropped = losses_of(drop, IntegratorKind::xpbd, 1, 1.0);
  const double fall = std::sqrt(2.0 * 0.5 / g);
  EXPECT_NEAR(dropped.missing, 0.5 * g, 0.05 * g);
  EXPECT_NEAR(dropped.taken, 0.5 * g * g * 0.01 * fall, 0.1 * g * g * 0.01 * fall);
  EXPECT_NEAR(dropped.exchanged, 0.5 * g, 0.1 * g);
  // A force that lifts at a constant speed does work, and nothing is taken.
  test::Machine lift;
  lift.model.gravity = test::down;
  BodyDef load = test::weight("load", Vector3::Zero(), 1.0);
  load.velocity = {0.0, 1.0, 0.0};
  load.damping = 3.0;
  load.force = {0.0, g + 3.0, 0.0};
  lift.model.add(load);
  const Losses lifted = losses_of(lift, IntegratorKind::xpbd, 1, 1.0);
  EXPECT_NEAR(lifted.taken, 0.0, 1e-9);
  EXPECT_NEAR(lifted.exchanged, 3.0, 1e-6) << "drag takes what the force gives";
}

}  // namespace
}  // namespace sheave::certify
