// Losses of sheaves oppose the travel of the cable: tension out = efficiency x tension in, in the
// direction in which the cable moves; at rest anything within. Two weights over one sheave, the
// second one moving down at v (s = sign v), have with q = e^-s
//
//   T2 = q T1,   T1 = m1 (g + a),   T2 = m2 (g - a)   =>   a = (m2 - q m1) g / (m2 + q m1)
//
// for as long as v keeps its sign, whichever way they are pulled. Equal weights slow down by
// g (1 - e) / (1 + e). All forces are constant between reversals, so every step is exact but
// for rounding.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/reactions.h"
#include "tests/support/builders.h"
#include "tests/support/friction_links.h"
#include "tests/support/sheave_cases.h"

namespace sheave::lossy_sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::roll;

constexpr double radius = 0.1;

class EfficiencyOfTravel : public test::SheaveCases {
 protected:
  [[nodiscard]] static test::Machine machine() { return test::SheaveCases::machine(200); }
  /// Of a tension T that accelerates `mass`: lengths of up to 8 m carry some 1e-15 of themselves,
  /// which is a force over h^2; sweeps end within 1e-9.
  [[nodiscard]] static double rounding(double tension, double mass) {
    return 1e-9 * tension + 1e-13 * mass / (h() * h());
  }
};
INSTANTIATE_TEST_SUITE_P(All, EfficiencyOfTravel,
                         testing::Combine(testing::ValuesIn(test::combinations),
                                          testing::Values(1, 4, 64, 256)),
                         test::sheave_case_name);

/// Tensions from the first weight's side on, whichever way the cable is counted.
std::vector<double> tensions(const Simulation& s, bool turned) {
  std::vector<double> all = test::tensions(s.cable_reports()[0]);
  if (turned) std::reverse(all.begin(), all.end());
  return all;
}

BodyDef massless(std::string name, const Vector3& center) {
  BodyDef wheel = test::wheel(std::move(name), center, radius, 1.0);
  wheel.spin_inertia = 0.0;
  return wheel;
}

std::shared_ptr<RollingLink> lossy(BodyId body, Winding winding, double efficiency) {
  auto link = roll(body, winding);
  link->efficiency = efficiency;
  return link;
}

/// What bends a cable by half a turn and passes on a share e of its tension.
enum class Bend { sheave, post, hole };

struct Weights {
  double m1 = 2.0;
  double m2 = 2.0;
  double efficiency = 0.9;
  double speed = 2.0;  ///< of the second one, downwards [m/s]

  /// Of the second weight downwards, while it goes down (1) or up (-1).
  [[nodiscard]] double acceleration(int way) const {
    const double q = std::pow(efficiency, -way);
    return (m2 - q * m1) * g / (m2 + q * m1);
  }
  void add(test::Machine& m, Bend bend, bool turned) const {
    const double r = bend == Bend::hole ? 0.0 : radius;
    for (const int side : {-1, 1}) {
      BodyDef weight =
          test::weight(side < 0 ? "first" : "second", {side * r, -4, 0}, side < 0 ? m1 : m2);
      weight.velocity = {0.0, -side * speed, 0.0};
      m.model.add(weight);
    }
    const double friction = -std::log(efficiency) / pi;
    std::shared_ptr<LinkDef> link;
    switch (bend) {
      case Bend::sheave:
        link = lossy(m.model.add(massless("sheave", {0, 0, 0})), right, efficiency);
        break;
      case Bend::post:
        link = test::wrapped(m.model.add(test::post("post", {0, 0, 0}, radius)), right, friction);
        break;
      case Bend::hole:
        link = test::eyelet(BodyId::world(), {0, 0, 0}, friction);
        break;
    }
    m.cables.push_back(cable("rope", {attach({0}), link, attach({1})}));
    if (turned) test::count_from_the_other_end(m.cables[0]);
  }
};

