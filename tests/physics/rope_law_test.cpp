// Spans of ropes whose tension follows a table of strains.
//
// A weight m on a rope of rest length L with the hardening law of tests/support/rope_law.h that swings
// between the strains a and b has the period
//   2 int dx / v,   m v^2 / 2 + L U(x / L) - m g x = const,
// by quadrature with x = (a + b) / 2 L - (b - a) / 2 L cos s, which makes the integrand smooth.

#include "tests/support/rope_law.h"

#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/run_check.h"
#include "engine/body_set.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::rope_law_motion {
namespace {

using test::g;
using test::rope_law::bouncer;
using test::rope_law::drift;
using test::rope_law::give_law;
using test::rope_law::hardening;
using test::rope_law::hardening_energy;
using test::rope_law::k1;
using test::rope_law::k3;
using test::rope_law::step_of;

double rounded_sum(double low, double high, int count, const std::function<double(double)>& f) {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += f(low + (high - low) * (i + 0.5) / count);
  return sum * (high - low) / count;
}

/// Period of the bouncer between these strains [s].
double period(double a, double b, double gravity) {
  constexpr double mass = 20.0;
  constexpr double length = 2.0;
  const auto potential = [&](double e) {
    return length * hardening_energy(e) - mass * gravity * length * e;
  };
  return 2.0 * rounded_sum(0.0, pi, 20000, [&](double s) {
           const double e = 0.5 * (a + b) - 0.5 * (b - a) * std::cos(s);
           const double v = std::sqrt(2.0 / mass * (potential(b) - potential(e)));
           return length * 0.5 * (b - a) * std::sin(s) / v;
         });
}

/// The other strain at which the bouncer turns.
double other_turn(double b) {
  const double energy = 2.0 * hardening_energy(b) - 20.0 * g * 2.0 * b;
  double low = 0.0;
  double high = b;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    // The potential falls from 0 to its least value, below which the turn lies.
    const double e = 2.0 * hardening_energy(middle) - 20.0 * g * 2.0 * middle;
    (e > energy ? low : high) = middle;
    if (hardening(high) > 20.0 * g && e <= energy) high = middle;
  }
  return 0.5 * (low + high);
}

/// Time of the n-th lowest point, by the zero of the velocity between two steps.
double time_of_turn(Simulation& s, int n) {
  double before = s.world.state().bodies[0].velocity.y();
  int found = 0;
  while (s.world.state().time < 100.0) {
    const double start = s.world.state().time;
    EXPECT_TRUE(s.world.step().ok());
    const double now = s.world.state().bodies[0].velocity.y();
    if (before < 0.0 && now >= 0.0 && ++found == n) {
      return start + (s.world.state().time - start) * before / (before - now);
    }
    before = now;
  }
  return 0.0;
}

TEST(RopeLaw, SwingsWithThePeriodOfItsEnergy) {
  // Between the strains 0.03 and 0.09 the stiffness grows by a factor of 3. The period of `rattle` is
  // too long by a second order: measured 12.3 h^2, and (w h)^2 / 12 for a constant stiffness is
  // 11.8 h^2 at this period.
  constexpr double b = 0.09;
  const double expected = period(other_turn(b), b, g);
  for (const double h : {4e-3, 2e-3, 1e-3}) {
    test::Machine m = bouncer(b);
    m.model.step = test::direct_settings(IntegratorKind::rattle, h);
    Simulation s = test::start(m);
    EXPECT_NEAR(time_of_turn(s, 5) / 5.0, expected * (1.0 + 12.3 * h * h), 0.8 * h * h * expected);
  }
}

TEST(RopeLaw, KeepsTheEnergyOfASpanToRounding) {
  // The load of 20 kg flies up from a slack rope and falls into it again; 820 J of motion. A solver
  // leaves 1e-10 m in each of n = 100 to 1000 substeps, under 8 kN: below 1e-10 x sqrt(n) x 8e3 J.
  for (const double h : {0.05, 0.02, 0.005}) {
    test::Machine m = bouncer(0.25);
    m.model.step = test::direct_settings(IntegratorKind::rattle, h);
    EXPECT_LT(drift(m, 5.0), 1e-6) << h;
  }
}

TEST(RopeLaw, WithKinksKeepsTheEnergyAtCoarseSteps) {
  // Stiffnesses from 1 N to 2e7 N in one table. The load falls 3 m into the rope and is thrown up again
  // and again, in 300 substeps of up to 0.1 s: the rounds find the force of the law in each of them, so
  // none is left to xpbd. Residuals of 1e-10 m under 1e5 N or less in the substeps with a tension, some
  // 20 of them, remain of 590 J.
  for (const auto& c : test::combinations) {
    if (!c.rattle()) continue;
    for (const double h : {1.0 / 60.0, 0.1}) {
      test::Machine m = bouncer(0.0);
      m.cables[0].strain_table = {0.0, 0.001, 0.002, 0.01, 0.011, 0.5};
      m.cables[0].tension_table = {0.0, 1e-3, 1.0, 100.0, 1e4, 9e6};
      m.model.bodies[0].position.y() = 1.0;
      m.model.step = step_of(c, 1);
      m.model.step.dt = h;
      EXPECT_LT(drift(m, 300.0 * h), 1e-4) << h;
    }
  }
}

