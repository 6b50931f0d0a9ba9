// Elastic rope that slides over a link which turns. Friction acts along the travel of the rope over
// the rim, so travel, slip and the side with the larger tension are all relative to the rim.
//
// Two equal weights m hang on a rope over a driven pulley, with q = e^(mu pi). The rim runs away
// under the rope, so one tension is q times the other. The sum of both stays close to 2 m g, so
//
//   a = g (q - 1) / (q + 1),   T1 = 2 m g / (q + 1),   slip = w R t - a t^2 / 2,
//
// and friction takes (T2 - T1) times the slip speed.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cable/certificate.h"
#include "cable/reactions.h"
#include "cable/run_check.h"
#include "engine/math/turn_between.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/friction_links.h"

namespace sheave::turning_link {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;
using test::wrapped;

constexpr double radius = 0.5;
constexpr double friction = 0.05;
constexpr double hang = 3.0;  // free length of each side [m]
const double ratio = std::exp(friction * pi);
const double acceleration = g * (ratio - 1.0) / (ratio + 1.0);

struct Hoist {
  double mass = 100.0;
  double stiffness = 1e5;  // EA [N]
  double speed = 4.0;      // of the pulley [rad/s], its start if it is a flywheel
  double inertia = 0.0;    // of a flywheel [kg m2]; 0: a drive turns the pulley
  bool from_behind = false;
  Quaternion turned = Quaternion::Identity();  // of the whole machine
};

/// Bodies: 0 pulley, 1 weight on the left, 2 weight on the right. The rope hangs with the strain
/// that both weights give it at rest.
test::Machine machine(const Hoist& hoist, const StepSettings& step) {
  test::Machine m;
  m.model.step = step;
  m.model.gravity = hoist.turned * test::down;
  BodyDef pulley = test::wheel("pulley", {0, 0, 0}, radius, std::max(hoist.inertia, 1.0));
  pulley.orientation = hoist.turned;
  if (hoist.inertia > 0.0) {
    pulley.angular_velocity = hoist.turned * Vector3(0, 0, hoist.speed);
    pulley.axis = hoist.turned * Vector3::UnitZ();
  } else {
    pulley.axis = hoist.turned * Vector3::UnitZ();
    pulley.drive = DriveKind::speed;
    pulley.drive_values = {hoist.speed};
  }
  m.model.add(pulley);
  for (const double side : {-1.0, 1.0}) {
    BodyDef load = test::weight(side < 0.0 ? "left" : "right",
                                hoist.turned * Vector3(side * radius, -hang, 0), hoist.mass);
    load.axis = hoist.turned * Vector3::UnitY();
    m.model.add(load);
  }
  m.cables.push_back(
      hoist.from_behind ? cable("rope", {attach({2}), wrapped({0}, left, friction), attach({1})})
                        : cable("rope", {attach({1}), wrapped({0}, right, friction), attach({2})}));
  m.cables[0].axial_stiffness = hoist.stiffness;
  const double rest = hang / (1.0 + hoist.mass * g / hoist.stiffness);
  m.cables[0].rest_lengths = {rest, rest};
  return m;
}

/// Tensions on the left and on the right [N].
std::vector<double> pulls(const Simulation& s, const Hoist& hoist) {
  std::vector<double> all = test::tensions(s.cable_reports()[0]);
  if (hoist.from_behind) std::reverse(all.begin(), all.end());
  return all;
}

void expect_clean(const Simulation& s) {
  const auto certificate = s.certificate();
  ASSERT_TRUE(certificate);
  EXPECT_TRUE(certificate->clean(1e-4)) << certificate->worst()->sentence();
}

class TurningLink : public test::ForEveryCombination {};
INSTANTIATE_TEST_SUITE_P(All, TurningLink, testing::ValuesIn(test::combinations),
                         test::combination_name);

/// Half a second over a driven pulley, against the closed form.
void expect_driven(const Hoist& hoist, const StepSettings& step) {
  SCOPED_TRACE(testing::Message() << "EA " << hoist.stiffness << ", " << hoist.speed << " rad/s, "
                                  << step.dt << " s" << (hoist.from_behind ? ", behind" : ""));
  const double duration = 0.5;
  Simulation s = test::start(machine(hoist, step));
  const double way = hoist.speed > 0.0 ? 1.0 : -1.0;
  const auto steps = static_cast<int>(std::lround(duration / step.dt));
  double taken = 0.0;
  double work = 0.0;
  double energy = 0.0;
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    expect_clean(s);
    const std::vector<double> pull = pulls(s, hoist);
    const double low = way > 0.0 ? pull[0] : pull[1];
    const double high = way > 0.0 ? pull[1] : pull[0];
    // Positive speeds draw the rope from the right to the left, and the rim's pull on the rope is
    // the difference of the tensions.
    EXPECT_LE(low, high * (1.0 + 1e-9));
    EXPECT_LE(high, low * ratio * (1.0 + 1e-6) + 1e-6) << "step " << i;
    const auto reactions = Reactions::of(s);
    ASSERT_TRUE(reactions);
    const double power = reactions->link_friction(0, 1);
    EXPECT_GE(power, -1e-9 * hoist.mass * g) << "step " << i;
    if (i == 0) {
      // The jump of the speed costs the pulley's own energy; the balance begins behind it.
      energy = s.world.energy().total();
      continue;
    }
    taken += power * step.dt;
    work += reactions->drive_power() * step.dt;
  }
  const double drawn = acceleration * duration * duration / 2.0;
  // T2 - T1 changes the strains, which moves (T2 - T1) L / EA of rope; and the sum of the tensions
  // swings about 2 m g by the square of mu pi over 12, the difference of two means, 0.2 %.
  const double moved = hoist.mass * g * (ratio - 1.0) * hang / hoist.stiffness;
  const Vector3 up = hoist.turned * Vector3::UnitY();
  const double speed = up.dot(s.world.state().bodies[1].velocity);
  EXPECT_NEAR(-way * speed, acceleration * duration, 0.01 * acceleration * duration + 2.0 * moved);
  const double slip = s.cable_reports()[0].links[1].slip * (hoist.from_behind ? -1.0 : 1.0);
  const double rim = std::abs(hoist.speed) * radius * duration;
  // Slip is unstretched length.
  const double stretched = slip * way * (1.0 + hoist.mass * g / hoist.stiffness);
  EXPECT_NEAR(stretched, rim - drawn, 0.01 * drawn + 2.0 * moved);
  // The drive's work goes into the weights, the springs and friction.
  EXPECT_NEAR(work, s.world.energy().total() - energy + taken, 0.02 * taken);
}

