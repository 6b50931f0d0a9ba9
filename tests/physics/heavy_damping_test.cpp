// Dampers of ropes with weight resist the stretch of the rope (cable/cable_weight.cpp).

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"

namespace sheave::heavy_damping {
namespace {

constexpr double density = 1.0;
constexpr double length = 50.0;
constexpr double mass = 100.0;
constexpr double stiffness = 1e4;
constexpr double damping = 2000.0;

/// 100 kg on 50 m of rope, 0.2 m above its rest: on a drum that stands still, or at a point.
test::Machine hoist(IntegratorKind integrator, int substeps, bool on_drum) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(1.0 / 60.0, substeps, 50);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  BodyDef drum = test::wheel("drum", {-0.5, 0.0, 0.0}, 0.5, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_values = {0.0};
  m.model.add(drum);
  const double sunk = (mass + 0.5 * density * length) * test::g * length / stiffness;
  m.model.add(test::weight("load", {0.0, -length - sunk + 0.2, 0.0}, mass));
  CableDef rope =
      test::cable("rope", {test::attach(BodyId::world(), {0.0, 0.0, 0.0}), test::attach({1})});
  if (on_drum) {
    auto spool = std::make_shared<SpoolLink>();
    spool->body = {0};
    spool->winding = test::right;
    spool->stored_length = 5.0;
    rope.links[0] = spool;
  }
  rope.linear_density = density;
  rope.axial_stiffness = stiffness;
  rope.axial_damping = damping;
  rope.rest_lengths = {length};
  m.cables.push_back(rope);
  return m;
}

/// Distance from the closed form after 2 s: M y'' + (c / L) y' + (EA / L) y = 0.
double error_of(IntegratorKind integrator, int substeps, bool on_drum) {
  Simulation s = test::start(hoist(integrator, substeps, on_drum));
  const double start = s.world.position({1}).y();
  for (int k = 0; k < 120; ++k) {
    if (!s.step().ok()) return 1e9;
  }
  const double decay = 0.5 * damping / length / mass;
  const double rate = std::sqrt(stiffness / length / mass - decay * decay);
  const double t = 2.0;
  const double swing =
      0.2 * std::exp(-decay * t) * (std::cos(rate * t) + decay / rate * std::sin(rate * t));
  return std::abs(s.world.position({1}).y() - (start - 0.2 + swing));
}

TEST(HeavyDamping, OfALoadThatHangsIsThatOfItsUnstretchedRope) {
  // The change of the weight's share with the tension must not add to the damper: that was 2 %.
  for (const bool on_drum : {false, true}) {
    const double coarse = error_of(IntegratorKind::rattle, 4, on_drum);
    const double fine = error_of(IntegratorKind::rattle, 16, on_drum);
    EXPECT_LT(fine, 2e-5) << on_drum;
    EXPECT_GT(coarse / fine, 12.0) << on_drum;  // second order: 16
    EXPECT_LT(error_of(IntegratorKind::xpbd, 256, on_drum), 1e-3) << on_drum;
  }
}

TEST(HeavyDamping, OfASaggingRopeIsNone) {
  // A rope of EA = 1e8 N that hangs from a load on a slider to a point: its sag takes the motion, so
  // no damper can brake the load. The amplitude stays; with the rate of the chord it fell by 96 %.
  for (const IntegratorKind integrator : {IntegratorKind::rattle}) {
    std::array<double, 2> most{};
    for (const double c : {0.0, 2000.0}) {
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = test::settings(1.0 / 60.0, 8, 50);
      m.model.step.solver = SolverKind::direct;
      m.model.step.integrator = integrator;
      BodyDef load = test::weight("load", {10.0, 0.0, 0.0}, 20.0);
      load.axis = Vector3::UnitX();
      load.velocity = {0.05, 0.0, 0.0};
      m.model.add(load);
      for (const double side : {0.0, 20.0}) {
        CableDef rope =
            test::cable(side > 0.0 ? "right" : "left",
                        {test::attach(BodyId::world(), {side, 0.0, 0.0}), test::attach({0})});
        rope.linear_density = 1.0;
        rope.axial_stiffness = 1e8;
        rope.axial_damping = c;
        rope.rest_lengths = {12.0};
        m.cables.push_back(rope);
      }
      Simulation s = test::start(m);
      double& amplitude = most[c > 0.0 ? 1 : 0];
      for (int k = 0; k < 1200; ++k) {
        ASSERT_TRUE(s.step().ok());
        if (k >= 900) amplitude = std::max(amplitude, std::abs(s.world.position({0}).x() - 10.0));
      }
    }
    EXPECT_GT(most[0], 0.03);
    EXPECT_NEAR(most[1], most[0], 1e-6 * most[0]);
  }
}

}  // namespace
}  // namespace sheave::heavy_damping
