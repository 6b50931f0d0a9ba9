// Drives that want more cable than there is (cable/cable_drives.cpp), and ends of cables that have
// run out.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cable/cable_system.h"
#include "cable/links/pinhole.h"
#include "cable/links/spool.h"
#include "engine/body_set.h"
#include "tests/support/builders.h"
#include "tests/support/combinations.h"
#include "tests/support/shapes.h"

namespace sheave {
namespace {

using test::attach;
using test::cable;
using test::g;
using test::left;
using test::right;

class CableLimits : public test::ForEveryCombination {};

BodyDef driven_wheel(std::string name, const Vector3& center, double radius, double speed) {
  BodyDef body = test::wheel(std::move(name), center, radius, 0.02);
  body.drive = DriveKind::speed;
  body.drive_values = {speed};
  return body;
}

std::shared_ptr<SpoolLink> drum(BodyId body, Winding winding, double stored) {
  auto link = std::make_shared<SpoolLink>();
  link->body = body;
  link->winding = winding;
  link->stored_length = stored;
  return link;
}

/// Steps to `time`; no length may fall below 0 and none may be lost.
void run_and_check(Simulation& s, double time) {
  const double h = s.world.model().step.dt;
  while (s.world.state().time < time - 0.5 * h) {
    const StepReport step = s.world.step();
    ASSERT_TRUE(step.ok()) << step.divergence->message;
    for (const CableReport& report : s.cable_reports()) {
      ASSERT_EQ(report.length_error, 0.0);
      for (const SpanReport& span : report.spans) ASSERT_GE(span.rest_length, 0.0);
      for (const LinkReport& link : report.links) ASSERT_GE(link.stored_length, 0.0);
    }
  }
}

std::vector<const CableEvent*> events_of(const Simulation& s, CableEvent::Kind kind) {
  std::vector<const CableEvent*> events;
  for (const CableEvent& event : s.cables->events()) {
    if (event.kind == kind) events.push_back(&event);
  }
  return events;
}

/// A belt over two driven wheels.
test::Machine driven_belt(const StepSettings& step, double r1, double r2, double speed1,
                          double speed2) {
  test::Machine m = test::belt(r1, r2, 1.0, 0.02, 0.02);
  m.model.step = step;
  for (const auto& [body, speed] : {std::pair{0, speed1}, {1, speed2}}) {
    m.model.bodies[static_cast<std::size_t>(body)].drive = DriveKind::speed;
    m.model.bodies[static_cast<std::size_t>(body)].drive_values = {speed};
  }
  return m;
}

TEST_P(CableLimits, TheFasterOfTwoDrivesOfABeltGoesAsFastAsTheSlowerOne) {
  const double r1 = 0.2;
  const double r2 = 0.3;
  // Rim speeds of 0.8 and 0.3 m/s: the first wheel stalls to the second one's.
  Simulation s = test::start(driven_belt(step_settings(0.01, 20), r1, r2, 4.0, 1.0));
  run_and_check(s, 1.0);
  const auto& bodies = s.world.state().bodies;
  EXPECT_NEAR(bodies[1].angle, 1.0, 1e-12);
  EXPECT_NEAR(bodies[0].angle, r2 / r1, 1e-12);
  EXPECT_NEAR(bodies[0].angular_velocity.z(), r2 / r1, 1e-12);
  const CableReport report = s.cable_reports()[0];
  for (const SpanReport& span : report.spans) EXPECT_NEAR(span.rest_length, span.length, 1e-12);
  const auto stalls = events_of(s, CableEvent::Kind::stall);
  ASSERT_EQ(stalls.size(), 1U);
  EXPECT_EQ(stalls[0]->body, s.world.bodies().name(0));
  ASSERT_EQ(s.cables->stall_warnings().size(), 1U);
  EXPECT_EQ(s.cables->stall_warnings()[0].substeps, 100);
}

TEST_P(CableLimits, TwoDrivesAgainstEachOtherStandStill) {
  Simulation s = test::start(driven_belt(step_settings(0.01, 20), 0.2, 0.3, 4.0, -1.0));
  run_and_check(s, 1.0);
  for (const std::size_t body : {0U, 1U}) {
    EXPECT_NEAR(s.world.state().bodies[body].angle, 0.0, 1e-12);
    EXPECT_NEAR(s.world.state().bodies[body].angular_velocity.z(), 0.0, 1e-12);
  }
  EXPECT_EQ(events_of(s, CableEvent::Kind::stall).size(), 2U);
}

// A feed that takes rope in, and a driven wheel that draws it the other way, from a span that has
// none to give: neither moves, both say so, and the certificate takes that for told.
TEST_P(CableLimits, AFeedAndADriveAgainstEachOtherStandStill) {
  test::Machine m;
  m.model.step = step_settings(0.01, 20);
  const BodyId wheel = m.model.add(driven_wheel("wheel", Vector3::Zero(), 0.1, -1.0));
  const BodyId load = m.model.add(test::weight("load", {0.1, -1.0, 0.0}, 1.0));
  m.model.gravity = test::down;
  auto feed = attach(BodyId::world(), {-0.1, -1.0, 0.0});
  feed->feed_speed = -0.05;
  m.cables.push_back(cable("rope", {feed, test::roll(wheel, test::right), attach(load)}));
  Simulation s = test::start(m);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(s.world.step().ok());
    EXPECT_TRUE(s.certificate()->clean()) << s.certificate()->worst()->sentence();
  }
  EXPECT_NEAR(s.world.state().bodies[0].angle, 0.0, 1e-12);
  EXPECT_EQ(s.cable_reports()[0].links[0].fed, 0.0);
  EXPECT_EQ(events_of(s, CableEvent::Kind::stall).size(), 2U);
}

TEST_P(CableLimits, DrivesThatAgreeDoNotStall) {
  // 0.7 and 0.3 m: the products of radius and speed agree but for their last digit.
  Simulation s = test::start(driven_belt(step_settings(0.003, 20), 0.07, 0.03, 3.0, 7.0));
  run_and_check(s, 9.0);
  EXPECT_NEAR(s.world.state().bodies[0].angle, 27.0, 1e-8);
  EXPECT_NEAR(s.world.state().bodies[1].angle, 63.0, 1e-8);
  EXPECT_TRUE(s.cables->events().empty());
}

TEST_P(CableLimits, AnIdlerBetweenTwoDrivesDoesNotHideTheContradiction) {
  // Three wheels in a triangle, the third one free.
  test::Machine m;
  m.model.step = step_settings(0.01, 100);
  const BodyId a = m.model.add(driven_wheel("a", {0.0, 0.0, 0.0}, 0.1, 3.0));
  const BodyId b = m.model.add(driven_wheel("b", {1.0, 0.0, 0.0}, 0.1, 1.0));
  const BodyId idler = m.model.add(test::wheel("idler", {0.5, 1.0, 0.0}, 0.1, 0.02));
  CableDef belt =
      cable("belt", {test::roll(a, left), test::roll(b, left), test::roll(idler, left)});
  belt.closed = true;
  m.cables.push_back(belt);
  Simulation s = test::start(m);
  run_and_check(s, 1.0);
  EXPECT_NEAR(s.world.state().bodies[0].angle, 1.0, 1e-9);
  EXPECT_NEAR(s.world.state().bodies[1].angle, 1.0, 1e-9);
  EXPECT_EQ(events_of(s, CableEvent::Kind::stall).size(), 1U);
}

TEST_P(CableLimits, OneDriveOfABeltNeverStalls) {
  test::Machine m = test::belt(0.2, 0.3, 1.0, 0.02, 0.02);
  m.model.step = step_settings(0.01, 20);
  m.model.bodies[0].drive = DriveKind::speed;
  m.model.bodies[0].drive_values = {5.0};
  Simulation s = test::start(m);
  run_and_check(s, 2.0);
  EXPECT_TRUE(s.cables->events().empty());
  EXPECT_NEAR(s.world.state().bodies[1].angle, 10.0 * 0.2 / 0.3, 1e-6);
}

TEST_P(CableLimits, RoundingOfABeltWithOneDriveIsNoShortage) {
  // Crossed round the middle one of three wheels: what the drive feeds and draws differs in the
  // last digits.
  test::Machine m;
  m.model.step = step_settings(1.0 / 60.0, 20);
  BodyDef first = driven_wheel("a", {-2.3, -1.3, 0.0}, 0.3, 0.0);
  first.drive_times = {0.5, 1.0};
  first.drive_values = {0.0, -2.0};
  const BodyId a = m.model.add(first);
  const BodyId b = m.model.add(test::wheel("b", {-1.5, -1.1, 0.0}, 0.2, 0.02));
  const BodyId c = m.model.add(test::wheel("c", {-0.7, -1.3, 0.0}, 0.3, 0.02));
  CableDef belt = cable("belt", {test::roll(a, right), test::roll(b, left), test::roll(c, right)});
  belt.closed = true;
  m.cables.push_back(belt);
  Simulation s = test::start(m);
  run_and_check(s, 2.0);
  EXPECT_TRUE(s.cables->events().empty());
  EXPECT_NEAR(s.world.state().bodies[0].angle, -2.5, 1e-9);
}

TEST_P(CableLimits, AWinchStopsWhenItsLoadIsAtTheDrum) {
  // 0.5 m at 0.4 m/s; paid out again from 3 s on.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(0.004, 20);
  const double r = 0.2;
  BodyDef winch = driven_wheel("drum", Vector3::Zero(), r, 0.0);
  winch.drive_times = {3.0, 3.0 + 1e-9};
  winch.drive_values = {2.0, -2.0};
  const BodyId body = m.model.add(winch);
  const BodyId load = m.model.add(test::weight("load", {r, -0.5, 0.0}, 2.0));
  m.cables.push_back(cable("rope", {attach(load), drum(body, left, 0.3)}));
  Simulation s = test::start(m);
  run_and_check(s, 1.0);
  EXPECT_NEAR(s.world.position(load).y(), -0.1, 1e-9);
  run_and_check(s, 3.0);
  // It has wound 0.5 m, to the last part of a step. The load has been thrown up by 0.4 m/s, and
  // hangs again.
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(s.world.state().bodies[0].angle, 0.5 / r, 1e-9);
  EXPECT_EQ(s.world.state().bodies[0].angular_velocity.z(), 0.0);
  EXPECT_NEAR(s.world.position(load).y(), 0.0, 1e-9);
  EXPECT_NEAR(report.spans[0].tension, 2.0 * g, 1e-6 * g);
  const auto stalls = events_of(s, CableEvent::Kind::stall);
  ASSERT_EQ(stalls.size(), 1U);
  EXPECT_EQ(stalls[0]->body, "drum");
  EXPECT_NEAR(stalls[0]->time, 0.5 / 0.4, 0.004 + 1e-9);
  run_and_check(s, 4.0);
  EXPECT_NEAR(s.world.position(load).y(), -0.4, 1e-6);
  EXPECT_NEAR(s.cable_reports()[0].spans[0].tension, 2.0 * g, 1e-6 * g);
}

TEST_P(CableLimits, ADrumThatHasPaidOutAllWindsUpTheOtherWay) {
  // A load that slides along the line of its cable. After the stored length the end is a point of
  // the rim, which turns on by the angle a: y = -r sin a - sqrt(l^2 - r^2 (1 - cos a)^2), until the
  // cable lies on the drum again.
  for (const bool rolling : {true, false}) {
    test::Machine m;
    m.model.gravity = test::down;
    m.model.step = step_settings(0.002, 30);
    const double r = 0.2;
    const BodyId body = m.model.add(driven_wheel("drum", Vector3::Zero(), r, -2.0));
    const BodyId load = m.model.add(test::weight("load", {r, -0.5, 0.0}, 2.0));
    auto wheel = test::roll(body, left);
    wheel->stored_length = 0.3;
    if (rolling) {
      m.cables.push_back(cable("rope", {attach(load), wheel}));
    } else {
      m.cables.push_back(cable("rope", {attach(load), drum(body, left, 0.3)}));
    }
    Simulation s = test::start(m);
    run_and_check(s, 0.7);
    EXPECT_NEAR(s.world.position(load).y(), -0.5 - 0.28, 1e-9);
    run_and_check(s, 1.2);
    const double a = 2.0 * 1.2 - 0.3 / r;
    const double l = 0.8;
    const double across = r * (1.0 - std::cos(a));
    EXPECT_NEAR(s.world.position(load).y(), -r * std::sin(a) - std::sqrt(l * l - across * across),
                1e-6);
    EXPECT_EQ(events_of(s, CableEvent::Kind::attach).size(), 1U);
  }
}

TEST_P(CableLimits, ADrumThatWindsUpTheOtherWayStopsAtItsLoad) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(0.002, 30);
  const double r = 0.2;
  const BodyId body = m.model.add(driven_wheel("drum", Vector3::Zero(), r, -2.0));
  BodyDef hung = test::lump("load", {r, -0.5, 0.0}, 2.0);
  hung.mobility = Mobility::planar;
  hung.damping = 20.0;
  m.cables.push_back(cable("rope", {attach(m.model.add(hung)), drum(body, left, 0.3)}));
  Simulation s = test::start(m);
  double most = 0.0;
  // Nothing keeps the load out of the drum, at whose rim its motion ends.
  std::optional<Divergence> arrived;
  for (int i = 1; i <= 3000 && !arrived; ++i) {
    arrived = s.world.step().divergence;
    if (arrived) break;
    const LinkReport end = s.cable_reports()[0].links[1];
    if (end.winding < 0) most = std::max(most, end.stored_length);
  }
  ASSERT_TRUE(arrived);
  EXPECT_NE(arrived->message.find("has reached the wheel"), std::string::npos) << arrived->message;
  // All of it has been on the other side, but for what the drum draws in a step.
  EXPECT_NEAR(most, 0.8, 2.0 * r * 0.002);
}

