// Ropes that meet at a light body: knots of three ropes, and splices of two.
//
// A knot of the mass m swings across its ropes with the frequency sqrt(sum of T / L / m), and `rattle`
// resolves it for h^2 sum of T / L < 4 m.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "statics/modes.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

constexpr double load_mass = 100.0;

/// Two ropes of 5 m from points 6 m apart, a knot 4 m below, and a load on 2 m of rope that moves at
/// 0.2 m/s out of the plane, with the knot. Bodies: 0 knot, 1 load.
test::Machine knot(double mass, int substeps, std::optional<double> stiffness) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, substeps);
  BodyDef tied = test::lump("knot", {0.0, -4.0, 0.0}, mass);
  BodyDef load = test::lump("load", {0.0, -6.0, 0.0}, load_mass);
  // All of it turns about the line between the upper ends.
  tied.velocity = {0.0, 0.0, 0.2 * 4.0 / 6.0};
  load.velocity = {0.0, 0.0, 0.2};
  m.model.add(tied);
  m.model.add(load);
  m.cables.push_back(
      test::cable("left", {test::attach(BodyId::world(), {-3.0, 0.0, 0.0}), test::attach({0})}));
  m.cables.push_back(
      test::cable("right", {test::attach(BodyId::world(), {3.0, 0.0, 0.0}), test::attach({0})}));
  m.cables.push_back(test::cable("lower", {test::attach({0}), test::attach({1})}));
  if (!stiffness) return m;
  const double weight = load_mass * test::g;
  const std::vector<double> tensions{(load_mass + mass) * test::g / 1.6,
                                     (load_mass + mass) * test::g / 1.6, weight};
  for (std::size_t i = 0; i < 3; ++i) {
    m.cables[i].axial_stiffness = stiffness;
    m.cables[i].pretension = tensions[i];
  }
  return m;
}

/// Mass at which the substep still resolves the knot's swing across its ropes [kg].
double least_mass(int substeps) {
  const double h = 1.0 / (60.0 * substeps);
  const double weight = load_mass * test::g;
  return 0.25 * h * h * (2.0 * weight / 1.6 / 5.0 + weight / 2.0);
}

// The three ropes stay in one plane, so load M and knot m swing about the line between the upper ends as
// a rigid pendulum: half a period is pi sqrt(6 / g) (1 + a^2 / 16) for the amplitude a, times
// sqrt((1 + 16 m / 36 M) / (1 + 4 m / 6 M)). The period of `rattle` is off by (w h)^2 / 24, and the time at
// which the load passes the middle is read within the second order of a frame of 1/60 s.
TEST(Knot, SwingsWithItsRopes) {
  for (const std::optional<double> stiffness :
       {std::optional<double>(), std::optional<double>(1e6)}) {
    for (const int substeps : {1, 4, 16}) {
      SCOPED_TRACE(std::to_string(substeps) + (stiffness ? " elastic" : " rigid"));
      const double mass = 2.0 * least_mass(substeps);
      Simulation s = test::start(knot(mass, substeps, stiffness));
      const double start = s.world.energy().total();
      double passed = 0.0;
      double before = 0.0;
      for (int i = 0; i < 300 && passed == 0.0; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        const double z = s.world.position({1}).z();
        if (before > 0.0 && z <= 0.0) {
          passed = s.world.state().time - z / s.world.velocity({1}).z();
        }
        before = z;
      }
      const double frequency = std::sqrt(test::g / 6.0);
      const double amplitude = 0.2 / std::sqrt(6.0 * test::g);
      const double share = mass / load_mass;
      const double half = pi / frequency * (1.0 + amplitude * amplitude / 16.0) *
                          std::sqrt((1.0 + 4.0 / 9.0 * share) / (1.0 + 2.0 / 3.0 * share));
      const double turn = frequency / (60.0 * substeps);
      // An elastic rope is longer by its mean tension: a m v^2 / L^2 / k, below 1e-6 of L.
      EXPECT_NEAR(passed, half, turn * turn / 24.0 * half + 2e-6);
      // The kinetic energy is 2 J, and its error of second order with a constant below 1.
      EXPECT_NEAR(s.world.energy().total(), start, 2.0 * turn * turn);
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    }
  }
}

// A knot too light for its substep is no silent fault: with a thirtieth of the least mass, moved as above,
// the run is doubtful.
TEST(Knot, TooLightForItsSubstepIsDoubtful) {
  Simulation s = test::start(knot(least_mass(4) / 30.0, 4, 1e6));
  bool told = false;
  for (int i = 0; i < 120 && !told; ++i) {
    told = !s.world.step().ok() || !s.certificate()->clean();
  }
  EXPECT_TRUE(told);
}

// Two ropes end to end are one rope of both compliances c = L0 / EA, 10 m of EA = 1 MN and 2 m of 20 kN
// when each is drawn by 500 N. The splice of 20 g adds to the load the square of its share of the motion
// times its mass, and its own mode is far above.
TEST(Knot, ASpliceJoinsTwoRopes) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  m.model.add(test::weight("splice", {0.0, -10.0, 0.0}, 0.02));
  m.model.add(test::weight("load", {0.0, -12.0, 0.0}, 50.0));
  m.cables.push_back(test::cable("steel", {test::attach(BodyId::world()), test::attach({0})}));
  m.cables.push_back(test::cable("nylon", {test::attach({0}), test::attach({1})}));
  m.cables[0].axial_stiffness = 1e6;
  m.cables[1].axial_stiffness = 2e4;
  for (CableDef& rope : m.cables) rope.pretension = 500.0;
  m.model.bodies[1].force = {0.0, -500.0, 0.0};
  Simulation s = test::start(m);
  double lowest = std::numeric_limits<double>::infinity();
  const Modes modes = find_modes(s);
  for (const Mode& mode : modes.modes) lowest = std::min(lowest, mode.frequency);
  const double steel = 10.0 / (1.0 + 500.0 / 1e6) / 1e6;
  const double nylon = 2.0 / (1.0 + 500.0 / 2e4) / 2e4;
  const double share = steel / (steel + nylon);
  const double mass = 50.0 + share * share * 0.02;
  // The share changes by its order (f / f_2)^2 = 1e-5 in the mode, and the frequency by 1e-5 of 2e-6.
  EXPECT_NEAR(lowest, std::sqrt(1.0 / (steel + nylon) / mass) / (2.0 * pi), 1e-8);
}

}  // namespace
}  // namespace sheave