/// Runs to `time` and expects that it has moved one way all the time.
void expect_coasting(const test::Machine& m, const Weights& w, double time, bool turned,
                     double tolerance) {
  Simulation s = test::start(m);
  test::run(s.world, time);
  const double a = w.acceleration(w.speed > 0.0 ? 1 : -1);
  EXPECT_NEAR(-s.world.velocity({1}).y(), w.speed + a * time, tolerance);
  const std::vector<double> t = tensions(s, turned);
  EXPECT_NEAR(t[0], w.m1 * (g + a), tolerance * w.m1 * g);
  EXPECT_NEAR(t[1], w.m2 * (g - a), tolerance * w.m2 * g);
  // The link takes (T_out - T_in) x travel.
  const auto reactions = Reactions::of(s);
  ASSERT_TRUE(reactions.has_value());
  const double h = s.world.last_substep()->h;
  const bool rattle = m.model.step.integrator == IntegratorKind::rattle;
  const double travelled = w.speed + a * (rattle ? time - 0.5 * h : time);
  EXPECT_NEAR(reactions->friction(), (t[1] - t[0]) * travelled,
              100.0 * tolerance * std::abs(w.speed) * g);
  const auto certificate = s.certificate();
  ASSERT_TRUE(certificate.has_value());
  EXPECT_TRUE(certificate->clean(1e-6)) << certificate->worst()->sentence();
}

TEST_P(EfficiencyOfTravel, WeightsThatCoastSlowDown) {
  for (const Bend bend : {Bend::sheave, Bend::post, Bend::hole}) {
    for (const double speed : {2.0, -2.0}) {
      for (const bool turned : {false, true}) {
        const Weights w{.speed = speed};
        test::Machine m = machine();
        w.add(m, bend, turned);
        EXPECT_NEAR(std::abs(w.acceleration(1)), g * 0.1 / 1.9, 1e-12);
        expect_coasting(m, w, 0.25, turned, rounding(1.0, 1.0));
      }
    }
  }
}

TEST_P(EfficiencyOfTravel, AWeightThrownAgainstItsLoadIsBraked) {
  for (const Bend bend : {Bend::sheave, Bend::post}) {
    for (const bool turned : {false, true}) {
      // It rises and is pulled back; it goes down and is pulled on.
      for (const double speed : {2.0, -2.0}) {
        const Weights w{.m1 = 2.0, .m2 = 1.0, .efficiency = 0.8, .speed = speed};
        test::Machine m = machine();
        w.add(m, bend, turned);
        expect_coasting(m, w, 0.25, turned, rounding(1.0, 1.0));
      }
    }
  }
}

// Within the substep in which it reverses one of both laws acts: the speed is off by no more than
// the difference of the accelerations over the substep.
TEST_P(EfficiencyOfTravel, AThrownWeightComesBackOrStays) {
  for (const double heavy : {2.0, 1.1}) {
    const Weights w{.m1 = heavy, .m2 = 1.0, .efficiency = 0.8, .speed = 0.4};
    test::Machine m = machine();
    w.add(m, Bend::sheave, false);
    Simulation s = test::start(m);
    test::run(s.world, 0.5);
    const double up = w.acceleration(1);
    const double stop = -w.speed / up;
    ASSERT_LT(stop, 0.5);
    const double back = heavy > 1.25 ? w.acceleration(-1) : 0.0;
    const double allowed = heavy > 1.25 ? h() * std::abs(up - back) : rounding(1.0, 1.0);
    EXPECT_NEAR(-s.world.velocity({1}).y(), back * (0.5 - stop), allowed + rounding(1.0, 1.0));
    const std::vector<double> t = tensions(s, false);
    EXPECT_NEAR(t[0], heavy * (g + back), rounding(heavy * g, heavy));
    EXPECT_NEAR(t[1], g - back, rounding(g, 1.0));
    expect_clean(s);
  }
}

