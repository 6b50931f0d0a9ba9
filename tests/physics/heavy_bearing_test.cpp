// Bearings of wheels under ropes with weight: the tensions at the wheel press them, which are those of
// the chords and the weight of half a span (cable/cable_bearings.cpp).

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "tests/support/builders.h"
#include "tests/support/checked_run.h"

namespace sheave::heavy_bearing {
namespace {

using test::attach;
using test::cable;

constexpr double radius = 0.5;
constexpr double spin_inertia = 0.625;
constexpr double drop = 20.0;
constexpr double efficiency = 0.9;
constexpr double loss = (1.0 - efficiency) / (1.0 + efficiency);

std::shared_ptr<RollingLink> lossy(BodyId body, Winding winding) {
  auto link = std::make_shared<RollingLink>(*test::roll(body, winding));
  link->efficiency = efficiency;
  return link;
}

/// Two weights on a rope over a wheel whose bearing has losses.
struct Atwood {
  double first = 100.0;   ///< [kg]
  double second = 150.0;  ///< [kg]
  double density = 1.0;   ///< [kg/m]
  double speed = 0.0;     ///< of the second weight downwards [m/s]
  bool from_other_end = false;
  int turned = 0;  ///< quarter turns of the whole machine about z, gravity included
  StepSettings step;

