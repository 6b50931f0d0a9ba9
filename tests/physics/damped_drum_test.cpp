// A damper of the material resists the change of the strain. Rope that comes off a drum brings the
// strain with which it lay there (cable/cable_damping.cpp, cable/cable_weight.cpp).

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cable/links/spool.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"

namespace sheave::damped_drum {
namespace {

constexpr double mass = 100.0;
constexpr double stiffness = 1e4;
constexpr double start_length = 10.0;

struct Hoist {
  double speed = 0.0;       ///< of the drum's rim; > 0: lifts [m/s]
  double density = 0.0;     ///< [kg/m]
  double damping = 0.0;     ///< [N s]
  double start_pull = 0.0;  ///< mean tension of the free rope at time 0 [N]

  [[nodiscard]] double weight() const { return density * test::g; }
};

/// Height of the load below the drum after `time`. The free rope with the unstretched length L and
/// the mean strain e has the mean tension EA e + c e', and the weight w L. At the drum it has the
/// tension EA e + w L / 2, and comes onto the drum with this strain. It comes off with that of the
/// start. It has no inertia.
double depth_of(const Hoist& hoist, double time) {
  using Motion = std::array<double, 3>;  // L, e, speed of the load downwards
  const auto at_drum = [&](double strain, double length) {
    return strain + 0.5 * hoist.weight() * length / stiffness;
  };
  const double first = hoist.start_pull / stiffness;
  const auto rates = [&](const Motion& m) {
    const auto [length, strain, speed] = m;
    const double laid = hoist.speed > 0.0 ? at_drum(strain, length) : at_drum(first, start_length);
    const double grows = -hoist.speed / (1.0 + laid);
    const double strains = (speed - (1.0 + strain) * grows) / length;
    const double pull =
        stiffness * strain + hoist.damping * strains - 0.5 * hoist.weight() * length;
    return Motion{grows, strains, test::g - pull / mass};
  };
  Motion m{start_length, first, 0.0};
  constexpr int steps = 1000;
  const double h = time / steps;
  const auto moved = [](const Motion& from, const Motion& by, double step) {
    Motion to = from;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += step * by[i];
    return to;
  };
  for (int i = 0; i < steps; ++i) {
    const Motion a = rates(m);
    const Motion b = rates(moved(m, a, 0.5 * h));
    const Motion c = rates(moved(m, b, 0.5 * h));
    const Motion d = rates(moved(m, c, h));
    for (std::size_t k = 0; k < m.size(); ++k) {
      m[k] += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
    }
  }
  return m[0] * (1.0 + m[1]);
}

test::Machine machine(const Hoist& hoist, IntegratorKind integrator, int substeps) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(1.0 / 60.0, substeps, 50);
  m.model.step.solver = SolverKind::direct;
  m.model.step.integrator = integrator;
  BodyDef drum = test::wheel("drum", {-0.5, 0.0, 0.0}, 0.5, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_values = {hoist.speed / 0.5};
  m.model.add(drum);
  m.model.add(
      test::weight("load", {0.0, -start_length * (1.0 + hoist.start_pull / stiffness), 0.0}, mass));
  CableDef rope =
      test::cable("rope", {test::attach(BodyId::world(), {0.0, 0.0, 0.0}), test::attach({1})});
  auto spool = std::make_shared<SpoolLink>();
  spool->body = {0};
  spool->winding = test::right;
  spool->stored_length = 5.0;
  rope.links[0] = spool;
  rope.linear_density = hoist.density;
  rope.axial_stiffness = stiffness;
  rope.axial_damping = hoist.damping;
  rope.rest_lengths = {start_length};
  m.cables.push_back(rope);
  return m;
}

double simulated_depth(const Hoist& hoist, IntegratorKind integrator, int substeps) {
  Simulation s = test::start(machine(hoist, integrator, substeps));
  for (int k = 0; k < 60; ++k) {
    if (!s.step().ok()) return 1e9;
  }
  return -s.world.position({1}).y();
}

TEST(DampedDrum, RopeComesOffWithItsStrainInBothIntegrators) {
  // A damper that resisted the motion of the end, and not the strain, had another limit of short
  // steps: with `xpbd`, and in ropes with weight with both integrators.
  for (const double speed : {2.0, -2.0}) {
    // A rope of almost no weight goes the way of ropes with weight.
    for (const double density : {0.0, 1e-9, 1.0}) {
      for (const double damping : {0.0, 500.0, 4000.0}) {
        if (density == 1e-9 && damping != 500.0) continue;
        const Hoist hoist{speed, density, damping, 1500.0};
        SCOPED_TRACE(fmt::format("{} m/s, {} kg/m, {} N s", speed, density, damping));
        const double depth = depth_of(hoist, 1.0);
        const auto error = [&](IntegratorKind integrator, int substeps) {
          return simulated_depth(hoist, integrator, substeps) - depth;
        };
        // Second order: 16 times less. The strain with which heavy rope comes onto the drum is found
        // in two rounds, which leaves some 1e-4 of the change of a strain of 0.1 per step.
        const double coarse = std::abs(error(IntegratorKind::rattle, 8));
        EXPECT_LT(coarse, 1e-5);
        EXPECT_LT(std::abs(error(IntegratorKind::rattle, 32)),
                  coarse / 15.0 + (density > 0.0 ? 1e-7 : 0.0));
        // First order, with the next term a hundredth of it.
        EXPECT_NEAR(error(IntegratorKind::xpbd, 8) / error(IntegratorKind::xpbd, 32), 4.0, 0.08);
      }
    }
  }
}

TEST(DampedDrum, WorkOfADrumThatLiftsItsRopeIsExplained) {
  // At the drum the tension is half of the rope's weight above that of the chord.
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    const Certificate certificate =
        test::checked_run(machine({4.0, 50.0, 0.0, 3500.0}, integrator, 16), 1.0);
    EXPECT_TRUE(certificate.clean(1e-3)) << certificate.worst()->sentence();
  }
}

}  // namespace
}  // namespace sheave::damped_drum