TEST_P(CableLimits, AFreeDrumThatHasPaidOutAllHoldsItsLoadByTheRim) {
  // Falls with a = m g / (m + J / r^2) for 0.3 m; the bearing's drag then brings it to rest below
  // the drum.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(0.002, 30);
  const double r = 0.2;
  BodyDef wheel = test::wheel("drum", Vector3::Zero(), r, 0.02);
  wheel.angular_damping = 0.05;
  const BodyId body = m.model.add(wheel);
  BodyDef hung = test::lump("load", {r, -0.5, 0.0}, 2.0);
  hung.mobility = Mobility::planar;
  hung.damping = 5.0;
  const BodyId load = m.model.add(hung);
  auto end = test::roll(body, left);
  end->stored_length = 0.3;
  m.cables.push_back(cable("rope", {attach(load), end}));
  Simulation s = test::start(m);
  run_and_check(s, 20.0);
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(s.world.position(load).y(), -(r + 0.8), 1e-6);
  EXPECT_NEAR(report.spans[0].tension, 2.0 * g, 1e-4 * g);
  EXPECT_EQ(report.links[1].winding, 0);
  EXPECT_GE(events_of(s, CableEvent::Kind::attach).size(), 1U);
  EXPECT_TRUE(s.cables->stall_warnings().empty());
}