TEST_P(TurningLink, ADrivenPulleySlipsByTheTravelOfItsRim) {
  for (const double stiffness : {1e5, 1e7}) {
    for (const double speed : {4.0, -4.0}) {
      for (const bool from_behind : {false, true}) {
        Hoist hoist;
        hoist.stiffness = stiffness;
        hoist.speed = speed;
        hoist.from_behind = from_behind;
        expect_driven(hoist, step_settings(1.0 / 240.0, 200));
      }
    }
  }
}

TEST_P(TurningLink, AnyNumberOfSubstepsGivesTheSame) {
  for (const double h : {1.0 / 60.0, 1.0 / 1000.0}) expect_driven({}, step_settings(h, 200));
}

TEST_P(TurningLink, AMachineTurnedInSpaceDoesTheSame) {
  Hoist hoist;
  hoist.turned = turn_between(Vector3(0, 0, 1), Vector3(1, -2, 2));
  expect_driven(hoist, step_settings(1.0 / 240.0, 200));
}

TEST_P(TurningLink, AStiffRopeKeepsToTheConeFromTheFirstSubstepOn) {
  // The jump of the drive would stretch a rope that held by 2 m/s h, to T = 1e5 m g. Within the
  // cone nothing swings, so v = -a t; the springs of 0.03 mm move the weights by less than that.
  Hoist hoist;
  hoist.mass = 1000.0;
  hoist.stiffness = 1e9;
  for (const double h : {1.0 / 60.0, 1.0 / 240.0, 1.0 / 3840.0}) {
    SCOPED_TRACE(h);
    Simulation s = test::start(machine(hoist, step_settings(h, 200)));
    const auto steps = static_cast<int>(std::lround(0.1 / h));
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      expect_clean(s);
      const std::vector<double> pull = pulls(s, hoist);
      EXPECT_NEAR(pull[1], ratio * pull[0], 1e-6 * pull[1]) << "step " << i;
      EXPECT_NEAR(pull[0] + pull[1], 2.0 * hoist.mass * g, 0.01 * hoist.mass * g) << "step " << i;
    }
    const double t = s.world.state().time;
    EXPECT_NEAR(s.world.state().bodies[1].velocity.y(), -acceleration * t, 0.01 * acceleration * t);
  }
}

