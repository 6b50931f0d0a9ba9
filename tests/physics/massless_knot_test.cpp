// Knots without mass: cable/knots.h.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/reactions.h"
#include "engine/index.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

BodyDef knot_at(const Vector3& position, const std::string& name = "knot") {
  BodyDef knot;
  knot.name = name;
  knot.mobility = Mobility::knot;
  knot.position = position;
  return knot;
}

/// Rotation of a whole machine, and its counting of cables.
struct Setting {
  Quaternion turn = Quaternion::Identity();
  bool mirrored = false;   ///< x to -x before the turn
  bool backwards = false;  ///< links from the other end
  [[nodiscard]] Vector3 operator()(Vector3 v) const {
    if (mirrored) v.x() = -v.x();
    return turn * v;
  }
  [[nodiscard]] Vector3 back(const Vector3& v) const {
    Vector3 own = turn.conjugate() * v;
    if (mirrored) own.x() = -own.x();
    return own;
  }
};

CableDef rope(const Setting& setting, const std::string& name,
              const std::shared_ptr<LinkDef>& first, const std::shared_ptr<LinkDef>& second) {
  return setting.backwards ? test::cable(name, {second, first})
                           : test::cable(name, {first, second});
}

constexpr double support_distance = 3.0;
constexpr double knot_depth = 4.0;
constexpr double load_rope = 2.0;
constexpr double bob_mass = 5.0;

/// Two ropes of 5 m from points 6 m apart to a knot 4 m below, and a load on 2 m of rope, which is
/// displaced by the angles `across` about the line between the upper ends and `within` in the plane of
/// the ropes. Bodies: 0 knot, 1 load.
test::Machine blackburn(const StepSettings& step, double across, double within,
                        const Setting& setting = {}) {
  test::Machine m;
  m.model.gravity = setting(test::down);
  m.model.step = step;
  const auto placed = [&](double x, double down) {
    return setting({x, -down * std::cos(across), down * std::sin(across)});
  };
  m.model.add(knot_at(placed(0.0, knot_depth)));
  m.model.add(test::lump(
      "load", placed(load_rope * std::sin(within), knot_depth + load_rope * std::cos(within)),
      bob_mass));
  const auto world = [&](double x) {
    return test::attach(BodyId::world(), setting({x, 0.0, 0.0}));
  };
  m.cables.push_back(rope(setting, "left", world(-support_distance), test::attach({0})));
  m.cables.push_back(rope(setting, "right", world(support_distance), test::attach({0})));
  m.cables.push_back(rope(setting, "lower", test::attach({0}), test::attach({1})));
  return m;
}

