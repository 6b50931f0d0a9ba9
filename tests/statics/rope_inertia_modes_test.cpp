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

/// Both end tensions of all spans.
std::vector<double> end_tensions_of(const Simulation& s) {
  std::vector<double> tensions;
  for (const CableReport& cable : s.cable_reports()) {
    for (const SpanReport& span : cable.spans) {
      tensions.push_back(span.start_force.norm());
      tensions.push_back(span.end_force.norm());
    }
  }
  return tensions;
}

TEST(RopeInertiaModes, HaveTheEndTensionsOfTheirAccelerations) {
  // A load M on a rope of the mass m that is displaced by dy has the acceleration -k dy / (M + m / 3),
  // k = EA / L, so its rope pulls it with M / (M + m / 3) of k dy less. The rope moves on average by
  // half of that acceleration, so its upper end has (M + m / 2) / (M + m / 3).
  const double mass = 100.0;
  for (const bool from_load : {false, true}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.add(test::weight("load", {0.0, -20.0, 0.0}, mass));
    const auto top = test::attach(BodyId::world());
    const auto load = test::attach({0});
    CableDef rope = from_load ? test::cable("rope", {load, top}) : test::cable("rope", {top, load});
    rope.linear_density = 2.0;
    rope.axial_stiffness = 1e6;
    rope.axial_inertia = true;
    rope.rest_lengths = {20.0};
    m.cables.push_back(rope);
    Simulation s = test::start(m);
    ASSERT_TRUE(find_equilibrium(s).converged);
    const Modes modes = find_modes(s);
    ASSERT_EQ(modes.modes.size(), 1U);
    const std::vector<double> rest = end_tensions_of(s);
    const double by = 1e-4;
    ModalVector x = ModalVector::Zero(2);
    x[0] = by / modes.motions(0, 0);
    ASSERT_TRUE(s.world.restore(perturbed_state(s, modes, x)).empty());
    const std::vector<double> there = end_tensions_of(s);
    const double full = 50e3 * by / (mass + 40.0 / 3.0);
    const double upper = full * (mass + 20.0);
    const double lower = full * mass;
    // Strains of 1e-3 with their changes of 5e-6 of themselves.
    EXPECT_NEAR(rest[0] - there[0], from_load ? lower : upper, 1e-4 * full * mass);
    EXPECT_NEAR(rest[1] - there[1], from_load ? upper : lower, 1e-4 * full * mass);
  }
}

TEST(RopeInertiaModes, HaveTheEndTensionsOfARun) {
  // Two loads and a wheel with inertia on one rope. A substep of `rattle` has the mean of the forces,
  // which is that of its start but for (w h)^2 / 6 with w up to 60 / s: 1e-3 of them.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-3);
  const BodyId wheel = m.model.add(test::wheel("wheel", {0.0, 0.0, 0.0}, 0.5, 20.0));
  const BodyId left = m.model.add(test::weight("left", {-0.5, -20.0, 0.0}, 100.0));
  const BodyId right = m.model.add(test::weight("right", {0.5, -20.0, 0.0}, 100.0));
  CableDef rope = test::cable(
      "rope", {test::attach(left), test::roll(wheel, Winding::clockwise), test::attach(right)});
  rope.linear_density = 2.0;
  rope.axial_stiffness = 1e6;
  rope.axial_inertia = true;
  rope.rest_lengths = {20.0, 20.0};
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  ASSERT_TRUE(find_equilibrium(s).converged);
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 3U);
  const State here = s.world.state();
  const std::vector<double> rest = end_tensions_of(s);
  for (Eigen::Index k = 1; k < 3; ++k) {
    ModalVector x = ModalVector::Zero(6);
    x[k] = 1e-3;
    ASSERT_TRUE(s.world.restore(perturbed_state(s, modes, x)).empty());
    const std::vector<double> there = end_tensions_of(s);
    ASSERT_TRUE(s.step().ok());
    const std::vector<double> run = end_tensions_of(s);
    double largest = 0.0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      largest = std::max(largest, std::abs(run[i] - rest[i]));
    }
    EXPECT_GT(largest, 1.0);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      EXPECT_NEAR(there[i], run[i], 5e-3 * largest) << k << " " << i;
    }
    ASSERT_TRUE(s.world.restore(here).empty());
  }
}