/// A drum winds a rope in over so many sheaves in a row, pays it out, and the load follows.
test::Machine winch(test::Machine m, int sheaves, double efficiency, double inertia) {
  BodyDef load = test::weight("load", {0, -1, 0}, 100.0);
  m.model.add(load);
  BodyDef drum = test::wheel("drum", {3.0 * radius + sheaves - 1, -2, 0}, radius, 1.0);
  drum.drive = DriveKind::speed;
  drum.drive_times = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2};
  drum.drive_values = {0.0, 3.0, 3.0, 0.0, -3.0, -3.0, 0.0};
  m.model.add(drum);
  CableDef rope = cable("rope", {attach({0})});
  for (int k = 0; k < sheaves; ++k) {
    BodyDef wheel = massless("sheave " + std::to_string(k), {radius + k, 1, 0});
    wheel.spin_inertia = inertia;
    rope.links.push_back(lossy(m.model.add(wheel), right, efficiency));
  }
  auto spool = std::make_shared<SpoolLink>();
  spool->body = {1};
  spool->winding = left;
  spool->stored_length = 3.0;
  rope.links.push_back(spool);
  m.cables.push_back(rope);
  return m;
}

/// Times in whose steps the drum moves one way, its acceleration [rad/s2], and that way.
struct Moment {
  double time;
  double acceleration;
  int way;
};
constexpr std::array<Moment, 6> moments{{{0.15, 15.0, 1},
                                         {0.35, 0.0, 1},
                                         {0.55, -15.0, 1},
                                         {0.75, -15.0, -1},
                                         {0.95, 0.0, -1},
                                         {1.15, 15.0, -1}}};

// Nothing but the drum decides what the spans between it and the first sheave do.
TEST_P(EfficiencyOfTravel, AWinchLiftsAndLowers) {
  for (const int sheaves : {1, 3}) {
    for (const bool turned : {false, true}) {
      test::Machine m = winch(machine(), sheaves, 0.95, 0.0);
      if (turned) test::count_from_the_other_end(m.cables[0]);
      Simulation s = test::start(m);
      for (const Moment& at : moments) {
        test::run(s.world, at.time);
        const double load = 100.0 * (g + radius * at.acceleration);
        const std::vector<double> t = tensions(s, turned);
        for (int k = 0; k <= sheaves; ++k) {
          const double expected = load * std::pow(0.95, -at.way * k);
          EXPECT_NEAR(t[static_cast<std::size_t>(k)], expected, rounding(expected, 200.0))
              << at.time << " s, span " << k;
        }
        expect_clean(s);
      }
    }
  }
}

// An elastic rope lets the load bounce while the drum winds steadily; the sheave turns one way and
// takes its share of whatever the tension is.
TEST_P(EfficiencyOfTravel, AnElasticRopeLosesTooWhileItsLoadBounces) {
  for (const bool material : {true, false}) {
    test::Machine m = winch(machine(), 1, 0.9, 0.0);
    BodyDef& drum = m.model.bodies[1];
    drum.drive_times = {0.0, 0.2, 1.0};
    drum.drive_values = {0.0, 6.0, 6.0};
    // Stretched by what it carries at rest, or it would fall slack.
    constexpr double weight = 100.0 * g;
    if (material) {
      m.cables[0].axial_stiffness = 2e5;
      m.cables[0].rest_lengths = {2.0 / (1.0 + weight / 2e5), 3.0 / (1.0 + weight / 2e5)};
    } else {
      m.cables[0].compliance = 1e-5;
      m.cables[0].rest_lengths = {2.0 - 1e-5 * weight, 3.0 - 1e-5 * weight};
    }
    Simulation s = test::start(m);
    double least = 1e9;
    double most = 0.0;
    while (s.world.state().time < 0.95) {
      ASSERT_TRUE(s.world.step().ok());
      if (s.world.state().time < 0.3) continue;
      const std::vector<double> t = tensions(s, false);
      least = std::min(least, t[0]);
      most = std::max(most, t[0]);
      EXPECT_NEAR(t[1] / t[0], 1.0 / 0.9, 1e-7) << s.world.state().time;
    }
    if (substeps() > 4) {
      EXPECT_GT(most - least, 50.0);
    }
  }
}