/// Blackburn's pendulum by its angles: across q[0], within q[1].
///   L / m = l^2 b'^2 / 2 + r^2 a'^2 / 2 + g r cos a,  r = h + l cos b
struct Angles {
  std::array<double, 2> angle{};
  std::array<double, 2> rate{};
  [[nodiscard]] std::array<double, 2> acceleration() const {
    const double r = knot_depth + load_rope * std::cos(angle[1]);
    const double slope = -load_rope * std::sin(angle[1]);  // dr/db
    return {
        (-test::g * std::sin(angle[0]) - 2.0 * slope * rate[0] * rate[1]) / r,
        slope * (r * rate[0] * rate[0] + test::g * std::cos(angle[0])) / (load_rope * load_rope)};
  }
  [[nodiscard]] Vector3 load() const {
    const double r = knot_depth + load_rope * std::cos(angle[1]);
    return {load_rope * std::sin(angle[1]), -r * std::cos(angle[0]), r * std::sin(angle[0])};
  }
  void step(double h) {
    const auto moved = [&](double share, const std::array<double, 4>& slope) {
      Angles next = *this;
      for (std::size_t i = 0; i < 2; ++i) {
        next.angle[i] += share * slope[i];
        next.rate[i] += share * slope[i + 2];
      }
      return next;
    };
    const auto slope = [](const Angles& at) {
      const auto a = at.acceleration();
      return std::array<double, 4>{at.rate[0], at.rate[1], a[0], a[1]};
    };
    const auto k1 = slope(*this);
    const auto k2 = slope(moved(0.5 * h, k1));
    const auto k3 = slope(moved(0.5 * h, k2));
    const auto k4 = slope(moved(h, k3));
    for (std::size_t i = 0; i < 2; ++i) {
      angle[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
      rate[i] += h / 6.0 * (k1[i + 2] + 2.0 * k2[i + 2] + 2.0 * k3[i + 2] + k4[i + 2]);
    }
  }
};

Angles swung(double across, double within, double time) {
  Angles angles{{across, within}, {}};
  const int steps = static_cast<int>(std::lround(time / 1e-3));
  for (int i = 0; i < steps; ++i) angles.step(time / steps);  // error below 1e-11
  return angles;
}

/// Distance of the load from Blackburn's pendulum after `time`.
double error_after(double time, IntegratorKind integrator, int substeps, double across,
                   double within, const Setting& setting = {}) {
  Simulation s = test::start(
      blackburn(test::direct_settings(integrator, 1.0 / 60.0, substeps), across, within, setting));
  bool clean = true;
  while (s.world.state().time < time - 1e-9 && clean) {
    clean = s.world.step().ok() && s.certificate()->clean();
  }
  EXPECT_TRUE(clean) << s.certificate()->worst()->sentence();
  return (setting.back(s.world.position({1})) - swung(across, within, time).load()).norm();
}

// Large amplitudes across and within the plane of the ropes. `rattle` is of second order, `xpbd` of
// first: four times the substeps divide the error by 16 and by 4.
TEST(MasslessKnot, SwingsAsBlackburnsPendulum) {
  const double rattle4 = error_after(3.0, IntegratorKind::rattle, 4, 0.5, 0.6);
  const double rattle16 = error_after(3.0, IntegratorKind::rattle, 16, 0.5, 0.6);
  EXPECT_NEAR(rattle4 / rattle16, 16.0, 0.5);
  EXPECT_LT(rattle16, 2e-5);
  const double xpbd16 = error_after(3.0, IntegratorKind::xpbd, 16, 0.5, 0.6);
  const double xpbd64 = error_after(3.0, IntegratorKind::xpbd, 64, 0.5, 0.6);
  EXPECT_NEAR(xpbd16 / xpbd64, 4.0, 0.4);
}

TEST(MasslessKnot, NumbersOfSubstepsTurnsAndMirrorsDoNotMatter) {
  Setting turned;
  turned.turn = Quaternion(0.3, -0.5, 0.7, 0.4).normalized();
  Setting mirrored = turned;
  mirrored.mirrored = true;
  Setting backwards;
  backwards.backwards = true;
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    const double straight = error_after(1.0, integrator, 4, 0.4, 0.3);
    for (const Setting& setting : {turned, mirrored, backwards}) {
      // Newton's residual of 1e-12 of the scene, over 240 substeps.
      EXPECT_NEAR(error_after(1.0, integrator, 4, 0.4, 0.3, setting), straight, 1e-9);
    }
  }
  // h w = 0.034 with one substep, and the error of the phase is (h w)^2 / 24 w t
  for (const int substeps : {1, 2, 8, 32, 64}) {
    const double turn = std::sqrt(test::g / load_rope) / (60.0 * substeps);
    EXPECT_LT(error_after(1.0, IntegratorKind::rattle, substeps, 0.4, 0.3), 0.5 * turn * turn);
  }
}

// Swinging in the plane of the ropes from 0.6 rad, the load pulls its rope with m g (3 cos b - 2 cos 0.6)
// and the left rope with that times (cos b / 1.6 + sin b / 1.2). The rope breaks at b = 0.3, which the
// search for the instant finds within the second order of a substep.
TEST(MasslessKnot, ARopeBreaksAtTheInstantOfItsTension) {
  Angles angles{{0.0, 0.6}, {}};
  double time = 0.0;
  constexpr double step = 1e-5;
  for (; angles.angle[1] > 0.3; time += step) angles.step(step);
  time -= (angles.angle[1] - 0.3) / angles.rate[1];
  const double pull = bob_mass * test::g * (3.0 * std::cos(0.3) - 2.0 * std::cos(0.6));
  for (const bool lower : {true, false}) {
    test::Machine m =
        blackburn(test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 8), 0.0, 0.6);
    const std::size_t rope = lower ? 2 : 0;
    m.cables[rope].breaking_tension =
        lower ? pull : pull * (std::cos(0.3) / 1.6 + std::sin(0.3) / 1.2);
    Simulation s = test::start(m);
    test::run(s.world, 0.5);
    ASSERT_EQ(s.cables->events().size(), 1U);
    EXPECT_NEAR(s.cables->events()[0].time, time, 2e-4);
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  }
}