TEST_P(CableLimits, ADrivenSquareDrumPaysOutNoMoreThanItHas) {
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(0.002, 30);
  BodyDef square = driven_wheel("square", Vector3::Zero(), 0.2, -2.0);
  square.shapes = {{test::box({0.3, 0.3, 0.1})}};
  const BodyId body = m.model.add(square);
  const BodyId load = m.model.add(test::weight("load", {0.15, -1.0, 0.0}, 2.0));
  m.cables.push_back(cable("rope", {attach(load), drum(body, left, 0.3)}));
  Simulation s = test::start(m);
  run_and_check(s, 3.0);
  EXPECT_NEAR(s.cable_reports()[0].links[1].stored_length, 0.0, 1e-3);
  EXPECT_EQ(s.world.state().bodies[0].angular_velocity.z(), 0.0);
  EXPECT_EQ(events_of(s, CableEvent::Kind::stall).size(), 1U);
}

TEST_P(CableLimits, AFeedStopsWhenAllCableIsIn) {
  test::Machine m = test::cable_pendulum(1.0, 1.0, 0.0);
  m.model.step = step_settings(0.01, 20);
  auto end = attach(BodyId::world());
  end->feed_speed = -0.3;
  for (auto& link : m.cables[0].links) {
    if (link->body.is_world()) link = end;
  }
  Simulation s = test::start(m);
  run_and_check(s, 6.0);
  const auto stalls = events_of(s, CableEvent::Kind::stall);
  ASSERT_EQ(stalls.size(), 1U);
  EXPECT_NEAR(stalls[0]->time, 1.0 / 0.3, 0.01 + 1e-9);
  EXPECT_NEAR(s.cable_reports()[0].spans[0].rest_length, 0.0, 1e-12);
}