TEST_P(TurningLink, ADriveThatReversesPullsTheWeightsBack) {
  // The rim runs at w R for t1, then the other way round for t1. The weights speed up by a t1 and
  // come to rest again, and the slip is (w R t1 - a t1^2 / 2) - (w R t1 + a t1^2 / 2) = -a t1^2.
  constexpr double half = 0.25;
  for (const double h : {1.0 / 240.0, 1.0 / 3840.0}) {
    if (h < 1e-3 && !GetParam().rattle()) continue;  // sweeps of springs take long
    SCOPED_TRACE(h);
    Hoist hoist;
    hoist.stiffness = 1e7;
    test::Machine m = machine(hoist, step_settings(h, 200));
    m.model.bodies[0].drive_times = {0.0, half, half + 1e-6, 1.0};
    m.model.bodies[0].drive_values = {4.0, 4.0, -4.0, -4.0};
    Simulation s = test::start(m);
    const auto steps = static_cast<int>(std::lround(2.0 * half / h));
    double fastest = 0.0;
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      expect_clean(s);
      EXPECT_GE(Reactions::of(s)->link_friction(0, 1), -1e-9 * hoist.mass * g) << "step " << i;
      fastest = std::max(fastest, std::abs(s.world.state().bodies[1].velocity.y()));
    }
    // The tension changes sides twice, which moves (T2 - T1) L / EA of rope.
    const double moved = hoist.mass * g * (ratio - 1.0) * hang / hoist.stiffness;
    const double reached = acceleration * half;
    EXPECT_NEAR(fastest, reached, 0.01 * reached + 4.0 * moved + acceleration * h);
    EXPECT_NEAR(s.world.state().bodies[1].velocity.y(), 0.0,
                0.02 * reached + 4.0 * moved + acceleration * h);
    const double slip =
        s.cable_reports()[0].links[1].slip * (1.0 + hoist.mass * g / hoist.stiffness);
    EXPECT_NEAR(slip, -acceleration * half * half,
                0.02 * acceleration * half * half + 4.0 * moved + 4.0 * radius * 1e-6);
  }
}

