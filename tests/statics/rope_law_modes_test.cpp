// Rest and small vibrations of ropes whose tension follows a table.
//
// At the strain e a span of rest length L is a spring of T'(e) / L. The tables have their points at the
// strains of the tests or straight pieces there, so T and T' are known without the interpolation:
// between points in a straight line the curve is straight.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "cable/tension_law.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/statics/scene_at_rest.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::g;

constexpr double length = 2.0;     // [m], unstretched
constexpr double stiffness = 3e4;  // [N], of the straight part

/// Soft at first, then straight from 600 N at the strain 0.05 on.
void give_table(CableDef& cable) {
  cable.strain_table = {0.0, 0.02, 0.05, 0.06, 0.07, 0.08, 0.09, 0.1};
  cable.tension_table = {0.0, 100.0, 600.0, 900.0, 1200.0, 1500.0, 1800.0, 2100.0};
}

/// A load of 1200 N on a rope with the table, stretched to `strain`; through a ring if `shared`.
test::Machine hanging(double strain, bool shared) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.bodies = {test::weight("load", {0.0, -length * (1.0 + strain), 0.0}, 1200.0 / g)};
  m.cables = {test::cable("rope", {test::attach(BodyId::world()), test::attach(BodyId{0})})};
  m.cables[0].rest_lengths = {length};
  if (shared) {
    m.cables[0].links.insert(m.cables[0].links.begin() + 1, std::make_shared<PinholeLink>());
    m.cables[0].links[0] = test::attach(BodyId::world(), {0.5 * (1.0 + strain), 0.0, 0.0});
    m.model.bodies[0].position.y() = -(length - 0.5) * (1.0 + strain);
    m.cables[0].rest_lengths = {0.5, length - 0.5};
  }
  give_table(m.cables[0]);
  return m;
}

TEST(RopeLawAtRest, HangsAtTheStrainOfItsWeight) {
  for (const bool shared : {false, true}) {
    Simulation s = test::start(hanging(0.03, shared));
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    double whole = 0.0;
    const CableReport report = s.cable_reports()[0];
    for (const SpanReport& span : report.spans) {
      whole += span.length;
      EXPECT_NEAR(span.tension, 1200.0, 1e-7);
    }
    EXPECT_NEAR(whole, length * 1.07, 1e-11);
  }
}

TEST(RopeLawAtRest, SwingsByTheSlopeOfItsTable) {
  for (const bool shared : {false, true}) {
    Simulation s = test::start(hanging(0.07, shared));
    const Modes modes = find_modes(s);
    ASSERT_EQ(modes.modes.size(), 1U);
    EXPECT_LT(modes.imbalance, 1e-12);
    EXPECT_NEAR(modes.modes[0].eigenvalue, stiffness / length / (1200.0 / g), 1e-8);
  }
}

TEST(RopeLawAtRest, DampsByTheLengthOfTheSpan) {
  // The damper is c / L, its damping ratio c / 2 L over sqrt(k m).
  constexpr double c = 700.0;
  for (const bool table : {true, false}) {
    test::Machine m = hanging(0.07, false);
    m.cables[0].axial_damping = c;
    if (!table) {
      m.cables[0].strain_table.clear();
      m.cables[0].tension_table.clear();
      m.cables[0].axial_stiffness = 1200.0 / 0.07;
    }
    const double k = (table ? stiffness : 1200.0 / 0.07) / length;
    Simulation s = test::start(m);
    const Modes modes = find_modes(s);
    ASSERT_EQ(modes.modes.size(), 1U);
    const double ratio = 0.5 * c / length / std::sqrt(k * 1200.0 / g);
    EXPECT_NEAR(modes.modes[0].damping_ratio, ratio, 1e-10 * ratio);
  }
}

// The straight rope and the arc are one spring EA / L and one damper c / L.
TEST(DampedRopeOverAPost, DampsByTheLengthOfTheWholeRope) {
  Simulation s = testing::simulation_of(
      R"("bodies": [
        {"name": "post", "mobility": "static", "position": [0, 2, 0],
         "shape": {"type": "cylinder", "radius": 0.2, "length": 0.2}},
        {"name": "load", "position": [0.2, 0.5, 0], "mass": 10, "inertia": [1, 1, 1]}],
      "joints": [{"type": "slider", "name": "guide", "body_a": "world", "body_b": "load",
        "anchor": [0.2, 0.5, 0], "axis": [0, 1, 0]}],
      "cables": [{"name": "rope", "axial_stiffness": 1e4, "axial_damping": 500, "links": [
        {"type": "attachment", "body": "world", "point": [-0.2, 0, 0]},
        {"type": "rolling", "body": "post", "winding": "clockwise", "friction": 0},
        {"type": "attachment", "body": "load"}]}])");
  const double whole = 2.0 + 0.2 * pi + 1.5;
  const double k = 1e4 / whole;
  const Equilibrium found = find_equilibrium(s);
  ASSERT_TRUE(found.converged) << found.message;
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 1U);
  EXPECT_NEAR(modes.modes[0].eigenvalue, k / 10.0, 1e-6 * k / 10.0);
  const double ratio = 0.5 * 500.0 / whole / std::sqrt(k * 10.0);
  EXPECT_NEAR(modes.modes[0].damping_ratio, ratio, 1e-6 * ratio);
}

TEST(RopeLawAtRest, TakesAPretension) {
  test::Machine m = hanging(0.07, false);
  m.cables[0].rest_lengths.clear();
  m.cables[0].pretension = 1200.0;
  Simulation s = test::start(m);
  EXPECT_NEAR(s.cable_reports()[0].spans[0].rest_length, length, 1e-13);
  EXPECT_NEAR(s.world.energy().elastic, length * TensionLaw(m.cables[0]).energy(0.07), 1e-10);
}

/// Two equal loads on a rope with the table over a wheel of I = 3 kg m2, r = 0.25 m: each span is a
/// spring of T' / L, and the rims take their lengths unstretched, as in modes_material_test.cpp.
TEST(RopeLawAtRest, OverAWheelSwingsAsSpringsOfItsSlope) {
  test::Atwood atwood{.m1 = 1200.0 / g, .m2 = 1200.0 / g};
  atwood.inertia = 3.0;
  test::Machine m = atwood.machine();
  give_table(m.cables[0]);
  m.cables[0].pretension = 1200.0;
  Simulation s = test::start(m);
  const Modes modes = find_modes(s);
  ASSERT_EQ(modes.modes.size(), 3U);
  // Modes of three inertias m, M = I / r2, m in a row with two springs k: 0, k / m, k / m + 2 k / M.
  const double k = stiffness / (atwood.hang / 1.07);
  const double mass = 1200.0 / g;
  const std::array expected{0.0, k / mass, k / mass + 2.0 * k / (3.0 / 0.0625)};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(modes.modes[i].eigenvalue, expected[i], 1e-9 * expected[2]) << i;
  }
}

}  // namespace
}  // namespace sheave
