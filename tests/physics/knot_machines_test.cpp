// Knots without mass on ropes that run over wheels, become taut, stretch and are cut, and their statics
// and modes: cable/knots.h.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/links/pinhole.h"
#include "engine/index.h"
#include "statics/equilibrium.h"
#include "statics/modes.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

BodyDef knot_body(const Vector3& position) {
  BodyDef knot;
  knot.name = "knot";
  knot.mobility = Mobility::knot;
  knot.position = position;
  return knot;
}

StepSettings rattle_steps(int substeps) {
  return test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, substeps);
}

/// A weight on a Y of ropes of 5, 5 and 2 m; 0 knot, 1 load.
test::Machine weight_on_ropes(std::optional<double> stiffness, double lifted = 0.0) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = rattle_steps(4);
  m.model.add(knot_body({0.0, -4.0, 0.0}));
  m.model.add(test::lump("load", {0.0, -6.0 + lifted, 0.0}, 10.0));
  const auto add = [&](const char* name, const std::shared_ptr<LinkDef>& first,
                       const std::shared_ptr<LinkDef>& second, double length) {
    m.cables.push_back(test::cable(name, {first, second}));
    m.cables.back().axial_stiffness = stiffness;
    m.cables.back().rest_lengths = {length};
  };
  add("left", test::attach(BodyId::world(), {-3.0, 0.0, 0.0}), test::attach({0}), 5.0);
  add("right", test::attach({0}), test::attach(BodyId::world(), {3.0, 0.0, 0.0}), 5.0);
  add("lower", test::attach({0}), test::attach({1}), 2.0);
  return m;
}

constexpr double pulley_distance = 1.5;
constexpr double counter_mass = 1.0;
constexpr double middle_mass = 1.2;

/// A load below a knot between two ropes that run over pinholes, or wheels, to weights; 0 knot, 1 load,
/// 2 and 3 weights, then wheels.
test::Machine three_weights(const StepSettings& step, double depth, double radius,
                            std::optional<double> stiffness = std::nullopt) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step;
  m.model.add(knot_body({0.0, -depth, 0.0}));
  m.model.add(test::weight("load", {0.0, -depth - 1.0, 0.0}, middle_mass));
  m.model.add(test::weight("left", {-pulley_distance - radius, -3.0, 0.0}, counter_mass));
  m.model.add(test::weight("right", {pulley_distance + radius, -3.0, 0.0}, counter_mass));
  std::shared_ptr<LinkDef> left_top;
  std::shared_ptr<LinkDef> right_top;
  if (radius > 0.0) {
    m.model.add(test::wheel("left wheel", {-pulley_distance, 0.0, 0.0}, radius, 0.01));
    m.model.add(test::wheel("right wheel", {pulley_distance, 0.0, 0.0}, radius, 0.01));
    left_top = test::roll({4}, test::left);
    right_top = test::roll({5}, test::right);
  } else {
    const auto hole = [](double x) {
      auto link = std::make_shared<PinholeLink>();
      link->body = BodyId::world();
      link->point = {x, 0.0, 0.0};
      return link;
    };
    left_top = hole(-pulley_distance);
    right_top = hole(pulley_distance);
  }
  m.cables.push_back(test::cable("left", {test::attach({0}), left_top, test::attach({2})}));
  m.cables.push_back(test::cable("right", {test::attach({0}), right_top, test::attach({3})}));
  m.cables.push_back(test::cable("middle", {test::attach({1}), test::attach({0})}));
  for (CableDef& cable : m.cables) cable.axial_stiffness = stiffness;
  return m;
}

/// Height of the knot after `time` from rest at `y`, with r = sqrt(a^2 + y^2) and the energy
/// (M + 2 m y^2 / r^2) v^2 / 2 + M g y + 2 m g r.
double sunk(double y, double time) {
  const auto acceleration = [](double at, double v) {
    const double r = std::hypot(pulley_distance, at);
    const double inertia = middle_mass + 2.0 * counter_mass * at * at / (r * r);
    const double slope =
        4.0 * counter_mass * at * pulley_distance * pulley_distance / std::pow(r, 4);
    return -(0.5 * slope * v * v + middle_mass * test::g + 2.0 * counter_mass * test::g * at / r) /
           inertia;
  };
  constexpr int steps = 4000;  // of Runge-Kutta's method; error below 1e-12
  const double h = time / steps;
  double v = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double a1 = acceleration(y, v);
    const double a2 = acceleration(y + 0.5 * h * v, v + 0.5 * h * a1);
    const double a3 = acceleration(y + 0.5 * h * (v + 0.5 * h * a1), v + 0.5 * h * a2);
    const double a4 = acceleration(y + h * (v + 0.5 * h * a2), v + h * a3);
    y += h * v + h * h / 6.0 * (a1 + a2 + a3);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return y;
}

