// A bob of 1 kg on a cable under a cart on a rail, the lighter the harder: substeps that do not
// converge are cut.
//
// With the angle p of a cable of length L, the momentum along the rail conserved (0), and masses M
// and m,
//   p'' = -((M + m) g sin p + m L p'^2 sin p cos p) / (L (M + m sin^2 p)),   x = x0 - m L (sin p - sin p0) / (M + m).
// A light cart whips past the bob below it within M / m L / v, v being the speed that the bob has
// fallen to: it turns the bob's fall into its rise like a hard, elastic impact.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

constexpr double cart_start_angle = 1.0;
constexpr BodyId cart_id{0};
constexpr BodyId bob_id{1};

test::Machine cart_machine(double mass, IntegratorKind integrator, double dt, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(dt, substeps, 20);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  BodyDef cart = test::weight("cart", Vector3::Zero(), mass);
  cart.axis = Vector3::UnitX();
  m.model.add(cart);
  m.model.add(
      test::lump("bob", {std::sin(cart_start_angle), -std::cos(cart_start_angle), 0.0}, 1.0));
  m.cables.push_back(test::cable("rope", {test::attach(cart_id), test::attach(bob_id)}));
  return m;
}

/// Angle and its rate after `time`, by Runge and Kutta's method.
std::array<double, 2> cart_reference(double mass, double time) {
  using Pair = std::array<double, 2>;
  const auto rate = [&](const Pair& s) -> Pair {
    const double sine = std::sin(s[0]);
    const double cosine = std::cos(s[0]);
    return {s[1], -((mass + 1.0) * g * sine + s[1] * s[1] * sine * cosine) / (mass + sine * sine)};
  };
  const auto ahead = [](const Pair& s, const Pair& k, double h) -> Pair {
    return {s[0] + h * k[0], s[1] + h * k[1]};
  };
  constexpr int steps = 200000;
  const double h = time / steps;
  Pair s{cart_start_angle, 0.0};
  for (int i = 0; i < steps; ++i) {
    const Pair a = rate(s);
    const Pair b = rate(ahead(s, a, 0.5 * h));
    const Pair c = rate(ahead(s, b, 0.5 * h));
    const Pair d = rate(ahead(s, c, h));
    for (std::size_t k = 0; k < 2; ++k) s[k] += h / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]);
  }
  return s;
}

struct CartRun {
  double least = 0.0;  ///< change of the energy since the start [J]
  double most = 0.0;
  double last = 0.0;
  double momentum = 0.0;  ///< along the rail, the largest [kg m/s]
  double stretch = 0.0;   ///< the largest
  std::int64_t cut = 0;
  std::int64_t parts = 0;
  std::int64_t left = 0;  ///< to xpbd
};

CartRun run_cart(const test::Machine& m, double mass, double time) {
  Simulation s = test::start(m);
  const double start = s.world.energy().total();
  CartRun run;
  while (s.world.state().time < time - 1e-9) {
    const StepReport report = s.world.step();
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report.statistics.unconverged, 0);
    run.last = s.world.energy().total() - start;
    run.least = std::min(run.least, run.last);
    run.most = std::max(run.most, run.last);
    const double momentum = mass * s.world.velocity(cart_id).x() + s.world.velocity(bob_id).x();
    run.momentum = std::max(run.momentum, std::abs(momentum));
    const SpanReport span = s.cable_reports()[0].spans[0];
    run.stretch = std::max(run.stretch, span.length / span.rest_length - 1.0);
    run.cut += report.statistics.cut_substeps;
    run.parts += report.statistics.substep_parts;
    run.left += report.statistics.integrator_fallbacks;
  }
  return run;
}

// The potential energy that a swing turns into motion [J].
const double cart_swing = g * (1.0 - std::cos(cart_start_angle));

