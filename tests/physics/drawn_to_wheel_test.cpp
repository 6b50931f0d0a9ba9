// An attachment that its rope draws along the tangent itself to the rim of a wheel or drum: the run
// ends where the free length is 0, whatever the law of the rope (cable/cable_arrival.cpp).
//
// The load is 2 m from the place where its rope touches the rim. A drive at v = 0.8 m/s, and a load
// that coasts at v, need 2 m / v = 2.5 s. A motor with the torque M on a drum with the inertia J needs
// sqrt(2 x 2 m / a) with a = (M / r - m g) / (m + J / r^2). The motion ends in the step in which the
// load is at the rim. `xpbd` is late or early by half a substep, which is less than a step. The stretch
// of an elastic rope, 2 m x m g / EA = 1 mm, and twice as much in the jerk at the start, shift the time
// by itself over v; 4 mm leaves room for a jerk that comes back.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "engine/body_set.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"

namespace sheave::drawn_to_wheel {
namespace {

using test::attach;
using test::g;

enum class Law { rigid, compliant, elastic, damped, table };
enum class Winch { drive, motor, coasts };

constexpr double radius = 0.2;
constexpr double mass = 50.0;
constexpr double inertia = 0.4;
constexpr double torque = 150.0;
constexpr double speed = 0.8;
constexpr double way = 2.0;
constexpr double stiffness = 1e6;

void give(CableDef& rope, Law law) {
  if (law == Law::compliant) rope.compliance = way / stiffness;
  if (law == Law::elastic || law == Law::damped) rope.axial_stiffness = stiffness;
  if (law == Law::damped) rope.damping = 1e3;
  if (law != Law::table) return;
  rope.strain_table = {0.0, 0.01};
  rope.tension_table = {0.0, 0.01 * stiffness};
}

/// The load below the drum, on a rail if it `slides`; with `knot` a body of 2 kg between the two.
test::Machine drawn(Law law, Winch winch, bool knot, bool slides) {
  test::Machine m;
  m.model.gravity = winch == Winch::coasts ? Vector3(Vector3::Zero()) : test::down;
  BodyDef drum = test::wheel("drum", Vector3::Zero(), radius, inertia);
  drum.drive = winch == Winch::motor ? DriveKind::torque : DriveKind::speed;
  drum.drive_values = {winch == Winch::motor ? torque : speed / radius};
  auto wound = test::roll(m.model.add(drum), test::right);
  wound->stored_length = 5.0;
  CableDef rope = test::cable("rope", {});
  rope.links.push_back(wound);
  double below = -way;
  const auto hang = [&](const char* name, double weight) {
    BodyDef body = slides ? test::weight(name, {radius, below, 0.0}, weight)
                          : test::lump(name, {radius, below, 0.0}, weight);
    if (winch != Winch::motor) body.velocity = {0.0, speed, 0.0};
    rope.links.push_back(attach(m.model.add(body)));
    below -= 1.0;
  };
  if (knot) hang("knot", 2.0);
  hang("load", mass);
  give(rope, law);
  m.cables.push_back(rope);
  return m;
}

/// The machine with its cable counted from the other end.
test::Machine reversed(test::Machine m) {
  auto& links = m.cables[0].links;
  auto wheel = std::make_shared<RollingLink>(dynamic_cast<const RollingLink&>(*links[0]));
  wheel->winding = test::left;
  links[0] = wheel;
  std::reverse(links.begin(), links.end());
  return m;
}

/// The machine turned in space.
test::Machine turned(test::Machine m, const Quaternion& turn) {
  m.model.gravity = turn * m.model.gravity;
  for (BodyDef& body : m.model.bodies) {
    body.position = turn * body.position;
    body.velocity = turn * body.velocity;
    if (body.axis) body.axis = turn * *body.axis;
    body.orientation = turn * body.orientation;
  }
  return m;
}

double expected_time(Winch winch, double pulled) {
  if (winch != Winch::motor) return way / speed;
  const double a = (torque / radius - pulled * g) / (pulled + inertia / (radius * radius));
  return std::sqrt(2.0 * way / a);
}

void expect_end(const test::Machine& m, double time, bool knot) {
  Simulation s = test::start(m);
  std::optional<Divergence> end;
  while (!end && s.world.state().time < 4.0) end = s.world.step().divergence;
  ASSERT_TRUE(end) << s.world.position({1}).transpose();
  for (const char* name : {"rope", knot ? "\"knot\"" : "\"load\"", "\"drum\"", "has reached"}) {
    EXPECT_NE(end->message.find(name), std::string::npos) << end->message;
  }
  EXPECT_NEAR(end->time, time, m.model.step.dt + 4e-3 / speed);
  EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
}

class DrawnToWheel : public testing::TestWithParam<Law> {};

TEST_P(DrawnToWheel, EndsTheRunWhereTheFreeLengthIsZero) {
  const Quaternion turn(Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, -0.5).normalized()));
  int number = 0;
  for (const Winch winch : {Winch::drive, Winch::motor, Winch::coasts}) {
    for (const bool knot : {false, true}) {
      for (const auto& c : test::combinations) {
        for (const int substeps : {1, 4, 32}) {
          SCOPED_TRACE(testing::Message()
                       << static_cast<int>(winch) << (knot ? " knot " : " ")
                       << static_cast<int>(c.solver) << static_cast<int>(c.integrator) << ' '
                       << substeps << " number " << number);
          // A weight on a rail at a driven drum with a rigid rope stalls the drive.
          const bool stalls = GetParam() == Law::rigid && winch != Winch::motor && !knot;
          test::Machine m = drawn(GetParam(), winch, knot, !stalls && number % 2 == 0);
          if (number % 3 == 0) m = reversed(m);
          if (number % 5 < 2) m = turned(m, turn);
          m.model.step = test::settings(1.0 / 60.0, substeps, 50);
          m.model.step.solver = c.solver;
          m.model.step.integrator = c.integrator;
          expect_end(m, expected_time(winch, mass + (knot ? 2.0 : 0.0)), knot);
          ++number;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, DrawnToWheel,
                         testing::Values(Law::rigid, Law::compliant, Law::elastic, Law::damped,
                                         Law::table));

// The wheel comes to the attachment: a drum draws a block, at half of its own speed, up to the place
// where the rope ends.
TEST(DrawnToWheel, EndsTheRunOfABlockThatComesToTheEndOfItsRope) {
  for (const int substeps : {1, 4, 32}) {
    test::Machine m;
    m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, substeps);
    m.model.gravity = test::down;
    const BodyId block = m.model.add(test::weight("block", {0.0, -1.0, 0.0}, 3.0));
    m.model.bodies[0].velocity = {0.0, 0.5 * speed, 0.0};
    const BodyId sheave =
        m.model.add(test::sheave("sheave", block, {0.0, -1.0, 0.0}, radius, 1.0, 0.02));
    BodyDef drum = test::wheel("drum", {2.0 * radius, 1.0, 0.0}, radius, inertia);
    drum.drive = DriveKind::speed;
    drum.drive_values = {-speed / radius};
    auto wound = test::roll(m.model.add(drum), test::right);
    wound->stored_length = 3.0;
    m.cables.push_back(test::cable("rope", {attach(BodyId::world(), {-radius, 0.0, 0.0}),
                                            test::roll(sheave, test::left), wound}));
    m.cables[0].axial_stiffness = stiffness;
    Simulation s = test::start(m);
    std::optional<Divergence> end;
    while (!end && s.world.state().time < 4.0) end = s.world.step().divergence;
    ASSERT_TRUE(end);
    EXPECT_NE(end->message.find("has reached the wheel"), std::string::npos) << end->message;
    EXPECT_NE(end->message.find("\"sheave\""), std::string::npos) << end->message;
    EXPECT_NEAR(end->time, 1.0 / (0.5 * speed), 1.0 / 60.0 + 4e-3 / speed);
  }
}

// A slack rope pulls nothing to the rim: the weight flies past it and comes back, as a free one.
TEST(DrawnToWheel, DoesNotEndTheRunOfASlackRope) {
  test::Machine m = drawn(Law::elastic, Winch::drive, false, true);
  m.model.bodies[0].drive_values = {0.0};
  m.model.bodies[1].velocity = {0.0, 8.0, 0.0};
  m.cables[0].rest_lengths = {6.0};
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  Simulation s = test::start(m);
  test::run(s.world, 1.0);
  EXPECT_NEAR(s.world.position({1}).y(), -way + 8.0 - 0.5 * g, 1e-9);
}

// An attachment that begins at the rim moves off.
TEST(DrawnToWheel, DoesNotEndTheRunOfALoadThatBeginsAtTheRim) {
  test::Machine m = drawn(Law::rigid, Winch::drive, false, true);
  m.model.bodies[0].drive_values = {-speed / radius};
  m.model.bodies[1].position = Vector3(radius, 0.0, 0.0);
  m.model.bodies[1].velocity = {0.0, -speed, 0.0};
  m.model.step = test::direct_settings(IntegratorKind::rattle, 1.0 / 60.0, 4);
  Simulation s = test::start(m);
  test::run(s.world, 1.0);
  EXPECT_NEAR(s.world.position({1}).y(), -speed, 1e-6);
}

}  // namespace
}  // namespace sheave::drawn_to_wheel
