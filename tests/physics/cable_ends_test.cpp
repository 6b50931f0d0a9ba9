// Cable ends that change: hybrid links, drums with layers, feeding attachments, driven winches.

#include <cmath>

#include <gtest/gtest.h>

#include "cable/links/hybrid.h"
#include "cable/links/spool.h"
#include "tests/support/builders.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;

std::shared_ptr<HybridLink> hybrid(BodyId body, Winding winding, double stored) {
  auto link = std::make_shared<HybridLink>();
  link->body = body;
  link->winding = winding;
  link->stored_length = stored;
  return link;
}

std::shared_ptr<SpoolLink> drum(BodyId body, Winding winding, double stored, double pitch) {
  auto link = std::make_shared<SpoolLink>();
  link->body = body;
  link->winding = winding;
  link->stored_length = stored;
  link->layer_pitch = pitch;
  return link;
}

BodyDef ball(std::string name, const Vector3& position) {
  BodyDef body = test::lump(std::move(name), position, 1.0);
  body.mobility = Mobility::planar;
  return body;
}

TEST(Hybrid, AWeightFallsAsFarAsTheStoredLengthAllows) {
  for (const bool ends_first : {true, false}) {
    for (const double stored : {0.0, 0.5, 1.5}) {
      test::Machine m;
      m.model.gravity = test::down;
      m.model.step = test::settings(0.005, 1, 20);
      const double r = 0.2;
      const BodyId wheel = m.model.add(test::wheel("wheel", Vector3::Zero(), r, 0.02));
      const BodyId weight = m.model.add(ball("weight", {r, -0.5, 0.0}));
      // On the right side a cable that runs up and over the wheel goes counter-clockwise; from the
      // wheel down, clockwise.
      m.cables.push_back(ends_first ? cable("rope", {hybrid(wheel, right, stored), attach(weight)})
                                    : cable("rope", {attach(weight), hybrid(wheel, left, stored)}));
      Simulation s = test::start(m);
      double lowest = 0.0;
      double energy = s.world.energy().total();
      const double scale = g * (stored + 1.0);
      for (int i = 0; i < 1600; ++i) {
        ASSERT_TRUE(s.world.step().ok());
        lowest = std::min(lowest, s.world.position(weight).y());
        const double now = s.world.energy().total();
        // A substep under the force T does at most T h v of work wrongly; what rounds at a
        // transition is far less.
        EXPECT_LE(now, energy + 1e-9 * scale) << "step " << i << " stored " << stored;
        energy = now;
      }
      const CableReport report = s.cable_reports()[0];
      EXPECT_EQ(report.length_error, 0.0);
      // Hanging from the rim's lowest point: r + all of the cable below the axle.
      EXPECT_GE(lowest, -(r + 0.5 + stored) - 1e-6);
      EXPECT_LT(lowest, -(r + 0.5 + stored) + 0.1);
      EXPECT_EQ(report.links[ends_first ? 0 : 1].winding, 0) << "used up: an attachment";
    }
  }
}

TEST(Hybrid, APendulumOnAFixedDiscIsWoundAndAttachedInTurn) {
  // It hangs on the right of the disc. Swinging to the left it is wound onto the disc's lower
  // right, swinging to the right the few centimetres that are stored are used up.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.002, 1, 20);
  BodyDef disc = test::wheel("disc", Vector3::Zero(), 0.2, 0.02);
  disc.mobility = Mobility::fixed;
  disc.axis.reset();
  const BodyId post = m.model.add(disc);
  const BodyId weight = m.model.add(ball("weight", {-0.2, -1.0, 0.0}));
  m.cables.push_back(cable("rope", {hybrid(post, right, 0.15), attach(weight)}));
  Simulation s = test::start(m);
  bool seen_wound = false;
  bool seen_attached = false;
  double energy = s.world.energy().total();
  double rise = 0.0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    const CableReport report = s.cable_reports()[0];
    ASSERT_EQ(report.length_error, 0.0);
    ASSERT_GE(report.links[0].stored_length, -1e-15);
    seen_wound = seen_wound || report.links[0].winding < 0;
    seen_attached = seen_attached || report.links[0].winding == 0;
    const double now = s.world.energy().total();
    rise = std::max(rise, now - energy);
    energy = now;
  }
  EXPECT_TRUE(seen_wound);
  EXPECT_TRUE(seen_attached);
  EXPECT_LT(rise, 1e-6 * g);
}