  /// Way of the wheel's motion: +1, the second weight sinks.
  [[nodiscard]] double way() const { return speed < 0.0 ? -1.0 : 1.0; }
  [[nodiscard]] double moved_mass() const {
    return first + second + spin_inertia / (radius * radius) + way() * loss * (first - second);
  }
  /// Acceleration of the start: T1 = m1 (g + a) + w l and T2 = m2 (g - a) + w l at the wheel, and
  /// T2 - T1 - c (T1 + T2) = I a / r^2.
  [[nodiscard]] double acceleration() const {
    const double c = way() * loss;
    const double one = first + density * drop;
    const double other = second + density * drop;
    return test::g * (other * (1.0 - c) - one * (1.0 + c)) / moved_mass();
  }
  /// Displacement of the second weight downwards: x'' = a + k^2 x, k^2 = 2 rho g / M. The length of
  /// rope at the wheel changes by x on either side, and the bearing takes c times the sum, which stays.
  [[nodiscard]] double expected(double time) const {
    const double rate = std::sqrt(2.0 * density * test::g / moved_mass());
    return speed / rate * std::sinh(rate * time) +
           acceleration() / (rate * rate) * (std::cosh(rate * time) - 1.0);
  }
  [[nodiscard]] Vector3 turn(const Vector3& v) const {
    Vector3 way = v;
    for (int i = 0; i < turned; ++i) way = {-way.y(), way.x(), way.z()};
    return way;
  }
  [[nodiscard]] test::Machine machine() const {
    test::Machine m;
    m.model.gravity = turn(test::down);
    m.model.step = step;
    BodyDef wheel = test::wheel("wheel", Vector3::Zero(), radius, spin_inertia);
    wheel.angular_velocity = {0.0, 0.0, -speed / radius};
    m.model.add(wheel);
    const auto weight = [&](const char* name, double side, double mass, double velocity) {
      BodyDef body = test::weight(name, turn({side * radius, -drop, 0.0}), mass);
      body.axis = turn(Vector3::UnitY());
      body.velocity = turn({0.0, velocity, 0.0});
      m.model.add(body);
    };
    weight("first", -1.0, first, speed);
    weight("second", 1.0, second, -speed);
    CableDef rope = from_other_end
                        ? cable("rope", {attach({2}), lossy({0}, test::left), attach({1})})
                        : cable("rope", {attach({1}), lossy({0}, test::right), attach({2})});
    rope.linear_density = density;
    rope.axial_stiffness = 1e9;
    // The chord tensions of the motion, those in the middle of the spans.
    const double middle = 0.5 * density * drop * test::g;
    rope.pretensions = {first * (test::g + acceleration()) + middle,
                        second * (test::g - acceleration()) + middle};
    if (from_other_end) std::swap(rope.pretensions.front(), rope.pretensions.back());
    m.cables.push_back(rope);
    return m;
  }
  /// Displacement of the second weight along gravity.
  [[nodiscard]] double moved(double time) const {
    Simulation s = test::start(machine());
    const Vector3 before = s.world.position({2});
    while (s.world.state().time < time - 1e-9) {
      if (!s.world.step().ok()) {
        ADD_FAILURE() << "the motion diverged";
        break;
      }
    }
    return (s.world.position({2}) - before).dot(turn(-Vector3::UnitY()));
  }
};

StepSettings step_of(IntegratorKind integrator, int substeps,
                     SolverKind solver = SolverKind::direct) {
  StepSettings step = test::settings(1.0 / 60.0, substeps, 60);
  step.integrator = integrator;
  step.solver = solver;
  return step;
}

// The rope's own stretch, T L / EA = 4e-5 m, moves with changes of the tension of some percent, and
// the strain of rope on the wheel, 2e-6, is that with which it came: 2e-6 of the way.
constexpr double stretch = 4e-6;

TEST(HeavyRopeBearing, TakesItsShareOfTheTensionsAtTheWheel) {
  for (const int turned : {0, 1, 2, 3}) {
    for (const bool from_other_end : {false, true}) {
      Atwood falls;
      falls.step = step_of(IntegratorKind::rattle, 4);
      falls.turned = turned;
      falls.from_other_end = from_other_end;
      EXPECT_NEAR(falls.moved(1.0), falls.expected(1.0), stretch);
      for (const double speed : {2.0, -2.0}) {
        Atwood coasts = falls;
        coasts.second = 100.0;
        coasts.speed = speed;
        EXPECT_NEAR(coasts.moved(1.0), coasts.expected(1.0), stretch);
      }
    }
  }
}

TEST(HeavyRopeBearing, ConvergesWithBothIntegratorsAndSolvers) {
  Atwood falls;
  const auto error = [&](const StepSettings& step) {
    falls.step = step;
    return falls.moved(1.0) - falls.expected(1.0);
  };
  // Second order: 1/60 s has the error h^2 k^2 x / 12 with k^2 = 0.08 / s^2, 1e-6 m.
  EXPECT_NEAR(error(step_of(IntegratorKind::rattle, 1)), 0.0, 2e-6 + stretch);
  EXPECT_NEAR(error(step_of(IntegratorKind::rattle, 64)), 0.0, stretch);
  // First order.
  const double rough = error(step_of(IntegratorKind::xpbd, 16));
  EXPECT_NEAR(rough / error(step_of(IntegratorKind::xpbd, 32)), 2.0, 0.05);
  // Sweeps solve the same equations where they converge.
  falls.step = step_of(IntegratorKind::xpbd, 64, SolverKind::gauss_seidel);
  const double sweeps = falls.moved(0.1);
  falls.step = step_of(IntegratorKind::xpbd, 64);
  EXPECT_NEAR(sweeps, falls.moved(0.1), 1e-6);
}

TEST(HeavyRopeBearing, HoldsByTheWeightOfTheRope) {
  // The bearing holds 105 kg against 100 kg: 50 N are less than c (T1 + T2) = 0.0526 x 2450 N. The
  // bearing would let go of the weights alone at 10 % more mass, and a rope of 20 kg/m holds twice a
  // light weight.
  for (const auto& [first, second, density] :
       {std::array{100.0, 105.0, 1.0}, std::array{0.5, 1.0, 20.0}, std::array{100.0, 113.0, 1.0}}) {
    Atwood holds;
    holds.first = first;
    holds.second = second;
    holds.density = density;
    holds.step = step_of(IntegratorKind::rattle, 4);
    test::Machine m = holds.machine();
    const double middle = 0.5 * density * drop * test::g;
    m.cables[0].pretensions = {first * test::g + middle, second * test::g + middle};
    Simulation s = test::start(m);
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR(s.world.position({2}).y(), -drop, 1e-9) << second;
  }
  // Beyond (m2 - m1) = c (m1 + m2 + 2 rho l), here 113.33 kg, the weights move.
  Atwood slides;
  slides.second = 113.6;
  slides.step = step_of(IntegratorKind::rattle, 4);
  EXPECT_NEAR(slides.moved(1.0), slides.expected(1.0), stretch);
  EXPECT_GT(slides.expected(1.0), 5e-3);
}

/// A block with a sheave between a fixed end and a wheel, all with losses, that falls and swings.
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
  m.model.add(test::weight("load", {2.0, -10.0, 0.0}, 130.0));
  CableDef rope = cable("rope", {attach(BodyId::world()), lossy({1}, test::left),
                                 lossy({2}, test::right), attach({3})});
  rope.linear_density = 1.0;
  rope.axial_stiffness = 1e6;
  rope.pretension = 650.0;
  m.cables.push_back(rope);
  return m;
}

TEST(HeavyRopeBearing, IsChecked) {
  for (const IntegratorKind integrator : {IntegratorKind::xpbd, IntegratorKind::rattle}) {
    for (const int substeps : {4, 16}) {
      const StepSettings step = step_of(integrator, substeps);
      EXPECT_TRUE(test::checked_run(block(step), 0.5).clean());
      Atwood falls;
      falls.step = step;
      EXPECT_TRUE(test::checked_run(falls.machine(), 0.5).clean());
    }
  }
}

TEST(HeavyRopeBearing, TakesTheEnergyThatIsLost) {
  // With one substep per step the torque is its mean over the step, so that torque times rotation is the
  // energy that a bearing takes. Rope comes onto wheels with a strain that is known to 1e-3 x w r / T,
  // and 20 m of it have 50 J of elastic energy.
  StepSettings step = step_of(IntegratorKind::rattle, 1);
  step.dt = 1.0 / 240.0;
  Simulation s = test::start(block(step));
  const double before = s.world.energy().total();
  double taken = 0.0;
  for (int i = 0; i < 120; ++i) {
    const std::vector<BodyState> start = s.world.state().bodies;
    ASSERT_TRUE(s.world.step().ok());
    const CableReport rope = s.cable_reports()[0];
    for (const auto& [link, wheel] : {std::pair{1U, 1U}, std::pair{2U, 2U}}) {
      const double turned = s.world.state().bodies[wheel].angle - start[wheel].angle;
      taken += rope.links[link].bearing_torque * turned;
    }
  }
  EXPECT_LT(taken, -30.0);
  EXPECT_NEAR(s.world.energy().total() + s.cable_reports()[0].creep_loss - before, taken, 4e-4);
}

}  // namespace
}  // namespace sheave::heavy_bearing