// Wheels with inertia: the bearing takes M = R c (T1 + T2), c = (1 - e) / (1 + e), against the
// turning. With a the acceleration of the second weight downwards and s its way,
//   (m1 + m2 + I / R^2) a = (m2 - m1) g - s c (T1 + T2),   T1 + T2 = (m1 + m2) g + (m1 - m2) a.
struct HeavySheave {
  double m1 = 2.0;
  double m2 = 2.0;
  double efficiency = 0.8;
  double speed = 0.0;
  double inertia = 0.02;

  [[nodiscard]] double share() const { return (1.0 - efficiency) / (1.0 + efficiency); }
  [[nodiscard]] bool starts() const { return std::abs(m2 - m1) > share() * (m1 + m2); }
  [[nodiscard]] double acceleration(int way) const {
    const double c = way * share();
    return ((m2 - m1) - c * (m1 + m2)) * g /
           (m1 + m2 + inertia / (radius * radius) + c * (m1 - m2));
  }
  void add(test::Machine& m, bool turned) const {
    for (const int side : {-1, 1}) {
      BodyDef weight =
          test::weight(side < 0 ? "first" : "second", {side * radius, -4, 0}, side < 0 ? m1 : m2);
      weight.velocity = {0.0, -side * speed, 0.0};
      m.model.add(weight);
    }
    BodyDef wheel = test::wheel("sheave", {0, 0, 0}, radius, inertia);
    // Clockwise, as the second weight goes down.
    wheel.angular_velocity = {0.0, 0.0, -speed / radius};
    m.cables.push_back(
        cable("rope", {attach({0}), lossy(m.model.add(wheel), right, efficiency), attach({1})}));
    if (turned) test::count_from_the_other_end(m.cables[0]);
  }
};

TEST_P(EfficiencyOfTravel, AHeavySheaveFollowsItsClosedForms) {
  const std::vector<HeavySheave> cases{{.m1 = 2.0, .m2 = 2.0, .speed = 2.0},
                                       {.m1 = 2.0, .m2 = 2.0, .speed = -2.0},
                                       {.m1 = 2.0, .m2 = 2.2},
                                       {.m1 = 2.0, .m2 = 3.0},
                                       {.m1 = 3.0, .m2 = 2.0},
                                       {.m1 = 2.0, .m2 = 1.0, .speed = 2.0},
                                       {.m1 = 2.0, .m2 = 1.0, .speed = -2.0},
                                       {.m1 = 2.0, .m2 = 2.0, .speed = 1.0, .inertia = 1e-5}};
  for (const HeavySheave& w : cases) {
    // Sweeps over a light wheel do not converge.
    if (!direct() && w.inertia < 1e-3) continue;
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(testing::Message() << w.m1 << " " << w.m2 << " " << w.speed << " " << turned);
      test::Machine m = machine();
      w.add(m, turned);
      Simulation s = test::start(m);
      constexpr double time = 0.25;
      while (s.world.state().time < time - 0.5 * s.world.model().step.dt) {
        const StepReport step = s.world.step();
        ASSERT_TRUE(step.ok());
        // No motion of this machine is prescribed.
        ASSERT_EQ(step.statistics.impossible, 0);
      }
      const int way = w.speed != 0.0 ? (w.speed > 0.0 ? 1 : -1) : w.m2 > w.m1 ? 1 : -1;
      const bool moves = w.speed != 0.0 || w.starts();
      const double a = moves ? w.acceleration(way) : 0.0;
      // Bounds of friction follow the tensions to 1e-7 of them.
      const double tolerance = rounding(1.0, 1.0) + 1e-7 * g;
      EXPECT_NEAR(-s.world.velocity({1}).y(), w.speed + a * time, tolerance);
      const std::vector<double> t = tensions(s, turned);
      EXPECT_NEAR(t[0], w.m1 * (g + a), tolerance * w.m1 * g);
      EXPECT_NEAR(t[1], w.m2 * (g - a), tolerance * w.m2 * g);
      EXPECT_TRUE(s.cables->tangent_warnings().empty());
      const LinkReport link = s.cable_reports()[0].links[1];
      const double torque = radius * (t[1] - t[0]) - w.inertia * a / radius;
      // Positive torques are counter-clockwise.
      EXPECT_NEAR(link.bearing_torque, torque, tolerance * radius * 4.0 * g);
      expect_clean(s);
      const auto reactions = Reactions::of(s);
      ASSERT_TRUE(reactions.has_value());
      const double mean = w.speed + a * (time - 0.5 * h());
      if (moves && rattle()) {
        EXPECT_NEAR(reactions->friction(), torque * mean / radius, 1e-4);
      }
    }
  }
}