TEST(Drum, LayersHoldTheIntegralOfTheGrowingRadius) {
  // Driven at 2 turns per second; the load hangs far below, so that the direction of the cable
  // hardly changes.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.01, 1, 10);
  const double r0 = 0.1;
  const double pitch = 0.02;
  BodyDef winch = test::wheel("drum", Vector3::Zero(), r0, 0.02);
  winch.drive = DriveKind::speed;
  winch.drive_values = {4.0 * pi};
  const BodyId body = m.model.add(winch);
  const BodyId load = m.model.add(test::weight("load", {r0, -1000.0, 0.0}, 1.0));
  m.cables.push_back(cable("rope", {attach(load), drum(body, left, 0.0, pitch)}));
  Simulation s = test::start(m);
  const auto direction = [&] {
    const SpanReport span = s.cable_reports()[0].spans[0];
    return std::atan2(span.end.y() - span.start.y(), span.end.x() - span.start.x());
  };
  const double start = direction();
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  const double angle = s.world.state().bodies[0].angle - (direction() - start);
  EXPECT_NEAR(s.world.state().bodies[0].angle, 20.0 * pi, 1e-9);
  // Exact in the angle; lengths of 1000 m are rounded to 1e-13 m in each of 500 substeps.
  EXPECT_NEAR(report.links[1].stored_length, r0 * angle + pitch * angle * angle / (4.0 * pi), 1e-9);
  EXPECT_NEAR(report.links[1].radius, r0 + pitch * angle / (2.0 * pi), 1e-10);
  EXPECT_NEAR(report.links[1].wrap_angle, angle, 1e-8);
  EXPECT_EQ(report.length_error, 0.0);
  EXPECT_NEAR(s.world.position(load).y(), -1000.0 + report.links[1].stored_length, 1e-3);
}

// A load winds itself off a drum in layers, on a rigid rope 2 m to the side, so that its direction
// turns as the radius changes. Nothing is lost: J w^2 / 2 + m v^2 / 2 + m g y stays, to the second
// order of the step with `rattle`.
TEST(Drum, LayersKeepEnergyToSecondOrder) {
  const auto error = [](double h, double pitch) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(h, 1, 20);
    m.model.step.solver = SolverKind::direct;
    m.model.step.integrator = IntegratorKind::rattle;
    const BodyId body = m.model.add(test::wheel("drum", Vector3::Zero(), 0.1, 0.5));
    const BodyId load = m.model.add(test::weight("load", {2.0, -1.0, 0.0}, 5.0));
    m.cables.push_back(cable("rope", {attach(load), drum(body, left, 6.0, pitch)}));
    Simulation s = test::start(m);
    const double start = s.world.energy().total();
    double worst = 0.0;
    while (s.world.state().time < 1.0 - 0.5 * h) {
      EXPECT_TRUE(s.world.step().ok());
      worst = std::max(worst, std::abs(s.world.energy().total() - start));
    }
    const LinkReport link = s.cable_reports()[0].links[1];
    EXPECT_GT(std::abs(link.stored_length - 6.0), 0.5);
    EXPECT_EQ(s.cable_reports()[0].length_error, 0.0);
    return worst;
  };
  for (const double pitch : {0.02, 0.1}) {
    const double coarse = error(8e-3, pitch);
    const double fine = error(4e-3, pitch);
    const double finest = error(2e-3, pitch);
    EXPECT_GT(std::log2(coarse / fine), 1.9) << pitch;
    EXPECT_GT(std::log2(fine / finest), 1.9) << pitch;
    EXPECT_LT(finest, 1e-5 * 5.0 * g) << pitch;
  }
}

