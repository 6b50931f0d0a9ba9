// Small vibrations of loads on ropes with inertia (cable/rope_inertia.h), against closed forms.

#include <cmath>

#include <gtest/gtest.h>

#include "statics/equilibrium.h"
#include "statics/joint_space.h"
#include "statics/modes.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

/// A load below the origin on 100 m of rope of 1.05 kg/m.
Simulation load_on_rope(const BodyDef& load, double stiffness) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.add(load);
  CableDef rope = test::cable("rope", {test::attach(BodyId::world()), test::attach({0})});
  rope.linear_density = 1.05;
  rope.axial_stiffness = stiffness;
  rope.axial_inertia = true;
  rope.rest_lengths = {100.0};
  m.cables.push_back(rope);
  return test::start(m);
}

TEST(RopeInertiaModes, OfALoadHaveAThirdOfTheRope) {
  for (const double mass : {1000.0, 1.0}) {
    Simulation s = load_on_rope(test::weight("load", {0.0, -100.0, 0.0}, mass), 13e6);
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    const Modes modes = find_modes(s);
    ASSERT_EQ(modes.modes.size(), 1U);
    const double expected = 13e6 / (100.0 * (mass + 105.0 / 3.0));
    EXPECT_NEAR(modes.modes[0].eigenvalue, expected, 1e-7 * expected);
    // The continuous rope has 1.783493 Hz.
    if (mass == 1000.0) {
      EXPECT_NEAR(modes.modes[0].frequency, 1.783699, 1e-6);
    }
  }
}

TEST(RopeInertiaModes, OfAPendulumHaveAThirdOfTheRope) {
  // The rope at rest pulls by rho g / ln(1 + rho L / M) per displacement, and has a third of its mass.
  for (const double mass : {1000.0, 50.0}) {
    BodyDef load = test::lump("load", {0.0, -100.0, 0.0}, mass);
    load.mobility = Mobility::planar;
    load.axis = Vector3::UnitZ();
    Simulation s = load_on_rope(load, 1e10);
    ASSERT_TRUE(find_equilibrium(s).converged);
    const Modes modes = find_modes(s);
    ASSERT_EQ(modes.modes.size(), 3U);
    const double expected = 1.05 * test::g / std::log(1.0 + 105.0 / mass) / (mass + 105.0 / 3.0);
    // The stretch of 1e-6, and differences of fourth order.
    EXPECT_NEAR(modes.modes[1].eigenvalue, expected, 1e-5 * expected);
  }
}

TEST(RopeInertiaModes, AreNotThoseOfJointSpace) {
  Simulation s = load_on_rope(test::weight("load", {0.0, -100.0, 0.0}, 10.0), 13e6);
  const Result<JointSpace> space = JointSpace::create(s);
  ASSERT_FALSE(space);
  EXPECT_NE(space.errors()[0].message.find("axial_inertia"), std::string::npos);
}

}  // namespace
}  // namespace sheave