/// Frequencies across a rope of 10 m and 2 kg/m that hangs in `pieces` with bodies at their ends, and
/// with a load. The mass is that of cables with inertia, or half of each piece at its ends.
std::vector<double> swings_of_pieces(int pieces, double load, bool in_bodies) {
  const double length = 10.0 / pieces;
  const double half = length;  // mass of half a piece
  test::Machine m;
  m.model.gravity = test::down;
  BodyId above = BodyId::world();
  for (int i = 1; i <= pieces; ++i) {
    const bool last = i == pieces;
    BodyDef node =
        test::lump("node" + std::to_string(i), {0.0, -i * length, 0.0},
                   (in_bodies ? (last ? half : 2.0 * half) : 1e-3) + (last ? load : 0.0));
    node.mobility = Mobility::planar;
    node.axis = Vector3::UnitZ();
    const BodyId own = m.model.add(node);
    CableDef rope =
        test::cable("rope" + std::to_string(i), {test::attach(above), test::attach(own)});
    rope.axial_stiffness = 1e7;
    if (!in_bodies) rope.linear_density = 2.0;
    rope.axial_inertia = !in_bodies;
    rope.rest_lengths = {length};
    m.cables.push_back(rope);
    above = own;
  }
  Simulation s = test::start(m);
  EXPECT_TRUE(find_equilibrium(s).converged);
  std::vector<double> swings;
  for (const Mode& mode : find_modes(s).modes) {
    if (mode.frequency > 1e-3 && swings.size() < 3) swings.push_back(mode.frequency);
  }
  EXPECT_EQ(swings.size(), 3U);
  return swings;
}

TEST(RopeInertiaModes, OfADividedRopeAreOfSecondOrder) {
  // The frequencies of the continuous rope are roots of Bessel functions of 2 w sqrt(z / g), where z is
  // the length of rope whose weight is the tension. A piece moves by a polygon in place of a sine: the
  // error is of second order, and n times as many pieces leave a share 1 / n^2 of it.
  const std::vector<double> exact{0.16652992, 0.64341963, 1.21970688};
  for (const bool in_bodies : {false, true}) {
    const std::vector<double> coarse = swings_of_pieces(5, 20.0, in_bodies);
    const std::vector<double> fine = swings_of_pieces(10, 20.0, in_bodies);
    for (std::size_t i = 1; i < 3; ++i) {
      const double ratio = (coarse[i] - exact[i]) / (fine[i] - exact[i]);
      EXPECT_GT(ratio, 3.5) << in_bodies << i;
      EXPECT_LT(ratio, 4.5) << in_bodies << i;
      EXPECT_LT(std::abs(fine[i] / exact[i] - 1.0), 0.02) << in_bodies << i;
    }
  }
}

TEST(RopeInertiaModes, OfADividedRopeWithAFreeEndNeedItsMassInBodies) {
  // Zeros of J0: w = j sqrt(g / L) / 2. The last piece with inertia has a third of its mass on the
  // stiffness of a rope that bends near its end.
  const std::vector<double> exact{0.18954320, 0.43508074, 0.68206832};
  const std::vector<double> inert = swings_of_pieces(10, 0.0, false);
  const std::vector<double> beads = swings_of_pieces(10, 0.0, true);
  // Measured: 0.3 %, 3.7 % and, with inertia, 24 %.
  EXPECT_NEAR(beads[0], exact[0], 0.005 * exact[0]);
  EXPECT_NEAR(beads[1], exact[1], 0.05 * exact[1]);
  EXPECT_LT(inert[1], 0.8 * exact[1]);
}

TEST(RopeInertiaModes, AreNotThoseOfJointSpace) {
  Simulation s = load_on_rope(test::weight("load", {0.0, -100.0, 0.0}, 10.0), 13e6);
  const Result<JointSpace> space = JointSpace::create(s);
  ASSERT_FALSE(space);
  EXPECT_NE(space.errors()[0].message.find("axial_inertia"), std::string::npos);
}

}  // namespace
}  // namespace sheave