// Ropes that run through pinholes to weights; second order.
TEST(KnotMachines, WeightsPullTheKnotThroughPinholes) {
  std::array<double, 2> errors{};
  for (const int fine : {0, 1}) {
    Simulation s = test::start(three_weights(rattle_steps(fine == 0 ? 4 : 16), 0.5, 0.0));
    test::run(s.world, 1.0);
    errors[at(fine)] = std::abs(s.world.position({0}).y() - sunk(-0.5, 1.0));
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    const auto reports = s.cable_reports();
    EXPECT_NEAR(reports[0].spans[0].tension, reports[0].spans[1].tension, 1e-9);
  }
  EXPECT_NEAR(errors[0] / errors[1], 16.0, 1.0);
  EXPECT_LT(errors[1], 1e-5);
}

// At rest each side rope has m g, and the ropes at the knot have the slope M / 2 m = 0.6. Over wheels of
// the radius r they are tangents: the knot is at y = -a 0.6 / 0.8 - r / 0.8 + ... : the line at the
// distance r outside of the centre.
TEST(KnotMachines, StaticsOfThreeWeights) {
  for (const double radius : {0.0, 0.1}) {
    Simulation s = test::start(three_weights(rattle_steps(4), 0.6, radius));
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    EXPECT_EQ(rest.stability, Stability::stable);
    // The rope passes above the centre of the wheel at the distance r: 0.8 y' = 0.6 x - r
    const double y = -(0.6 * pulley_distance - radius) / 0.8;
    EXPECT_NEAR(s.world.position({0}).y(), y, 1e-9);
    EXPECT_NEAR(s.world.position({0}).x(), 0.0, 1e-9);
    const auto reports = s.cable_reports();
    EXPECT_NEAR(reports[0].spans[0].tension, counter_mass * test::g, 1e-9);
    EXPECT_NEAR(reports[1].spans[0].tension, counter_mass * test::g, 1e-9);
    EXPECT_NEAR(reports[2].spans[0].tension, middle_mass * test::g, 1e-9);
  }
}

// Over wheels with inertia the energy is off by second order, also with `xpbd` no law is broken.
TEST(KnotMachines, WheelsTurnWithTheRopes) {
  std::array<double, 2> drift{};
  for (const int fine : {0, 1}) {
    Simulation s = test::start(three_weights(rattle_steps(fine == 0 ? 4 : 16), 0.5, 0.1));
    const double start = s.world.energy().total();
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      drift[at(fine)] = std::max(drift[at(fine)], std::abs(s.world.energy().total() - start));
    }
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    for (const CableReport& report : s.cable_reports()) EXPECT_EQ(report.length_error, 0.0);
  }
  EXPECT_NEAR(drift[0] / drift[1], 16.0, 2.0);
  Simulation s = test::start(
      three_weights(test::direct_settings(IntegratorKind::xpbd, 1.0 / 60.0, 16), 0.5, 0.1));
  test::run(s.world, 1.0);
  EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
}

// Elastic ropes over wheels: at rest the tensions are those of the weights. Rope comes onto the
// wheels with one strain and off them with another, which takes energy by creep: the energy that is left
// converges in second order.
TEST(KnotMachines, ElasticRopesRunOverWheels) {
  Simulation s = test::start(three_weights(rattle_steps(4), 0.6, 0.1, 5e3));
  const Equilibrium rest = find_equilibrium(s);
  ASSERT_TRUE(rest.converged) << rest.message;
  const double y = -(0.6 * pulley_distance - 0.1) / 0.8;
  EXPECT_NEAR(s.world.position({0}).y(), y, 1e-9);
  const auto reports = s.cable_reports();
  for (const std::size_t side : {0, 1}) {
    for (const SpanReport& span : reports[side].spans) {
      EXPECT_NEAR(span.tension, counter_mass * test::g, 1e-8);
    }
  }
  EXPECT_NEAR(reports[2].spans[0].tension, middle_mass * test::g, 1e-8);
  std::vector<double> left;
  for (const int substeps : {8, 32, 128}) {
    test::Machine m = three_weights(rattle_steps(substeps), 1.0, 0.1, 5e3);
    for (const std::size_t i : {0, 1, 2}) {
      m.cables[i].pretension = (i < 2 ? counter_mass : middle_mass) * test::g;
    }
    m.model.bodies[1].velocity = {0.0, 0.3, 0.0};
    Simulation moving = test::start(m);
    test::run(moving.world, 1.0);
    left.push_back(moving.world.energy().total());
    EXPECT_TRUE(moving.certificate()->clean()) << moving.certificate()->worst()->sentence();
    for (const CableReport& report : moving.cable_reports()) EXPECT_EQ(report.length_error, 0.0);
  }
  EXPECT_NEAR((left[0] - left[1]) / (left[1] - left[2]), 16.0, 2.0);
}

