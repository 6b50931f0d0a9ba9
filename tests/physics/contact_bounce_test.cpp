// Impacts of colliders.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/certificate/bounces.h"
#include "tests/support/heaps.h"

namespace sheave {
namespace {

using test::g;
using test::Heap;

/// Greatest heights [m] of the ball above its place on the floor, bounce after bounce.
std::vector<double> heights(World& world, BodyId ball, double radius, double time) {
  std::vector<double> result;
  double highest = 0.0;
  bool falling = true;
  while (world.state().time < time) {
    EXPECT_TRUE(world.step().ok());
    const double height = world.position(ball).y() - radius;
    const bool falls = world.velocity(ball).y() < 0.0;
    if (!falls && falling) highest = 0.0;
    highest = std::max(highest, height);
    if (falls && !falling) result.push_back(highest);
    falling = falls;
  }
  return result;
}

TEST(ContactBounce, HeightsFallByTheSquareOfTheRestitution) {
  for (const test::Method& method : test::methods) {
    for (const double restitution : {0.0, 0.5, 0.8, 1.0}) {
      SCOPED_TRACE(test::name_of(method) + ", restitution " + std::to_string(restitution));
      Heap heap(method.solver, method.integrator);
      heap.model.step.dt = 1.0 / 240.0;
      heap.model.step.substeps = 1;
      heap.surface.restitution = restitution;
      heap.floor();
      const BodyId ball = heap.put(test::ball(0.1), {0.0, 1.1, 0.0});
      World world = heap.start();
      const std::vector<double> found = heights(world, ball, 0.1, 6.0);
      if (restitution == 0.0) {
        EXPECT_NEAR(world.position(ball).y(), 0.1, 1e-9);
        for (const double height : found) EXPECT_LT(height, 1e-9);
        continue;
      }
      ASSERT_GE(found.size(), 4U);
      double expected = 1.0;
      for (std::size_t i = 0; i < 4; ++i) {
        expected *= restitution * restitution;
        // Heights below what gravity makes of two substeps are not told apart.
        EXPECT_NEAR(found[i], expected, 0.01 * expected) << "bounce " << i;
      }
    }
  }
}

TEST(ContactBounce, EqualBallsExchangeTheirVelocities) {
  for (const test::Method& method : test::methods) {
    SCOPED_TRACE(test::name_of(method));
    Heap heap(method.solver, method.integrator);
    heap.model.gravity.setZero();
    heap.surface.restitution = 1.0;
    const BodyId first = heap.put(test::ball(0.1), {0.0, 0.0, 0.0});
    heap.last().velocity = {2.0, 0.0, 0.0};
    const BodyId second = heap.put(test::ball(0.1), {1.0, 0.0, 0.0});
    World world = heap.start();
    test::run(world, 1.0);
    // Row::softness leaves 1e-9 of an impact.
    constexpr double tolerance = 1e-7;
    EXPECT_NEAR(world.velocity(first).norm(), 0.0, tolerance);
    EXPECT_NEAR(world.velocity(second).x(), 2.0, tolerance);
    // And where they would be if the impact had been told to the moment: 0.4 s after the start.
    EXPECT_NEAR(world.position(first).x(), 0.8, tolerance);
    EXPECT_NEAR(world.position(second).x(), 1.0 + 2.0 * 0.6, tolerance);
  }
}

// A fall from H takes (1 - e^2) m v^2 / 2 in its impact, v^2 = 2 g H. Velocities of `xpbd` are g h /
// 2 behind those at the end of a substep, so that it begins with v = g h / 2; and its account takes
// m g^2 h^2 / 8 for bounces without height.
TEST(ContactBounce, TheCertificateCountsTheEnergyOfAnImpactExactly) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const double restitution : {0.3, 0.9, 1.0}) {
      Heap heap(SolverKind::direct, integrator);
      heap.model.step = test::direct_settings(integrator, 0.004);
      heap.surface.restitution = restitution;
      heap.floor();
      const double mass = 1.3;
      const BodyId ball = heap.put(test::ball(0.1), {0.0, 0.6, 0.0}, mass);
      Simulation simulation = test::start(test::Machine{heap.model, {}});
      while (!(simulation.world.velocity(ball).y() > 0.0)) {
        ASSERT_TRUE(simulation.world.step().ok());
      }
      const certify::Evidence evidence(simulation, *simulation.world.last_substep());
      const double lost = g * 0.004 * g * 0.004 / 8.0;
      const bool means = integrator == IntegratorKind::xpbd;
      const double square = 2.0 * g * 0.5 + (means ? 2.0 * lost : 0.0);
      const double expected =
          -0.5 * mass * (1.0 - restitution * restitution) * square - (means ? mass * lost : 0.0);
      // Row::softness leaves 1e-9 of an impact.
      EXPECT_NEAR(certify::BounceCheck(evidence).sum().energy, expected, 1e-7 * mass * square);
    }
  }
}

