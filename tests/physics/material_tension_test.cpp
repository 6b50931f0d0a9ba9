// The reported tension of an elastic rope is that of its material at the lengths of that moment: EA
// (l - L) / L, with the rest length L, whatever solver and integrator made the step.

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::material_tension {
namespace {

using test::attach;
using test::cable;

constexpr double stiffness = 1e4;  // EA [N]

class MaterialTension : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, MaterialTension, ::testing::ValuesIn(test::combinations),
                         test::combination_name);

double tension(const Simulation& s) { return s.cable_reports()[0].spans[0].tension; }

/// A rope from the origin to a body at `point` that is led with `velocity`, strained by a tenth.
test::Machine led(const StepSettings& step, const Vector3& point, const Vector3& velocity) {
  test::Machine m;
  m.model.step = step;
  BodyDef puller;
  puller.name = "puller";
  puller.mobility = Mobility::kinematic;
  puller.position = point;
  puller.velocity = velocity;
  m.model.add(puller);
  m.cables.push_back(cable("rope", {attach(BodyId::world(), {0, 0, 0}), attach({0})}));
  m.cables[0].rest_lengths = {point.norm() / 1.1};
  m.cables[0].axial_stiffness = stiffness;
  return m;
}

TEST_P(MaterialTension, OfARopeDrawnOutIsThatOfItsLength) {
  const Vector3 point{0.3, -0.8, 0.5};
  const Vector3 velocity{0.2, 0.4, -0.7};
  const double rest_length = point.norm() / 1.1;
  for (const double scale : {-1.0, 1.0}) {
    for (const int steps : {1, 4, 64}) {
      const double h = 0.1 / steps;
      Simulation s = test::start(led(step_settings(h, 20), point, scale * velocity));
      for (int i = 0; i <= steps; ++i) {
        const double length = (point + i * h * scale * velocity).norm();
        const double exact = std::max(0.0, stiffness * (length / rest_length - 1.0));
        // The position is a sum of `steps` products, each rounded by 2^-53 of a metre.
        EXPECT_NEAR(tension(s), exact, 1e-15 * (steps + 8) * stiffness / rest_length) << i;
        ASSERT_TRUE(s.world.step().ok());
      }
    }
  }
}

TEST_P(MaterialTension, IsKnownBeforeTheFirstStep) {
  Simulation s = test::start(led(step_settings(0.01, 20), {2, 0, 0}, {0, 0, 0}));
  EXPECT_NEAR(tension(s), 0.1 * stiffness, 1e-9);
  s = test::start(led(step_settings(0.01, 20), {2, 0, 0}, {-10, 0, 0}));
  ASSERT_TRUE(s.world.step().ok());
  ASSERT_TRUE(s.world.step().ok());
  ASSERT_TRUE(s.world.step().ok());
  // At 1.7 m it hangs slack.
  EXPECT_EQ(tension(s), 0.0);
}

TEST_P(MaterialTension, OfASpringPendulumConvergesWithItsPositions) {
  // The tension is a smooth function of the position, so that its order is that of the position: 2
  // with `rattle`, 1 with `xpbd`. Halving a step twice shows it.
  if (GetParam().solver == SolverKind::gauss_seidel) GTEST_SKIP() << "its sweeps end early";
  std::array<double, 3> found{};
  double h = GetParam().rattle() ? 0.004 : 0.0002;
  for (double& value : found) {
    test::Machine m;
    m.model.step = step_settings(h, 40);
    BodyDef bob = test::weight("bob", {0.8, -0.6, 0}, 2.0);
    bob.mobility = Mobility::planar;
    bob.axis = Vector3::UnitZ();
    bob.inertia = Vector3::Ones();
    m.model.add(bob);
    m.cables.push_back(cable("rope", {attach(BodyId::world(), {0, 0, 0}), attach({0})}));
    m.cables[0].axial_stiffness = 500.0;
    m.cables[0].rest_lengths = {0.96};
    m.model.gravity = test::down;
    Simulation s = test::start(m);
    test::run(s.world, 0.4);
    value = tension(s);
    ASSERT_GT(value, 1.0);
    h *= 0.5;
  }
  const double order = std::log2(std::abs((found[0] - found[1]) / (found[1] - found[2])));
  EXPECT_NEAR(order, GetParam().rattle() ? 2.0 : 1.0, 0.15);
}

TEST_P(MaterialTension, OfADampedRopeIsThatOfSpringAndDamper) {
  // Drawn out at constant speed, spring and damper pull with EA (l - L) / L + b v.
  const double speed = 0.5;
  const double damping = 40.0;
  const double h = 0.01;
  test::Machine m = led(step_settings(h, 60), {2, 0, 0}, {speed, 0, 0});
  m.cables[0].damping = damping;
  Simulation s = test::start(m);
  for (int i = 1; i <= 5; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const double strain = (2.0 + speed * i * h) / (2.0 / 1.1) - 1.0;
    EXPECT_NEAR(tension(s), stiffness * strain + damping * speed, 1e-6);
  }
}

}  // namespace
}  // namespace sheave::material_tension