TEST_P(EfficiencyOfTravel, AHeavySheaveReverses) {
  const HeavySheave w{.m1 = 2.0, .m2 = 1.0, .speed = 0.4};
  test::Machine m = machine();
  w.add(m, false);
  Simulation s = test::start(m);
  test::run(s.world, 0.5);
  const double up = w.acceleration(1);
  const double back = w.acceleration(-1);
  const double stop = -w.speed / up;
  EXPECT_NEAR(-s.world.velocity({1}).y(), back * (0.5 - stop),
              h() * std::abs(up - back) + rounding(1.0, 1.0) + 1e-6);
  expect_clean(s);
}

TEST_P(EfficiencyOfTravel, AWinchLiftsOverAHeavySheave) {
  constexpr double inertia = 2.0;
  test::Machine m = winch(machine(), 1, 0.95, inertia);
  Simulation s = test::start(m);
  const double c = 0.05 / 1.95;
  for (const Moment& at : moments) {
    test::run(s.world, at.time);
    const double load = 100.0 * (g + radius * at.acceleration);
    // T (1 - s c) = load (1 + s c) + I w' / R
    const double expected =
        (load * (1.0 + at.way * c) + inertia * at.acceleration / radius) / (1.0 - at.way * c);
    const std::vector<double> t = tensions(s, false);
    EXPECT_NEAR(t[0], load, rounding(load, 200.0) + 1e-7 * load) << at.time;
    EXPECT_NEAR(t[1], expected, rounding(expected, 200.0) + 1e-6 * load) << at.time;
    expect_clean(s);
  }
}

// The same torque acts on the carrier in the opposite sense: a frame that floats freely with two
// wheels, one of them turning, and a belt keeps its angular momentum.
TEST_P(EfficiencyOfTravel, TheBearingOfAFloatingFrameKeepsAngularMomentum) {
  for (const double inertia : {0.0, 0.02}) {
    test::Machine m = machine();
    m.model.gravity = Vector3::Zero();
    const BodyId frame = m.model.add(test::lump("frame", {0, 0, 0}, 5.0));
    BodyDef driver = test::sheave("driver", frame, {-0.5, 0, 0}, radius, 0.2, 0.02);
    driver.angular_velocity = {0, 0, 10.0};
    const BodyId first = m.model.add(driver);
    BodyDef idler = test::sheave("idler", frame, {0.5, 0, 0}, radius, 0.2, 0.02);
    idler.spin_inertia = inertia;
    idler.angular_velocity = {0, 0, 10.0};
    const BodyId second = m.model.add(idler);
    CableDef belt = cable("belt", {roll(first, left), lossy(second, left, 0.9)});
    belt.closed = true;
    belt.axial_stiffness = 1e4;
    const double half = 1.0;
    belt.rest_lengths = {half * 0.99, half * 0.99};
    m.cables.push_back(belt);
    Simulation s = test::start(m);
    const double before = momentum(s.world).angular.z();
    test::run(s.world, 0.5);
    EXPECT_NEAR(momentum(s.world).angular.z(), before, 1e-8 * std::abs(before)) << inertia;
    // The idler brakes the driver and turns the frame with what it takes.
    EXPECT_LT(s.world.angular_velocity(first).z(), 9.99) << inertia;
    EXPECT_GT(s.world.angular_velocity(frame).z(), 1e-4) << inertia;
  }
}

}  // namespace
}  // namespace sheave::lossy_sheave