// Blackburn's frequencies: sqrt(g / 2 m) in the plane of the ropes and sqrt(g / 6 m) across it. Ropes of
// EA = 1 MN are longer by their stretch, and let the knot move sideways with the compliance
// 5 m / EA / (2 x 0.6^2) in series with W / l. Products of both, 1e-7, are left out.
TEST(KnotMachines, ModesOfBlackburnsPendulum) {
  for (const std::optional<double> stiffness : {std::optional<double>(), {1e6}}) {
    Simulation s = test::start(weight_on_ropes(stiffness));
    const Equilibrium rest = find_equilibrium(s);
    ASSERT_TRUE(rest.converged) << rest.message;
    const Modes modes = find_modes(s);
    const double weight = 10.0 * test::g;
    const double soft = stiffness ? 1.0 / *stiffness : 0.0;
    const double yield = 2.0 * soft + 5.0 * soft / (2.0 * 0.8 * 0.8);
    const std::array<double, 2> softness{
        (2.0 + 2.0 * weight * soft) / weight + 5.0 * soft / (2.0 * 0.6 * 0.6),
        (6.0 + weight * yield) / weight};
    for (const double length : softness) {
      const double expected = std::sqrt(1.0 / (10.0 * length)) / (2.0 * pi);
      double nearest = 1.0;
      for (const Mode& mode : modes.modes) {
        nearest = std::min(nearest, std::abs(mode.frequency - expected) / expected);
      }
      EXPECT_LT(nearest, 1e-6) << length;
    }
    // Two ropes at the angle with the cosine 0.8 carry the load: their stretch counts 1 / 2 0.8^2.
    if (!stiffness) continue;
    EXPECT_NEAR(s.world.position({1}).y(), -6.0 - weight * yield, 1e-3 * weight * yield);
    const double bounce = std::sqrt(1.0 / (10.0 * yield)) / (2.0 * pi);
    double nearest = 1.0;
    for (const Mode& mode : modes.modes) {
      nearest = std::min(nearest, std::abs(mode.frequency - bounce) / bounce);
    }
    EXPECT_LT(nearest, 1e-3);
  }
}

// A load falls by 1 m before its ropes are taut. Rigid ropes stop it; elastic ones give the energy back.
TEST(KnotMachines, SlackRopesBecomeTaut) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
      test::Machine m = weight_on_ropes(std::nullopt, 1.0);
      m.model.step.integrator = integrator;
      m.model.step.solver = solver;
      Simulation s = test::start(m);
      const double h = 1.0 / 240.0;
      for (int i = 0; i < 24; ++i) ASSERT_TRUE(s.world.step().ok());
      // `xpbd` falls by h v / 2 farther
      const double late = integrator == IntegratorKind::xpbd ? 0.5 * h * test::g * 0.4 : 0.0;
      EXPECT_NEAR(s.world.position({1}).y(), -5.0 - 0.08 * test::g - late, 1e-9);
      EXPECT_EQ(s.cable_reports()[2].spans[0].tension, 0.0);
      // The knot has equally much to spare to the supports and to the load.
      const Vector3 point = s.world.position({0});
      EXPECT_NEAR(5.0 - std::hypot(3.0, point.y()), 2.0 - (point.y() - s.world.position({1}).y()),
                  1e-9);
      test::run(s.world, 1.0);
      EXPECT_NEAR(s.world.position({1}).y(), -6.0, 1e-9);
      EXPECT_NEAR(s.cable_reports()[2].spans[0].tension, 10.0 * test::g, 1e-6);
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    }
  }
  std::array<double, 2> drift{};
  for (const int fine : {0, 1}) {
    test::Machine m = weight_on_ropes(5e3, 1.0);
    m.model.step = rattle_steps(fine == 0 ? 16 : 64);
    Simulation s = test::start(m);
    const double start = s.world.energy().total();
    for (int i = 0; i < 120; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      drift[at(fine)] = std::max(drift[at(fine)], std::abs(s.world.energy().total() - start));
    }
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  }
  // The instant at which ropes become taut lies anywhere in a substep, so single errors vary.
  EXPECT_LT(drift[1], 0.2 * drift[0]);
  EXPECT_LT(drift[1], 1e-2);
}