TEST_P(TurningLink, AFlywheelSlipsUntilItsRimHasTheSpeedOfTheRope) {
  // I w' = -R (T2 - T1) until R w is the rope's speed: with b = a + R^2 (T2 - T1) / I the slip ends
  // at t = R w0 / b and is (R w0)^2 / 2 b. Then all go on together at a t, without the energy that
  // friction has taken.
  for (const double speed : {4.0, -4.0}) {
    for (const double h : {1.0 / 240.0, 1.0 / 960.0}) {
      if (h < 1e-3 * 1.1 && !GetParam().rattle()) continue;  // sweeps of springs take long
      SCOPED_TRACE(testing::Message() << speed << " rad/s, " << h << " s");
      Hoist hoist;
      hoist.stiffness = 1e6;
      hoist.speed = speed;
      hoist.inertia = 40.0;
      Simulation s = test::start(machine(hoist, step_settings(h, 200)));
      const double pull = 2.0 * hoist.mass * acceleration;
      const double braking = acceleration + radius * radius * pull / hoist.inertia;
      const double rim = std::abs(speed) * radius;
      const double end = rim / braking;
      const double energy = s.world.energy().total();
      double taken = 0.0;
      double integrator = 0.0;
      while (s.world.state().time < 1.25 * end) {
        const StepReport step = s.step();
        ASSERT_TRUE(step.ok());
        integrator += step.statistics.numerical_damping;
        expect_clean(s);
        const double power = Reactions::of(s)->link_friction(0, 1);
        // Where the link comes to hold, `rattle` lets it slide by the mean strains of the substep,
        // and the signs of slip and mean tension may differ there (docs/explanation/friction.md).
        EXPECT_GE(power, GetParam().rattle() ? -1e-3 * pull * rim : -1e-9 * hoist.mass * g);
        taken += power * h;
      }
      const double moved = hoist.mass * g * (ratio - 1.0) * hang / hoist.stiffness;
      const double slip = s.cable_reports()[0].links[1].slip;
      EXPECT_NEAR(slip * (speed > 0.0 ? 1.0 : -1.0), rim * rim / (2.0 * braking),
                  0.005 * rim * rim / braking + 4.0 * moved);
      const double spin = s.world.state().bodies[0].angular_velocity.z();
      const double lost = pull * rim * rim / (2.0 * braking);
      EXPECT_NEAR(taken, lost, 0.02 * lost);
      EXPECT_NEAR(std::abs(spin) * radius, acceleration * end, 0.03 * acceleration * end);
      if (GetParam().rattle()) {
        EXPECT_NEAR(s.world.energy().total() + taken, energy, 0.01 * lost);
      }
    }
  }
}

TEST_P(TurningLink, ABeltThatHoldsCreeps) {
  // Weights of 100 and 110 kg (1.1 < q) on a pulley at constant speed: the rope comes on at the
  // speed of the rim with the strain of its side, and goes off with that of the other, so the
  // speeds have the ratio (1 + e_off) / (1 + e_on): 1 + (T1 - T2) / EA, the creep of belts.
  for (const double speed : {1.0, -1.0}) {
    SCOPED_TRACE(speed);
    Hoist hoist;
    hoist.speed = speed;
    test::Machine m = machine(hoist, step_settings(1.0 / 240.0, 200));
    m.model.bodies[2].mass = 110.0;
    m.cables[0].rest_lengths[1] = hang / (1.0 + 110.0 * g / hoist.stiffness);
    m.cables[0].damping = 1500.0;
    m.model.bodies[1].velocity = {0, -speed * radius, 0};
    m.model.bodies[2].velocity = {0, speed * radius, 0};
    Simulation s = test::start(m);
    // The rope that lay on the arc of 1.57 m at first has come off after 3.2 s; then vibrations die
    // out.
    for (int i = 0; i < 1080; ++i) ASSERT_TRUE(s.world.step().ok());
    const std::vector<double> pull = pulls(s, hoist);
    const auto rate = [&](std::size_t i) {
      return std::abs(s.world.state().bodies[i].velocity.y());
    };
    const std::size_t on = speed > 0.0 ? 1 : 0;
    EXPECT_NEAR(rate(on + 1), std::abs(speed) * radius, 1e-5 * radius);
    const double creep = (pull[1 - on] - pull[on]) / hoist.stiffness;
    EXPECT_GT(std::abs(creep), 5e-4);
    // The damper does not resist the strain that passes with the rope.
    const double stretched = 1.0 + pull[on] / hoist.stiffness;
    EXPECT_NEAR(rate(2 - on) / rate(on + 1), 1.0 + creep / stretched, 1e-3 * std::abs(creep));
    EXPECT_EQ(s.cable_reports()[0].links[1].slip, 0.0);
    expect_clean(s);
  }
}