// A tumbling box on a rough slope: friction of an impact and the turn of a corner within a substep
// are none of the bounces' energy.
TEST(ContactBounce, TheCertificateDoesNotDoubtABoxTumblingDownASlope) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    Heap heap(SolverKind::direct, integrator);
    heap.incline(0.2);
    heap.model.step = test::direct_settings(integrator, 0.003);
    heap.surface.restitution = 0.25;
    heap.surface.friction = 0.4;
    heap.floor();
    heap.put(test::box(Vector3(0.3, 0.2, 0.25)), {0.0, 0.25, 0.0});
    heap.last().angular_velocity = {2.0, -1.0, -5.0};
    heap.put(test::ball(0.15), {0.0, 0.2, 1.0});
    heap.last().velocity = {-0.8, -0.7, 0.0};
    Simulation simulation = test::start(test::Machine{heap.model, {}});
    Certificate all;
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(simulation.world.step().ok());
      all.merge(simulation.certificate().value());
    }
    const CertificateItem* energy = all.find(CertificateItem::Kind::energy);
    ASSERT_NE(energy, nullptr);
    EXPECT_LT(energy->relative, 0.01) << energy->sentence();
  }
}

// A ball that meets the side of a sliding box turns it by friction, so that the floor's normal force
// works on what would have left the floor. Its friction takes more than that and what the box has
// not fallen, so that the floor gives nothing.
TEST(ContactBounce, TheCertificateCountsFrictionOfPressedBodies) {
  Heap heap(SolverKind::direct, IntegratorKind::xpbd);
  heap.model.step = test::direct_settings(IntegratorKind::xpbd, 0.003);
  heap.surface.friction = 0.46;
  heap.surface.restitution = 0.6;
  heap.floor();
  heap.surface.restitution = 0.0;
  heap.surface.friction = 0.64;
  heap.put(test::box({0.3, 0.3, 0.3}), {0.0, 0.15, 0.0}, 2.4);
  heap.last().velocity = {-0.084, 0.068, 0.0};
  heap.surface.friction = 0.25;
  heap.put(test::ball(0.15), {0.3, 0.15, 0.0}, 2.9);
  heap.last().velocity = {-0.5, 0.0, 0.0};
  heap.last().angular_velocity = {0.0, 0.0, 3.1};
  Simulation simulation = test::start(test::Machine{heap.model, {}});
  ASSERT_TRUE(simulation.world.step().ok());
  const certify::Evidence evidence(simulation, *simulation.world.last_substep());
  EXPECT_LE(certify::BounceCheck(evidence).sum().energy, 0.0);
}

// What overlaps when it bounces does so where it is: it leaves at e v and is where that takes it,
// which is farther than the fiftieth of 35 mm by which overlaps are opened.
TEST(ContactBounce, OverlappingBodiesMoveNoFurtherThanTheirRebound) {
  constexpr double speed = 2.0;
  for (const test::Method& method : test::methods) {
    for (const double restitution : {0.3, 1.0}) {
      SCOPED_TRACE(test::name_of(method) + ", restitution " + std::to_string(restitution));
      Heap heap(method.solver, method.integrator);
      heap.model.gravity.setZero();
      heap.model.step = test::direct_settings(method.integrator, 0.004);
      heap.model.step.solver = method.solver;
      heap.surface.restitution = restitution;
      heap.floor();
      const BodyId ball = heap.put(test::ball(0.1), {0.0, 0.065, 0.0});
      heap.last().velocity = {0.0, -speed, 0.0};
      World world = heap.start();
      for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(world.step().ok());
        EXPECT_NEAR(world.velocity(ball).y(), restitution * speed, 1e-7);
        const double way = restitution * speed * world.state().time;
        EXPECT_NEAR(world.position(ball).y(), 0.065 + way, 1e-8);
      }
    }
  }
}

// A ball on a spring of the floor swings as it does alone while another one bounces elsewhere.
TEST(ContactBounce, LeavesElasticContactsTheirForce) {
  const auto end_of_swing = [](SolverKind solver, bool beside) {
    Heap heap(solver, IntegratorKind::xpbd);
    heap.floor();
    heap.surface.compliance = 1e-4;
    const BodyId ball = heap.put(test::ball(0.1), {0.0, 0.101, 0.0});
    heap.last().velocity = {0.0, -1.0, 0.0};
    heap.surface.compliance = 0.0;
    heap.surface.restitution = 0.8;
    // It meets the floor after 22 ms, while the spring, with half a period of pi sqrt(m c) = 31 ms,
    // pushes the other one up.
    if (beside) heap.put(test::ball(0.1), {1.0, 0.1244, 0.0});
    if (beside) heap.last().velocity = {0.0, -1.0, 0.0};
    World world = heap.start();
    test::run(world, 0.1);
    return world.velocity(ball).y();
  };
  for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
    EXPECT_NEAR(end_of_swing(solver, true), end_of_swing(solver, false), 1e-9);
  }
}

}  // namespace
}  // namespace sheave