/// Period of a pendulum with this length and amplitude.
double period_of(double length, double amplitude) {
  // arithmetic-geometric mean: T = 2 pi sqrt(l / g) / agm(1, cos(a / 2))
  double a = 1.0;
  double b = std::cos(0.5 * amplitude);
  for (int i = 0; i < 20; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2.0 * pi * std::sqrt(length / test::g) / a;
}

// In the plane of the ropes the load swings on its rope, across it on all of them. A coordinate passes
// 0 at a quarter of the period; the substep there is interpolated to second order.
TEST(MasslessKnot, TwoPeriods) {
  struct Case {
    double across, within, length;
    int axis;
  };
  for (const Case& way :
       {Case{0.3, 0.0, knot_depth + load_rope, 2}, Case{0.0, 0.3, load_rope, 0}}) {
    Simulation s = test::start(
        blackburn(test::direct_settings(IntegratorKind::rattle, 1e-3, 4), way.across, way.within));
    const double quarter = 0.25 * period_of(way.length, 0.3);
    while (s.world.position({1})[way.axis] > 0.0) ASSERT_TRUE(s.world.step().ok());
    const double passed =
        s.world.state().time - s.world.position({1})[way.axis] / s.world.velocity({1})[way.axis];
    EXPECT_NEAR(passed, quarter, 1e-7);
  }
}

// The weight of the load on ropes of unequal length, by hand: T1 sin a1 = T2 sin a2 and
// T1 cos a1 + T2 cos a2 = W.
TEST(MasslessKnot, HoldsAWeightOnUnequalRopes) {
  for (const IntegratorKind integrator : {IntegratorKind::rattle, IntegratorKind::xpbd}) {
    for (const SolverKind solver : {SolverKind::direct, SolverKind::gauss_seidel}) {
      for (const std::optional<double> stiffness : {std::optional<double>(), {1e5}}) {
        SCOPED_TRACE(std::to_string(static_cast<int>(integrator)) + " " +
                     std::to_string(static_cast<int>(solver)) + (stiffness ? " elastic" : ""));
        test::Machine m;
        m.model.gravity = test::down;
        m.model.step = test::direct_settings(integrator, 1.0 / 60.0, 4);
        m.model.step.solver = solver;
        m.model.add(knot_at({0.0, -1.0, 0.0}));
        m.model.add(test::lump("load", {0.0, -2.5, 0.0}, bob_mass));
        m.cables.push_back(test::cable(
            "left", {test::attach(BodyId::world(), {-2.0, 0.5, 0.0}), test::attach({0})}));
        m.cables.push_back(test::cable(
            "right", {test::attach({0}), test::attach(BodyId::world(), {1.0, 1.0, 0.0})}));
        m.cables.push_back(test::cable("lower", {test::attach({0}), test::attach({1})}));
        const Vector3 first = Vector3(-2.0, 1.5, 0.0).normalized();
        const Vector3 second = Vector3(1.0, 2.0, 0.0).normalized();
        const double weight = bob_mass * test::g;
        const double cross = first.x() * second.y() - first.y() * second.x();
        const std::array<double, 3> tensions{-weight * second.x() / cross,
                                             weight * first.x() / cross, weight};
        for (std::size_t i = 0; i < 3; ++i) {
          if (!stiffness) continue;
          m.cables[i].axial_stiffness = stiffness;
          m.cables[i].pretension = tensions[i];
        }
        Simulation s = test::start(m);
        test::run(s.world, 0.5);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(s.cable_reports()[i].spans[0].tension, tensions[i], 1e-8 * weight);
        }
        EXPECT_NEAR((s.world.position({0}) - Vector3(0.0, -1.0, 0.0)).norm(), 0.0, 1e-9);
        EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
      }
    }
  }
}