TEST_P(TurningLink, TwoPulleysInARowEachSlipAgainstTheirOwnRim) {
  // Both pulleys are driven, the second against the first: the rope slides forwards over the first
  // and backwards over the second, with a quarter turn each. The ratios cancel, so nothing pulls
  // the weights, which rest, and each pulley slips by the way of its rim.
  for (const double stiffness : {1e5, 1e8}) {
    test::Machine m;
    m.model.step = step_settings(1.0 / 240.0, 200);
    m.model.gravity = test::down;
    for (const double side : {-1.0, 1.0}) {
      BodyDef pulley = test::wheel(side < 0.0 ? "a" : "b", {side, 0, 0}, radius, 1.0);
      pulley.drive = DriveKind::speed;
      pulley.drive_values = {-side * 4.0};
      m.model.add(pulley);
    }
    m.model.add(test::weight("left", {-1.0 - radius, -hang, 0}, 100.0));
    m.model.add(test::weight("right", {1.0 + radius, -hang, 0}, 100.0));
    m.cables.push_back(cable("rope", {attach({2}), wrapped({0}, right, friction),
                                      wrapped({1}, right, friction), attach({3})}));
    m.cables[0].axial_stiffness = stiffness;
    const double strain = 100.0 * g / stiffness;
    const double between = strain * std::exp(0.5 * friction * pi);
    m.cables[0].rest_lengths = {hang / (1.0 + strain), 2.0 / (1.0 + between),
                                hang / (1.0 + strain)};
    Simulation s = test::start(m);
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(s.world.step().ok());
      expect_clean(s);
      const std::vector<double> pull = test::tensions(s.cable_reports()[0]);
      EXPECT_NEAR(pull[1], pull[0] * std::exp(0.5 * friction * pi), 1e-6 * pull[1]);
      EXPECT_NEAR(pull[2], pull[0], 1e-6 * pull[1]);
      const auto reactions = Reactions::of(s);
      for (const int link : {1, 2}) EXPECT_GT(reactions->link_friction(0, link), 0.0);
    }
    const CableReport report = s.cable_reports()[0];
    // The strain of the arcs settles once, by the difference of the tensions over 1.6 m.
    const double settles = 100.0 * g * friction * pi * 1.6 / stiffness;
    EXPECT_NEAR(report.links[1].slip, 4.0 * radius * 0.25, 1e-2 * 0.5 + settles);
    EXPECT_NEAR(report.links[2].slip, -4.0 * radius * 0.25, 1e-2 * 0.5 + settles);
  }
}

TEST(TurningLinkChecked, TheFirstSubstepOfARunIsChecked) {
  // The last substep of each step obeys all laws if the first has thrown the weights apart, so the
  // first is looked at, too; and again where a drive jumps later on.
  Hoist hoist;
  hoist.speed = 0.0;
  test::Machine m = machine(hoist, test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4));
  m.model.bodies[0].drive_times = {0.0, 0.5, 0.5 + 1e-6, 1.0};
  m.model.bodies[0].drive_values = {0.0, 0.0, 4.0, 4.0};
  Simulation s = test::start(m);
  RunCheck check(s, 1e-9);
  for (int i = 0; i < 45; ++i) {
    const StepReport report = s.step({}, check.within(s), {});
    ASSERT_TRUE(report.ok());
    check.observe(s, report.statistics, false);
    // The first step: its first and last substep. The step of the jump: its first three.
    EXPECT_GE(check.certificate().substeps, i < 30 ? 2 : 5) << i;
  }
  EXPECT_LE(check.certificate().substeps, 6);
  EXPECT_TRUE(check.certificate().clean()) << check.certificate().worst()->sentence();
}

}  // namespace
}  // namespace sheave::turning_link