TEST_P(CableLimits, AFeedCannotShortenACableBetweenFixedPoints) {
  test::Machine m;
  m.model.step = step_settings(0.01, 20);
  auto feed = attach(BodyId::world());
  feed->feed_speed = -0.1;
  auto hole = std::make_shared<PinholeLink>();
  hole->point = {1.0, 0.0, 0.0};
  CableDef rope = cable("rope", {feed, hole, attach(BodyId::world(), {1.0, 1.0, 0.0})});
  rope.rest_lengths = {1.02, 1.0};
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  run_and_check(s, 1.0);
  const CableReport report = s.cable_reports()[0];
  EXPECT_NEAR(report.total_length, 2.0, 1e-12);
  ASSERT_EQ(s.cables->stall_warnings().size(), 1U);
  EXPECT_NEAR(s.cables->stall_warnings()[0].first_time, 0.2, 0.011);
}

TEST_P(CableLimits, AnElasticBeltIsDrawnNoFurtherThanItsSpanIsLong) {
  test::Machine m = driven_belt(step_settings(0.01, 20), 0.2, 0.2, 1.0, -1.0);
  m.cables[0].compliance = 1e-4;
  Simulation s = test::start(m);
  // Each draws 0.2 m/s: the span of 1 m is used up after 2.5 s. The tension is the stretch over the
  // compliance.
  run_and_check(s, 2.0);
  const CableReport before = s.cable_reports()[0];
  const double tension = std::max(before.spans[0].tension, before.spans[1].tension);
  EXPECT_NEAR(tension, 0.8 / 1e-4, test::ForEveryCombination::GetParam().rattle() ? 100.0 : 1e-6);
  EXPECT_TRUE(s.cables->events().empty());
  run_and_check(s, 4.0);
  EXPECT_EQ(events_of(s, CableEvent::Kind::stall).size(), 2U);
  EXPECT_NEAR(std::abs(s.world.state().bodies[0].angle), 2.5, 1e-9);
}