// The certificate of every substep, with knots that become slack and taut, and a fed rope. The knot of
// elastic ropes does not tell how they share their spare length.
TEST(KnotMachines, EverySubstepIsCertified) {
  for (const std::optional<double> stiffness : {std::optional<double>(), {5e3}}) {
    for (const double feed : {0.0, 0.1}) {
      for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
        test::Machine m = weight_on_ropes(stiffness, 0.3);
        m.model.bodies[1].velocity = {0.2, 0.0, 0.3};
        m.model.step = test::direct_settings(integrator, 1.0 / 960.0, 1);
        auto fed = test::attach(BodyId::world(), {3.0, 0.0, 0.0});
        fed->feed_speed = feed;
        m.cables[1].links = {test::attach({0}), fed};
        Simulation s = test::start(m);
        bool clean = true;
        for (int i = 0; i < 1440 && clean; ++i) {
          ASSERT_TRUE(s.world.step().ok());
          clean = s.certificate()->clean();
        }
        EXPECT_TRUE(clean) << (stiffness ? "elastic " : "rigid ") << feed << " "
                           << static_cast<int>(integrator) << " at " << s.world.state().time << ": "
                           << s.certificate()->worst()->sentence();
      }
    }
  }
}

// A cut rope leaves the knot to the other two, which become one line: a pendulum of 5 + 2 m.
TEST(KnotMachines, ACutRopeLeavesTheOthers) {
  test::Machine m = weight_on_ropes(std::nullopt);
  m.model.step = rattle_steps(16);
  m.cables[1].cut_time = 0.25;
  Simulation s = test::start(m);
  for (int i = 0; i < 240; ++i) ASSERT_TRUE(s.world.step().ok());
  EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  const Vector3 support{-3.0, 0.0, 0.0};
  const Vector3 knot = s.world.position({0});
  const Vector3 load = s.world.position({1});
  EXPECT_NEAR((load - support).norm(), 7.0, 1e-9);
  EXPECT_NEAR((knot - support).norm(), 5.0, 1e-9);
  EXPECT_NEAR((load - knot).norm(), 2.0, 1e-9);
  const auto reports = s.cable_reports();
  EXPECT_NEAR(reports[0].spans[0].tension, reports[2].spans[0].tension, 1e-9);
}

// Three ropes and a load: the shares of four ropes in space follow from their directions.
TEST(KnotMachines, FourRopesInSpace) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = rattle_steps(8);
  m.model.add(knot_body({0.0, -2.0, 0.0}));
  BodyDef load = test::lump("load", {0.0, -3.0, 0.0}, 10.0);
  load.velocity = {0.4, 0.0, 0.3};
  m.model.add(load);
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * pi * i / 3.0;
    m.cables.push_back(test::cable(
        "stay " + std::to_string(i),
        {test::attach(BodyId::world(), {1.5 * std::cos(angle), 0.0, 1.5 * std::sin(angle)}),
         test::attach({0})}));
  }
  m.cables.push_back(test::cable("lower", {test::attach({0}), test::attach({1})}));
  Simulation s = test::start(m);
  const double start = s.world.energy().total();
  // The load swings on 1 m below a knot that three taut stays hold.
  for (int i = 0; i < 120; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR((s.world.position({0}) - Vector3(0.0, -2.0, 0.0)).norm(), 0.0, 1e-9);
  }
  EXPECT_NEAR(s.world.energy().total(), start, 1e-3);
  EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
}

// A run that is saved and continued equals one without interruption, also with a slack knot.
TEST(KnotMachines, SavedStatesContinueBitForBit) {
  for (const double lifted : {0.0, 1.0}) {
    const test::Machine m = weight_on_ropes(1e4, lifted);
    Simulation whole = test::start(m);
    Simulation first = test::start(m);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(whole.world.step().ok() && first.world.step().ok());
    Simulation second = test::start(m);
    ASSERT_TRUE(second.world.restore(first.world.state()).empty());
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(whole.world.step().ok() && second.world.step().ok());
    EXPECT_EQ(whole.world.state().bodies[0].position, second.world.state().bodies[0].position);
    EXPECT_EQ(whole.world.state().bodies[1].position, second.world.state().bodies[1].position);
    EXPECT_EQ(whole.world.state().features.back().reals,
              second.world.state().features.back().reals);
  }
}

}  // namespace
}  // namespace sheave