TEST(RopeLaw, CatchesAFallAtTheDepthOfItsEnergy) {
  // From 3 m above the rope's full length: m g (3 + L e) = L U(e). Twelve significant digits come
  // from the energy, and the lowest point lies between two steps: v h / 2 with v < a h / 2, so less
  // than a h^2 / 4 above the depth, with a below 300 m/s2.
  const auto missing = [](double e) {
    return 2.0 * hardening_energy(e) - 20.0 * g * (3.0 + 2.0 * e);
  };
  double low = 0.05;
  double high = 0.4;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (missing(middle) < 0.0 ? low : high) = middle;
  }
  const double h = 1e-3;
  test::Machine m = bouncer(0.0);
  m.model.bodies[0].position.y() = 1.0;
  m.model.step = test::direct_settings(IntegratorKind::rattle, h);
  m.cables[0].links[0] = test::attach(BodyId::world());
  Simulation s = test::start(m);
  double lowest = 0.0;
  while (s.world.state().time < 1.5) {
    ASSERT_TRUE(s.world.step().ok());
    lowest = std::min(lowest, s.world.position({0}).y());
  }
  EXPECT_NEAR(-lowest, 2.0 * (1.0 + low), 0.25 * 300.0 * h * h);
}

TEST(RopeLaw, OnADrumBreaksAtTheInstantOfItsBreakingTension) {
  // A drum with the speed v takes in a rope between fixed points of the distance l. The rope comes on
  // with its strain, so L' = -v / (1 + e) and e' = (1 + e) v / l: e = exp(v t / l) - 1 by any law.
  constexpr double e = 0.02;
  for (const auto& c : test::combinations) {
    if (c.solver != SolverKind::direct) continue;
    for (const int substeps : {1, 10}) {
      test::Machine m;
      m.model.step = test::direct_settings(c.integrator, 1.0 / 60.0, substeps);
      BodyDef drum = test::wheel("drum", {4.0, 0.0, 0.0}, 0.1, 1.0);
      drum.drive = DriveKind::speed;
      drum.drive_values = {-1.0};
      m.model.add(drum);
      auto winding = test::roll({0}, test::right);
      winding->stored_length = 1.0;
      m.cables = {test::cable("rope", {test::attach(BodyId::world(), {0.0, 0.1, 0.0}), winding})};
      give_law(m.cables[0]);
      m.cables[0].breaking_tension = hardening(e);
      Simulation s = test::start(m);
      for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
      ASSERT_EQ(s.cables->events().size(), 1U);
      // The strain is summed up by the trapezoidal rule: (v h / l)^2 / 12 of 0.8 s.
      const double part = 0.1 / 60.0 / substeps / 4.0;
      EXPECT_NEAR(s.cables->events()[0].time, 40.0 * std::log1p(e), part * part + 1e-9);
    }
  }
}

TEST(RopeLaw, WithAnotherTableIsNotTheOneThatRan) {
  // The certificate reads the table of the definition: one that is stiffer by 3 % does not fit.
  for (const auto& c : test::combinations) {
    test::Machine m = bouncer(0.1);
    m.model.step = step_of(c, 4);
    Simulation s = test::start(m);
    for (double& tension : m.cables[0].tension_table) tension *= 1.03;
    s.cable_definitions = std::make_shared<const std::vector<CableDef>>(m.cables);
    RunCheck check(s);
    for (int i = 0; i < 30; ++i) {
      const StepReport report = s.step();
      check.observe(s, report.statistics, i == 29);
    }
    const Certificate certificate = check.certificate();
    const CertificateItem* span = certificate.find(CertificateItem::Kind::span);
    ASSERT_NE(span, nullptr);
    EXPECT_FALSE(certificate.clean());
    // A stretch of 3 % of the swing, of 2 m x 0.1 x T / (T' e), 6 mm or less
    EXPECT_GT(span->value, 1e-4);
  }
}

TEST(RopeLaw, DampsTheStrainOfItsMaterial) {
  // A span of length L has the damper c / L, so that two ropes of one material and of lengths L and 2 L
  // under loads m and m / 2 swing alike, each with its strain. Small swings about the strain e decay
  // as exp(-c t / 2 L m), with the frequency sqrt(T'(e) / L m - (c / 2 L m)^2).
  constexpr double e = 0.06;
  constexpr double c = 150.0;
  const double mass = hardening(e) / g;
  const double stiffness = k1 + 3.0 * k3 * e * e;
  for (const bool table : {true, false}) {
    for (const double length : {1.0, 2.0}) {
      test::Machine m = bouncer(0.0);
      m.model.bodies[0].mass = table ? mass : k1 * e / g;
      m.model.bodies[0].position.y() = -length * (1.0 + e + 1e-4);
      m.cables[0].rest_lengths = {length};
      m.cables[0].axial_damping = c;
      if (!table) {
        m.cables[0].strain_table.clear();
        m.cables[0].tension_table.clear();
        m.cables[0].axial_stiffness = k1;
      }
      m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
      const double load = *m.model.bodies[0].mass;
      const double decay = 0.5 * c / (length * load);
      const double w = std::sqrt((table ? stiffness : k1) / (length * load) - decay * decay);
      Simulation s = test::start(m);
      double worst = 0.0;
      for (int i = 0; i < 500; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        const double t = s.world.state().time;
        const double x = -s.world.position({0}).y() / length - 1.0 - e;
        const double exact =
            1e-4 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
        worst = std::max(worst, std::abs(x - exact));
      }
      // The error of second order is (w h)^2 / 12 x w t of the swing; that of the second derivative
      // of the law 1e-4 x T'' / T' / 2 = 8e-4 of the swing.
      EXPECT_LT(worst, table ? 2e-7 : 1e-8);
    }
  }
}

}  // namespace
}  // namespace sheave::rope_law_motion
