#include "render/cut_ropes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/simulation.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/scene.h"
#include "tests/support/builders.h"

namespace sheave::render {
namespace {

constexpr double strength = 9.81;
const LooseChain::Surroundings open_air{{0.0, -strength, 0.0}, {}, {}};

double length_of(const std::vector<Vector3>& line) {
  double sum = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (line[k] - line[k - 1]).norm();
  return sum;
}

TEST(LooseChain, SwingsInTheTimeOfAHangingChain) {
  // Small vibrations of a hanging chain (D. Bernoulli 1732): the first mode is J0(j sqrt(s / L)) at
  // the distance s from the free end, with j = 2.4048 and the frequency w0 = j sqrt(g / L) / 2. With
  // friction c = sqrt(g / L) on all velocities the free end is e^(-ct/2) (cos wt + c/2w sin wt),
  // w^2 = w0^2 - c^2/4, which is 0 first at wt = pi/2 + atan(c/2w). The last of 41 equal points is
  // 1/80 of the mass too much at the end. The error is below 2 %, and a step.
  constexpr double j = 2.404825557695773;
  for (const double length : {0.2, 1.0, 30.0}) {
    std::vector<Vector3> line;
    for (int k = 0; k <= 400; ++k) {
      const double down = length * k / 400.0;
      const double sway = 0.01 * length * std::cyl_bessel_j(0.0, j * std::sqrt(1.0 - k / 400.0));
      line.emplace_back(sway, -down, 0.0);
    }
    LooseChain chain(line, length, true);
    const double unit = std::sqrt(strength / length);
    const double c = unit;
    const double w = std::sqrt(0.25 * j * j * unit * unit - 0.25 * c * c);
    const double expected = (0.5 * pi + std::atan(0.5 * c / w)) / w;
    const double step = expected / 100.0;
    double time = 0.0;
    while (chain.points().back().x() > 0.0 && time < 4.0 * expected) {
      chain.move(step, Vector3::Zero(), open_air);
      time += step;
    }
    EXPECT_NEAR(time, expected, 0.02 * expected + step) << length;
  }
}

TEST(LooseChain, KeepsItsLengthAndComesToRest) {
  LooseChain chain(std::vector<Vector3>{{0, 0, 0}, {2, 0, 0}}, 2.0, true);
  double largest = 0.0;
  for (int frame = 0; frame < 60 * 40; ++frame) {
    chain.move(1.0 / 60.0, Vector3::Zero(), open_air);
    largest = std::max(largest, std::abs(length_of(chain.points()) - 2.0));
    ASSERT_EQ(chain.points().front(), Vector3(0, 0, 0));
  }
  EXPECT_LE(largest, 0.02 * 2.0);  // in the crack of its end
  EXPECT_LE((chain.points().back() - Vector3(0, -2, 0)).norm(), 1e-2);
}

TEST(LooseChain, AFreePieceFallsAsAStone) {
  // g t^2 / 2; steps of h add g t h / 2, with h below 2 ms 0.2 % here.
  const double length = 1.5;
  LooseChain chain(std::vector<Vector3>{{0, 0, 0}, {length, 0, 0}}, length, false);
  for (int frame = 0; frame < 60; ++frame) chain.move(1.0 / 60.0, Vector3::Zero(), open_air);
  for (const Vector3& p : chain.points()) {
    EXPECT_NEAR(p.y(), -0.5 * strength, 0.003 * 0.5 * strength);
  }
}

TEST(LooseChain, StaysOutOfWheelsAndGround) {
  LooseChain::Surroundings around = open_air;
  around.wheels = {{{0, 0, 0}, {0, 0, 1}, 0.5}};
  around.ground = PolylineFloor{{0, -1, 0}};
  LooseChain chain(std::vector<Vector3>{{-3, 0.8, 0}, {3, 0.8, 0}}, 6.0, false);
  for (int frame = 0; frame < 300; ++frame) {
    chain.move(1.0 / 60.0, Vector3::Zero(), around);
    for (const Vector3& p : chain.points()) {
      ASSERT_GE(p.y(), -1.0 - 1e-9);
      ASSERT_GE(Vector3(p.x(), p.y(), 0).norm(), 0.5 - 1e-9);
    }
  }
}

/// A weight on a rope over a wheel; the rope is cut at 0.1 s.
Simulation cut_rope() {
  test::Machine machine;
  machine.model.gravity = {0.0, -strength, 0.0};
  machine.model.step.dt = 1.0 / 60.0;
  const BodyId wheel = machine.model.add(test::wheel("wheel", {0.0, 0.0, 0.0}, 0.25, 0.05));
  const BodyId load = machine.model.add(test::weight("load", {0.25, -2.0, 0.0}, 3.0));
  CableDef rope = test::cable("rope", {test::attach(BodyId::world(), {-0.25, -1.0, 0.0}),
                                       test::roll(wheel, test::right), test::attach(load)});
  rope.cut_time = 0.1;
  machine.cables.push_back(rope);
  return test::start(machine);
}

TEST(CutRopes, APieceBeginsWhereTheCableWas) {
  Simulation simulation = cut_rope();
  CutRopes ropes;
  std::vector<std::vector<Vector3>> before;
  for (int frame = 0; frame < 60; ++frame) {
    const std::vector<CableReport> cables = simulation.cable_reports();
    ropes.follow(simulation.world, cables);
    const auto pieces = ropes.pieces(0);
    ASSERT_EQ(pieces.size(), cables[0].cut ? 2U : 0U);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      // Chords across the arc of the first pictures are shorter than the arc.
      EXPECT_NEAR(length_of(pieces[k]), cables[0].pieces[k], 0.03 * cables[0].pieces[k]);
      // No point moves farther in a frame than a tip that falls for a second and cracks the whip.
      if (before.empty()) continue;
      for (std::size_t i = 0; i < pieces[k].size(); ++i) {
        EXPECT_LE((pieces[k][i] - before[k][i]).norm(), 3.0 * strength / 60.0);
      }
    }
    before.assign(pieces.begin(), pieces.end());
    EXPECT_TRUE(simulation.step().ok());
  }
  // The second piece is held by the falling load.
  EXPECT_LE((before[1].front() - simulation.world.position(BodyId{1})).norm(), 0.2);
}

TEST(CutRopes, WithoutThePastAPieceHangsAtRest) {
  Simulation simulation = cut_rope();
  for (int frame = 0; frame < 10; ++frame) EXPECT_TRUE(simulation.step().ok());
  CutRopes ropes;
  ropes.follow(simulation.world, simulation.cable_reports());
  ASSERT_EQ(ropes.pieces(0).size(), 2U);
  for (const Vector3& p : ropes.pieces(0)[0]) {
    EXPECT_NEAR(p.x(), -0.25, 1e-12);
    EXPECT_LE(p.y(), -1.0 + 1e-12);
  }
  EXPECT_TRUE(ropes.pieces(7).empty());
}

}  // namespace
}  // namespace sheave::render