TEST(LightCart, CreatesNoEnergyAtAnyMass) {
  std::int64_t cut = 0;
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double mass : {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      for (const int substeps : {1, 8}) {
        SCOPED_TRACE(std::to_string(mass) + " kg x " + std::to_string(substeps) +
                     (integrator == IntegratorKind::rattle ? " rattle" : " xpbd"));
        const CartRun run =
            run_cart(cart_machine(mass, integrator, 1.0 / 60.0, substeps), mass, 2.0);
        cut += run.cut;
        // The solver ends at 1e-10 of a scene of about 1 m.
        EXPECT_LE(run.stretch, 1e-9);
        // Velocities are differences of positions of 1 m over a part of h: each is rounded by eps /
        // h, as if at random.
        const double shortest = 1.0 / (60.0 * substeps * (run.cut > 0 ? 262144.0 : 1.0));
        const double roundings = std::sqrt(120.0 * substeps + static_cast<double>(run.parts));
        EXPECT_LE(run.momentum, 1e-12 + 2.2e-16 / shortest * roundings);
        if (integrator == IntegratorKind::xpbd) {
          // Implicit Euler makes none. What it adds up off the end's gradients may make a hundredth
          // per part.
          EXPECT_LE(run.most, 0.01 * cart_swing);
          EXPECT_GE(run.least, -cart_swing - 1e-6) << "all there is";
        } else if (run.left == 0) {
          // A part in which the cable turns by a does work of a^3, a hundredth of the energy at the
          // most: a = 0.2, eight of them in the quarter turn of a whip before the cart is above the
          // bob. Those behind it have the other sign.
          EXPECT_LE(run.most, 0.08 * cart_swing);
          EXPECT_GE(run.least, -0.08 * cart_swing);
        } else {
          // A whip shorter than the smallest part is an impact that xpbd takes for an inelastic
          // one.
          EXPECT_LE(run.most, 0.08 * cart_swing);
        }
      }
    }
  }
  EXPECT_GT(cut, 0);
}

TEST(LightCart, TheWhipOfACartOfATenthOfAGramIsResolved) {
  const CartRun run =
      run_cart(cart_machine(1e-4, IntegratorKind::rattle, 1.0 / 60.0, 8), 1e-4, 2.0);
  EXPECT_GT(run.cut, 0);
  EXPECT_GT(run.parts, 2 * run.cut);
  EXPECT_LE(run.parts, 1024 * run.cut);
  EXPECT_EQ(run.left, 0);
}

TEST(LightCart, HeavierCartsNeedNoParts) {
  for (const double mass : {1.0, 0.1}) {
    const CartRun run =
        run_cart(cart_machine(mass, IntegratorKind::rattle, 1.0 / 60.0, 8), mass, 2.0);
    EXPECT_EQ(run.cut, 0);
  }
}

TEST(LightCart, FollowsItsEquationOfMotionInSecondOrder) {
  for (const double mass : {1.0, 0.1}) {
    constexpr double time = 1.0;
    const auto [angle, rate] = cart_reference(mass, time);
    std::array<double, 2> errors{};
    for (std::size_t k = 0; k < 2; ++k) {
      Simulation s =
          test::start(cart_machine(mass, IntegratorKind::rattle, 1.0 / 480.0, k == 0 ? 1 : 2));
      test::run(s.world, time);
      const Vector3 cable = s.world.position(bob_id) - s.world.position(cart_id);
      errors[k] = std::abs(std::atan2(cable.x(), -cable.y()) - angle);
      const double travel = -(std::sin(angle) - std::sin(cart_start_angle)) / (mass + 1.0);
      EXPECT_NEAR(s.world.position(cart_id).x(), travel, 2.0 * errors[k] + 1e-9);
    }
    const double order = std::log2(errors[0] / errors[1]);
    EXPECT_GE(order, 1.9) << mass;
    EXPECT_LE(order, 2.1) << mass;
  }
}

TEST(LightCart, PartsAreAFunctionOfTheState) {
  // A run that is taken up from a state in its middle goes on as if it had never stopped.
  const test::Machine m = cart_machine(1e-4, IntegratorKind::rattle, 1.0 / 60.0, 8);
  Simulation whole = test::start(m);
  test::run(whole.world, 0.25);
  Simulation taken_up = test::start(m);
  ASSERT_TRUE(taken_up.world.restore(whole.world.state()).empty());
  test::run(whole.world, 1.0);
  test::run(taken_up.world, 1.0);
  EXPECT_EQ(hash(whole.world.state()), hash(taken_up.world.state()));
}

TEST(LightCart, PrescribedMotionsFollowTheTimeWithinParts) {
  // A cart that is driven to and fro has its own function of time to be at, whatever the substep is
  // cut into: beside it, a light cart on which every swing is cut.
  test::Machine m = cart_machine(1e-4, IntegratorKind::rattle, 1.0 / 60.0, 1);
  BodyDef drum = test::wheel("drum", {5.0, 0.0, 0.0}, 0.1, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_times = {0.0, 1.0};
  drum.drive_values = {0.0, 3.0};
  const BodyId driven = m.model.add(drum);
  Simulation s = test::start(m);
  std::int64_t cut = 0;
  for (int i = 1; i <= 60; ++i) {
    const StepReport report = s.world.step();
    ASSERT_TRUE(report.ok());
    cut += report.statistics.cut_substeps;
    const double t = i / 60.0;
    EXPECT_EQ(s.world.state().time, static_cast<double>(i) * m.model.step.dt);
    EXPECT_NEAR(s.world.state().bodies[static_cast<std::size_t>(driven.index)].angle, 1.5 * t * t,
                1e-12);
  }
  EXPECT_GT(cut, 0);
}

}  // namespace
}  // namespace sheave