/// Three bodies on ropes that meet at a knot, without gravity, each with a velocity across its rope.
test::Machine bolas(const StepSettings& step, std::optional<double> stiffness) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = step;
  m.model.add(knot_at({0.0, 0.0, 0.0}));
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * pi * i / 3.0;
    BodyDef body = test::lump("ball " + std::to_string(i), {std::cos(angle), std::sin(angle), 0.0},
                              1.0 + 0.1 * i);
    body.velocity = {-std::sin(angle) + 0.03 * i, std::cos(angle), 0.1 * i};
    m.model.add(body);
    m.cables.push_back(test::cable("rope " + std::to_string(i),
                                   {test::attach({0}), test::attach({i + 1}, {0.0, 0.05, 0.02})}));
    m.cables.back().axial_stiffness = stiffness;
  }
  return m;
}

// Internal forces change no momentum; the sum of 7680 impulses is rounded. The energy of `rattle` is off
// by second order. Elastic ropes begin without stretch and vibrate, and are slack in between.
TEST(MasslessKnot, ConservesMomentumAndEnergy) {
  for (const std::optional<double> stiffness : {std::optional<double>(), {200.0}}) {
    std::array<double, 2> drift{};
    for (const int fine : {0, 1}) {
      Simulation s = test::start(
          bolas(test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, fine == 0 ? 16 : 64),
                stiffness));
      const auto before = momentum(s.world);
      // The velocities of the start leave rigid ropes slack for 0.1 s; then an impact takes energy.
      for (int i = 0; i < 12; ++i) ASSERT_TRUE(s.world.step().ok());
      const double energy = s.world.energy().total();
      for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        drift[at(fine)] = std::max(drift[at(fine)], std::abs(s.world.energy().total() - energy));
      }
      const auto after = momentum(s.world);
      EXPECT_LE((after.linear - before.linear).norm(), 1e-9);
      EXPECT_LE((after.angular - before.angular).norm(), 1e-9);
      EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
    }
    EXPECT_NEAR(drift[0] / drift[1], 16.0, 1.0);
    EXPECT_LT(drift[1], 1e-6);
  }
}

// Two ropes end to end are one of both compliances, 10 m of EA = 1 MN and 2 m of 20 kN, from their
// pretension of 500 N.
TEST(MasslessKnot, ASpliceIsOneSpring) {
  test::Machine m;
  m.model.gravity = Vector3::Zero();
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1e-3, 4);
  m.model.add(knot_at({0.0, -10.0, 0.0}));
  m.model.add(test::weight("load", {0.0, -12.0, 0.0}, 50.0));
  m.cables.push_back(test::cable("steel", {test::attach(BodyId::world()), test::attach({0})}));
  m.cables.push_back(test::cable("nylon", {test::attach({0}), test::attach({1})}));
  m.cables[0].axial_stiffness = 1e6;
  m.cables[1].axial_stiffness = 2e4;
  for (CableDef& own : m.cables) own.pretension = 500.0;
  m.model.bodies[1].force = {0.0, -500.0, 0.0};
  m.model.bodies[1].velocity = {0.0, 0.1, 0.0};
  const double steel = 10.0 / (1.0 + 500.0 / 1e6) / 1e6;
  const double nylon = 2.0 / (1.0 + 500.0 / 2e4) / 2e4;
  const double frequency = std::sqrt(1.0 / (steel + nylon) / 50.0);
  Simulation s = test::start(m);
  test::run(s.world, 0.5);
  // y = -12 + v / w sin w t. The mean forces of springs are off by the phase (h w)^2 / 12 w t = 6.5e-6.
  const double wave = 0.1 / frequency;
  EXPECT_NEAR(s.world.position({1}).y(), -12.0 + wave * std::sin(0.5 * frequency), 7e-6 * wave);
  const double tension = 500.0 - wave * std::sin(0.5 * frequency) / (steel + nylon);
  for (const CableReport& report : s.cable_reports()) {
    EXPECT_NEAR(report.spans[0].tension, tension, 0.5);
  }
}

}  // namespace
}  // namespace sheave