TEST(Drum, TheLastTurnIsFixedToTheDrum) {
  // Unwound completely and further, the cable is wound up the other way.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = test::settings(0.002, 1, 10);
  BodyDef winch = test::wheel("drum", Vector3::Zero(), 0.1, 0.02);
  winch.drive = DriveKind::speed;
  winch.drive_values = {-2.0 * pi};
  const BodyId body = m.model.add(winch);
  const BodyId load = m.model.add(ball("load", {0.1, -5.0, 0.0}));
  m.cables.push_back(cable("rope", {attach(load), drum(body, left, 0.5, 0.0)}));
  Simulation s = test::start(m);
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(s.world.step().ok());
  const CableReport report = s.cable_reports()[0];
  EXPECT_EQ(report.links[1].winding, -1);
  // Four turns less the 0.5 m that were unwound and the half turn in which the attachment passes
  // below from the right side to the left. The load swings a little: the cable's direction differs
  // by less than 0.05 rad from the plumb line.
  EXPECT_NEAR(report.links[1].stored_length, 4.0 * 2.0 * pi * 0.1 - 0.5 - pi * 0.1, 0.05 * 0.1);
  EXPECT_EQ(report.length_error, 0.0);
}

TEST(Feed, PaysOutAndTakesInAtItsSpeed) {
  for (const double speed : {0.3, -0.3}) {
    test::Machine m = test::cable_pendulum(1.0, 1.0, 0.0);
    m.model.step = test::settings(0.01, 1, 10);
    auto end = attach(BodyId::world());
    end->feed_speed = speed;
    for (auto& link : m.cables[0].links) {
      if (link->body.is_world()) link = end;
    }
    Simulation s = test::start(m);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(s.world.step().ok());
    EXPECT_NEAR(s.world.position({0}).y(), -1.0 - speed, 1e-9);
    const CableReport report = s.cable_reports()[0];
    EXPECT_NEAR(report.links[0].fed + report.links[1].fed, speed, 1e-14);
    EXPECT_LT(std::abs(report.length_error), 1e-15);
    // Taken in for longer than there is cable: it stops at the point.
    for (int i = 0; i < 400; ++i) ASSERT_TRUE(s.world.step().ok());
    EXPECT_GE(s.cable_reports()[0].spans[0].rest_length, 0.0);
    EXPECT_LT(std::abs(s.cable_reports()[0].length_error), 1e-14);
  }
}

TEST(Winch, FollowsTablesOfSpeedAngleAndTorque) {
  const double r = 0.25;
  for (const DriveKind kind : {DriveKind::speed, DriveKind::angle, DriveKind::torque}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = test::settings(0.01, 1, 10);
    BodyDef winch = test::wheel("drum", Vector3::Zero(), r, 0.05);
    winch.drive = kind;
    winch.drive_times = {0.0, 1.0, 2.0};
    if (kind == DriveKind::speed) winch.drive_values = {0.0, 4.0, 4.0};
    if (kind == DriveKind::angle) winch.drive_values = {1.0, 3.0, 7.0};
    // Holds 2 kg for a second, then twice as much.
    const double hold = 2.0 * g * r;
    if (kind == DriveKind::torque) {
      winch.drive_times = {1.0, 1.0 + 1e-9};
      winch.drive_values = {hold, 2.0 * hold};
    }
    const BodyId body = m.model.add(winch);
    const BodyId load = m.model.add(test::weight("load", {r, -9.0, 0.0}, 2.0));
    m.cables.push_back(cable("rope", {attach(load), drum(body, left, 0.0, 0.0)}));
    Simulation s = test::start(m);
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(s.world.step().ok());
    const double risen = s.world.position(load).y() + 9.0;
    if (kind != DriveKind::torque) {
      EXPECT_NEAR(risen, r * 6.0, 1e-9);
    } else {
      const double a = hold / r / (2.0 + 0.05 / (r * r));
      EXPECT_NEAR(s.world.velocity(load).y(), a, 1e-6 * a);
    }
  }
}

}  // namespace
}  // namespace sheave