TEST_P(CableLimits, AUsedUpMaterialDoesNotVibrate) {
  // Compliance and stretch are both 0 then, and so is what implicit Euler takes: the weight has
  // fallen as far as its springs let it, and never more is taken than its 2 kg x g x 0.5 m and what
  // the feed has put in.
  test::Machine m;
  m.model.gravity = test::down;
  m.model.step = step_settings(0.004, 20);
  const BodyId load = m.model.add(test::weight("load", {0.0, -0.5, 0.0}, 2.0));
  auto mouth = attach(BodyId::world(), Vector3::Zero());
  mouth->feed_speed = -0.4;
  CableDef rope = cable("rope", {mouth, attach(load)});
  rope.axial_stiffness = 2e4;
  m.cables.push_back(rope);
  Simulation s = test::start(m);
  double taken = 0.0;
  bool used_up = false;
  for (int i = 0; i < 500; ++i) {
    const StepReport step = s.world.step();
    ASSERT_TRUE(step.ok());
    taken += step.statistics.numerical_damping;
    ASSERT_TRUE(std::isfinite(taken)) << i;
    used_up = used_up || s.cable_reports()[0].spans[0].rest_length == 0.0;
  }
  EXPECT_TRUE(used_up);
  EXPECT_GE(taken, 0.0);
  EXPECT_LT(taken, 2.0 * 2.0 * g * 0.5);
}

INSTANTIATE_TEST_SUITE_P(All, CableLimits, testing::ValuesIn(test::combinations),
                         test::combination_name);

}  // namespace
}  // namespace sheave
